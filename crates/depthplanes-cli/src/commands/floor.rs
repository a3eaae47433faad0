//! `depthplanes floor`: the floor, how the camera stands above it, and what every plane is.
//!
//! In: maps, as `detect` takes them, and what is known of up. Out: a table for people or a JSON record.

mod files;
mod table;

use crate::args::Floor;
use crate::failure::{Failure, Outcome, note};
use crate::inputs::{self, Input};
use crate::load;
use crate::run::{Recipe, Runner};
use depthplanes::ground::{GridMapper, GroundFinder, RESOLUTION_M, Up};
use depthplanes::noise::SensorNoise;
use depthplanes_io::{ReadOptions, outputs};
use std::io::Write;

pub(super) fn run(wanted: &Floor, out: &mut dyn Write) -> Outcome {
    let recipe = Recipe::new(wanted.method, &wanted.parameters, 1)?;
    let up = wanted.up.map_or(Ok(Up::Estimated), Up::known)?;
    let finder = GroundFinder::default().up(up).camera_height_m(wanted.camera_height)?;
    let mapper = GridMapper::default().resolution_m(wanted.resolution.unwrap_or(RESOLUTION_M))?;
    let inputs = inputs::expand(&wanted.inputs.words, wanted.inputs.recursive)?;
    files::check(wanted, &inputs)?;
    let mut options = load::options(&wanted.reading)?;
    options.noise = load::noise_table(wanted.noise_table.as_deref())?.map(SensorNoise::Table);
    let (runner, alone) = (Runner::new(&recipe), inputs.len() == 1);
    let mut work = Work { wanted, runner, finder, mapper, up, options, alone };
    let mut failed = 0;
    for input in &inputs {
        match work.process(input, out).map_err(|failure| failure.of_input(&input.name())) {
            Ok(()) => (),
            Err(failure) if inputs.len() == 1 || failure.is_closed_pipe() => return Err(failure),
            Err(failure) => {
                failure.report();
                failed += 1;
            }
        }
    }
    match failed {
        0 => Ok(()),
        failed => Err(Failure::request(format!("{failed} of {} inputs failed; the others are done", inputs.len()))),
    }
}

/// What is done with each input.
struct Work<'a> {
    wanted: &'a Floor,
    runner: Runner<'a>,
    finder: GroundFinder,
    mapper: GridMapper,
    up: Up,
    options: ReadOptions,
    alone: bool,
}

impl Work<'_> {
    fn process(&mut self, input: &Input, out: &mut dyn Write) -> Outcome {
        let name = input.name();
        let frame = load::frame(input, &self.options)?;
        let found = self.runner.detect(&frame, 0)?;
        let ground = self.finder.find(frame.view()?, &found.detection, &frame.sensor)?;
        if let Some(path) = &self.wanted.overlay {
            outputs::write_file(path, &outputs::ground_png(frame.view()?, &frame.sensor, &found.detection, ground)?)?;
        }
        if let Some(path) = &self.wanted.grid {
            outputs::write_grid(path, self.mapper.grid(frame.view()?, &frame.sensor, ground)?)?;
        }
        frame.warnings.iter().for_each(|warning| note(&format!("{name}: {warning}")));
        if ground.floor.is_none() {
            note(&format!("{name}: {}", table::no_floor(&found.detection, self.up)));
        }
        let text = if self.wanted.json {
            let record = outputs::ground_record(&name, ground, self.up);
            if self.alone { format!("{record:#}\n") } else { format!("{record}\n") }
        } else {
            let planes = &found.detection.planes;
            table::table(&name, ground, planes, self.wanted.rows) + if self.alone { "" } else { "\n" }
        };
        out.write_all(text.as_bytes())?;
        Ok(out.flush()?)
    }
}
