//! `depthplanes methods`, `params`, `formats`, `encodings`, `presets`, `datasets`: the tables.

use crate::eval::datasets::DATASETS;
use crate::failure::Outcome;
use crate::table::{Align, aligned, row};
use depthplanes::methods::{METHODS, MethodInfo, Param};
use depthplanes_io::encoding::ENCODINGS;
use depthplanes_io::formats::FORMATS;
use depthplanes_io::presets::SENSOR_PRESETS;
use std::io::Write;

pub(super) fn methods(out: &mut dyn Write) -> Outcome {
    let mut rows = vec![row(["method", "stages", "about"])];
    rows.extend(METHODS.iter().map(|method| row([method.name, &method.stages.join(", "), method.about])));
    print(&rows, out)
}

/// The parameters of one method or of all.
pub(super) fn params(method: Option<&MethodInfo>, out: &mut dyn Write) -> Outcome {
    for (i, info) in METHODS.iter().filter(|info| method.is_none_or(|method| method.name == info.name)).enumerate() {
        if i > 0 {
            writeln!(out)?;
        }
        writeln!(out, "{}: {}", info.name, info.about)?;
        let mut rows = vec![row(["parameter", "default", "unit", "accepted", "source", "meaning"])];
        rows.extend(info.params.iter().map(param));
        print(&rows, out)?;
    }
    Ok(())
}

fn param(param: &Param) -> Vec<String> {
    let source = param.source.unwrap_or("ours");
    let names = [Some(param.name), param.alias].into_iter().flatten();
    let flag = names.map(|name| format!("--{}", name.replace('_', "-"))).collect::<Vec<_>>().join(", ");
    row([&flag, &param.default.to_string(), param.unit, &param.accepted(), source, param.meaning])
}

pub(super) fn formats(out: &mut dyn Write) -> Outcome {
    let mut rows = vec![row(["format", "names", "about"])];
    rows.extend(FORMATS.iter().map(|format| {
        let names: Vec<String> = format.extensions.iter().map(|extension| format!(".{extension}")).collect();
        row([format.name, &names.join(" "), format.about])
    }));
    print(&rows, out)
}

pub(super) fn encodings(out: &mut dyn Write) -> Outcome {
    let mut rows = vec![row(["encoding", "unit", "--scale", "about"])];
    rows.extend(ENCODINGS.iter().map(|encoding| row([encoding.name, encoding.unit, encoding.scale, encoding.about])));
    print(&rows, out)
}

pub(super) fn presets(out: &mut dyn Write) -> Outcome {
    let mut rows = vec![row(["preset", "encoding", "camera for", "noise", "smooth noise", "about"])];
    rows.extend(SENSOR_PRESETS.iter().map(|preset| {
        let size = preset.camera.map_or("-".to_string(), |(width, height, _)| format!("{width} x {height}"));
        let [noise, smooth] = [preset.noise, preset.smooth_noise]
            .map(|noise| noise.map_or("estimated".to_string(), |noise| noise.to_string()));
        row([preset.name, preset.encoding, &size, &noise, &smooth, preset.about])
    }));
    print(&rows, out)
}

pub(super) fn datasets(out: &mut dyn Write) -> Outcome {
    let mut rows = vec![row(["set", "folder", "about", "the folder holds"])];
    rows.extend(DATASETS.iter().map(|set| row([set.name, set.folder, set.about, set.layout])));
    rows.push(row([
        "scene:SPEC",
        "-",
        "Synthetic scenes with exact truth; seed=1-20 makes twenty.",
        "nothing: they are made",
    ]));
    print(&rows, out)
}

fn print(rows: &[Vec<String>], out: &mut dyn Write) -> Outcome {
    let columns = vec![Align::Left; rows[0].len()];
    Ok(out.write_all(aligned(&columns, rows).as_bytes())?)
}
