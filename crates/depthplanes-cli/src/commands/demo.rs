//! `depthplanes demo`: a synthetic scene through the whole pipeline, into files to look at.

use crate::failure::Outcome;
use crate::folders::make_folder;
use crate::run::{Recipe, Runner};
use crate::terminal::plain;
use crate::{load, show};
use depthplanes::Intrinsics;
use depthplanes::methods;
use depthplanes_io::outputs::{self, OUTPUTS, Output, Report};
use depthplanes_io::{Frame, Pixels};
use std::io::Write;
use std::path::{Path, PathBuf};

/// A furnished room without noise, in millimetres.
const SCENE: &str = "room:sensor=clean_mm";

pub(super) fn run(folder: &Path, out: &mut dyn Write) -> Outcome {
    let frame = load::scene(SCENE)?;
    let recipe = Recipe::new(methods::default(), &[], 1)?;
    let found = Runner::new(&recipe).detect(&frame, 0)?;
    let source = format!("scene:{SCENE}");
    let report =
        Report { legend: true, ..Report::new(&source, &frame, recipe.method, &recipe.values, &found.detection) };
    make_folder(folder)?;
    let depth = folder.join("depth.png");
    outputs::write_file(&depth, &depth_png(&frame))?;
    let files: Vec<(&Output, PathBuf)> = {
        let possible = OUTPUTS.iter().filter(|output| report.has_what_it_takes(output));
        possible.map(|output| (output, folder.join(output.file))).collect()
    };
    outputs::write_all(&report, &files)?;
    tell(&report, &depth, &files, out)
}

fn depth_png(frame: &Frame) -> Vec<u8> {
    match &frame.pixels {
        Pixels::U16(values) => outputs::grey16_png(frame.width, frame.height, values),
        _ => unreachable!("the demo's scene has 16 bits"),
    }
}

fn tell(report: &Report<'_>, depth: &Path, files: &[(&Output, PathBuf)], out: &mut dyn Write) -> Outcome {
    writeln!(out, "{}{}", show::summary(report), show::table(report, 12))?;
    writeln!(out, "{}: the depth map, 16 bits, millimetres", plain(&depth.display().to_string()))?;
    for (output, path) in files {
        writeln!(out, "{}: {}", plain(&path.display().to_string()), output.about)?;
    }
    let overlay = files.iter().find(|(output, _)| output.name == "overlay");
    let picture = overlay.map(|(_, path)| plain(&path.display().to_string()).into_owned()).unwrap_or_default();
    writeln!(out, "\nLook at {picture}. The same again from the file:")?;
    write!(out, "  depthplanes detect {} --encoding millimetre", plain(&depth.display().to_string()))?;
    if let Some(Intrinsics { fx, fy, cx, cy }) = report.frame.sensor.intrinsics {
        write!(out, " --intrinsics {fx},{fy},{cx},{cy}")?;
    }
    Ok(writeln!(out)?)
}
