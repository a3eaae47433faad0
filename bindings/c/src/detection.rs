//! What was found in a map. Its memory is its own and is used again by the next detection that is written to it.

use crate::border::for_c;
use crate::error::{Error, Result};
use crate::map::Pixels;
use crate::outlines::Rings;
use crate::plane::dp_plane;
use depthplanes::outline::Outlines;
use depthplanes::{Detection, Sensor};
use std::ffi::{CString, c_char};
use std::ptr::null;

/// What was found in a map. What its functions return belongs to it, and is valid until the next detection is written to it
/// or it is freed. Threads may read one at the same time.
#[derive(Default)]
pub struct dp_detection {
    found: Detection,
    /// Whether `found` is a result, and not only memory.
    is_filled: bool,
    pub(crate) sensor: Sensor,
    planes: Vec<dp_plane>,
    rings: Rings,
    notes: Option<CString>,
}

impl dp_detection {
    /// Makes it empty and gives away its memory.
    pub(crate) fn emptied(&mut self) -> Detection {
        self.is_filled = false;
        self.planes.clear();
        self.rings.clear();
        self.notes = None;
        std::mem::take(&mut self.found)
    }

    pub(crate) fn fill(&mut self, found: Detection, sensor: Sensor, outlines: Option<&Outlines>, notes: &str) {
        self.planes.extend(found.planes.iter().map(dp_plane::from));
        if let Some(outlines) = outlines {
            self.rings.fill(outlines, &mut self.planes);
        }
        self.notes = (!notes.is_empty()).then(|| for_c(notes));
        (self.found, self.sensor, self.is_filled) = (found, sensor, true);
    }

    /// What was found in a map.
    ///
    /// # Errors
    /// The detection is of a map of another size, or of none.
    pub(crate) fn found_in(&self, map: &Pixels<'_>) -> Result<&Detection> {
        let found = self.found().filter(|found| (found.width, found.height) == map.size());
        found.ok_or_else(|| Error::invalid("the detection is not of this map; accepted: what was found in it"))
    }

    /// What was found, if anything was looked for.
    fn found(&self) -> Option<&Detection> {
        self.is_filled.then_some(&self.found)
    }
}

fn found(detection: Option<&dp_detection>) -> Option<&Detection> {
    detection?.found()
}

/// A detection of no map, to be written to by `dp_detector_detect`. Keep it for all frames: its memory is used again.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detection_new() -> Box<dp_detection> {
    Box::default()
}

/// Frees a detection; null is none.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detection_free(detection: Option<Box<dp_detection>>) {
    drop(detection);
}

/// Columns of the map, and of the label image; 0 if nothing was found out: before the first detection, after one that
/// failed, of null.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detection_width(detection: Option<&dp_detection>) -> usize {
    found(detection).map_or(0, |found| found.width)
}

/// Rows of the map, and of the label image; 0 as `dp_detection_width`.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detection_height(detection: Option<&dp_detection>) -> usize {
    found(detection).map_or(0, |found| found.height)
}

/// The label image, row by row without gaps, width x height: 0 = no plane, k + 1 = plane k. Null if the width is 0.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detection_labels(detection: Option<&dp_detection>) -> *const u16 {
    found(detection).map_or(null(), |found| found.labels.as_ptr())
}

/// The label image of curved surfaces, which are no planes: 0 = none, 1 and up one surface each, the largest first. Null
/// unless the detector was asked for them (`curved` of `dp_detector_set`).
#[unsafe(no_mangle)]
pub extern "C" fn dp_detection_curved_labels(detection: Option<&dp_detection>) -> *const u16 {
    let curved = found(detection).and_then(|found| found.curved.as_ref());
    curved.map_or(null(), |curved| curved.labels.as_ptr())
}

/// How many planes there are.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detection_plane_count(detection: Option<&dp_detection>) -> usize {
    detection.map_or(0, |detection| detection.planes.len())
}

/// The planes, the largest first; null if there are none.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detection_planes(detection: Option<&dp_detection>) -> *const dp_plane {
    let planes = detection.map(|detection| &detection.planes).filter(|planes| !planes.is_empty());
    planes.map_or(null(), |planes| planes.as_ptr())
}

/// What looks wrong with the map or with what was found, a line for each note, with what to state instead; `--x` in them is
/// the setting `x`. Only the first map of each size and type is looked at; of the others it is empty.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detection_notes(detection: Option<&dp_detection>) -> *const c_char {
    let notes = detection.and_then(|detection| detection.notes.as_deref());
    notes.unwrap_or_default().as_ptr()
}
