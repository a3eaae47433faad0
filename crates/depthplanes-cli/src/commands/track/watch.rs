//! What a person should know of a source while it runs: sizes that change, time that jumps, notes on its maps, no floor.

use super::find::Ground;
use crate::args::Track;
use crate::failure::note;
use crate::show;
use depthplanes_video::{StatedUp, VideoFrame};
use std::collections::BTreeSet;

/// Times the usual step from which on time jumps.
const JUMP: f64 = 10.0;
/// Notes of one kind that are said; more are counted.
const MOST: u64 = 5;

/// Looks at one frame after the other.
#[derive(Default)]
pub(super) struct Watch {
    size: Option<[usize; 2]>,
    time_s: Option<f64>,
    step_s: Option<f64>,
    jumps: u64,
    /// Whether a preset is stated, which may have no camera.
    has_preset: bool,
    /// The flag that states up, if one does.
    up_by: Option<&'static str>,
    /// Whether up was known in a frame.
    is_up_known: bool,
    /// Frames in which a floor was looked for, and those in which there is one.
    floors: [u64; 2],
    said: BTreeSet<String>,
}

impl Watch {
    pub(super) fn new(wanted: &Track) -> Self {
        let up_by = match wanted.up {
            StatedUp::Nothing => None,
            StatedUp::Camera(_) => Some("--up"),
            StatedUp::World(_) => Some("--world-up"),
        };
        Watch { up_by, has_preset: wanted.reading.preset.is_some(), ..Watch::default() }
    }

    /// Counts whether there is a floor.
    pub(super) fn look_at_ground(&mut self, ground: &Ground) {
        self.is_up_known |= ground.record["up_from"] != "estimated";
        self.floors[0] += 1;
        self.floors[1] += u64::from(!ground.record["floor"].is_null());
    }

    pub(super) fn look(&mut self, frame: &VideoFrame) {
        let (name, size) = (&frame.name, [frame.frame.width, frame.frame.height]);
        if let Some([width, height]) = self.size.replace(size).filter(|before| *before != size) {
            note(&format!("{name}: {} x {} pixels, before {width} x {height}: all planes are new", size[0], size[1]));
        }
        let hint = show::camera_hint(&frame.frame, self.has_preset);
        for warning in frame.frame.warnings.iter().map(String::as_str).chain(hint.lines()) {
            if (self.said.len() as u64) < MOST && self.said.insert(warning.into()) {
                note(&format!("{name}: {warning}"));
            }
        }
        let Some(now) = frame.time_s else { return };
        if let Some(before) = self.time_s.replace(now) {
            self.step(name, now - before);
        }
    }

    fn step(&mut self, name: &str, step: f64) {
        let is_odd = step <= 0.0 || self.step_s.is_some_and(|usual| step > JUMP * usual);
        if !is_odd {
            self.step_s = Some(self.step_s.map_or(step, |usual| usual + 0.1 * (step - usual)));
            return;
        }
        self.jumps += 1;
        if self.jumps <= MOST {
            let how = if step <= 0.0 { "goes back" } else { "jumps" };
            note(&format!("{name}: time {how} by {:.3} s", step.abs()));
        }
    }

    /// Says how much was not said, and where what was stated finds nothing.
    pub(super) fn end(&self) {
        let [frames, floors] = self.floors;
        match self.up_by.filter(|_| frames > 0 && floors == 0) {
            Some(flag) => {
                note(&format!("no frame has a floor with the up that {flag} states; without it up is estimated"));
            }
            None if floors == 0 && self.is_up_known => note(
                "no frame has a floor with the up that the source says; is the frame of coordinates of its maps an optical one (x \
                 right, y down, z ahead)? --up X,Y,Z counts before it",
            ),
            None => (),
        }
        if self.jumps > MOST {
            note(&format!("time jumped {} more times", self.jumps - MOST));
        }
    }
}
