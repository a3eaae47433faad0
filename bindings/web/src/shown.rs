//! What a page shows of a map: planes, their outlines, and the ground.

use crate::clock::Clock;
use crate::error::{InputError, Result};
use crate::finder::Finder;
use crate::map::known;
use depthplanes::ground::GroundFinder;
use depthplanes::outline::Outliner;
use depthplanes_io::Frame;
use depthplanes_io::page::{Message, Shown, frame_message};
use serde_json::json;

/// Pixels of the smallest hole that outlines keep: smaller ones are specks on the page.
const LEAST_HOLE_PX: usize = 100;

/// Finds what a page shows beside planes; it reuses its memory.
pub(crate) struct View {
    outliner: Outliner,
    ground: GroundFinder,
}

impl Default for View {
    fn default() -> Self {
        View { outliner: Outliner::default().min_hole_px(LEAST_HOLE_PX), ground: GroundFinder::default() }
    }
}

impl View {
    /// The message of a frame, as the live page gets it.
    ///
    /// # Errors
    /// What the library says of the map, with its name.
    pub(crate) fn message(
        &mut self,
        finder: &mut Finder,
        frame: &Frame,
        name: &str,
        mut clock: Clock,
    ) -> Result<Message> {
        let named = |error: InputError| InputError(format!("{name}: {}", error.0));
        finder.find(frame, &mut |stage| clock.ends(stage)).map_err(named)?;
        let notes =
            finder.report(frame, name, |report| frame.warnings.iter().chain(report.notes).cloned().collect::<Vec<_>>());
        let detection = &finder.found;
        let ground = match frame.sensor.is_metric() {
            true => Some(self.ground.find(frame.view()?, detection, &frame.sensor)?),
            false => None,
        };
        clock.ends("ground");
        let outlines = self.outliner.outline_seen_by(detection, &frame.sensor)?;
        clock.ends("outlines");
        let message = frame_message(&Shown { frame, detection, outlines, tracks: None, ground })?;
        clock.ends("message");
        Ok(message.with(json!({"name": name, "notes": notes, "stages": clock.stages, "known": known(frame)})))
    }
}
