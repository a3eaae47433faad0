//! A label image, or a picture, for each frame.

use super::output::{Output, OutputInfo, machine};
use crate::commands::track::follow::Followed;
use crate::failure::Outcome;
use depthplanes_io::outputs::{self, grey16_png, tracked_png};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The file of a frame in a folder.
fn file(folder: &Path, frame: &Followed) -> PathBuf {
    folder.join(format!("{:06}.png", frame.video.index))
}

fn made(folder: &Path) -> Outcome<PathBuf> {
    std::fs::create_dir_all(folder).map_err(|error| machine(folder, error))?;
    Ok(folder.into())
}

pub(super) const LABELS: OutputInfo =
    OutputInfo { name: "labels", file: "labels", open: |folder| Ok(Box::new(Labels(made(folder)?))) };

/// Label images.
struct Labels(PathBuf);

impl Output for Labels {
    fn write(&mut self, frame: &Followed, _: &mut dyn Write) -> Outcome {
        let found = &frame.detection;
        let png = grey16_png(found.width, found.height, &frame.tracked().labels()?);
        Ok(outputs::write_file(&file(&self.0, frame), &png)?)
    }
}

pub(super) const OVERLAYS: OutputInfo =
    OutputInfo { name: "overlays", file: "overlays", open: |folder| Ok(Box::new(Overlays(made(folder)?))) };

/// Pictures: of the planes, or of the ground where it was found.
struct Overlays(PathBuf);

impl Output for Overlays {
    fn write(&mut self, frame: &Followed, _: &mut dyn Write) -> Outcome {
        let path = file(&self.0, frame);
        match frame.ground.as_ref().and_then(|ground| ground.png.as_ref()) {
            Some(png) => outputs::write_file(&path, png)?,
            None => {
                let (view, sensor) = (frame.video.frame.view()?, &frame.video.frame.sensor);
                outputs::write_file(&path, &tracked_png(view, sensor, &frame.detection, &frame.tracks)?)?;
            }
        }
        Ok(())
    }
}
