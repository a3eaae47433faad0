//! `depthplanes man`: the manual pages.

use crate::args;
use crate::failure::Outcome;
use crate::folders::make_folder;
use crate::terminal::plain;
use depthplanes_io::outputs::write_file;
use std::io::Write;
use std::path::Path;

pub(super) fn run(out_dir: Option<&Path>, out: &mut dyn Write) -> Outcome {
    let pages = args::man_pages()?;
    let Some(folder) = out_dir else {
        return Ok(out.write_all(&pages[0].1)?);
    };
    make_folder(folder)?;
    for (name, page) in &pages {
        write_file(&folder.join(name), page)?;
    }
    Ok(writeln!(out, "{} pages in {}", pages.len(), plain(&folder.display().to_string()))?)
}
