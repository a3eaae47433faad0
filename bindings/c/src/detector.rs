//! The detector of C: what is stated, the memory that frames share, and the text of the last error.

use crate::border::{for_c, guarded, keep_last, last, required, text};
use crate::detection::dp_detection;
use crate::error::{Error, Result, dp_status};
use crate::ground::dp_ground;
use crate::map::{Pixels, dp_map};
use crate::reader::{Read, Reader};
use crate::settings::Settings;
use crate::tracker::dp_tracker;
use depthplanes::methods;
use depthplanes::outline::Outliner;
use depthplanes::track::CameraPose;
use depthplanes::{Detection, Detector, Explanation, Sensor, ValueKind, with_view};
use depthplanes_io::outputs::Report;
use depthplanes_io::{Frame, doubts, memory};
use std::ffi::{CString, c_char};
use std::mem::MaybeUninit;

/// Finds planes in the maps of one camera. Keep it for all frames: its memory is used again. One thread at a time may use a
/// detector; different detectors may be used at the same time.
#[derive(Default)]
pub struct dp_detector {
    settings: Settings,
    pub(crate) outliner: Option<Outliner>,
    /// Made anew after something was stated.
    reader: Option<Reader>,
    idle: Option<Detector>,
    /// Bytes that there was memory for.
    memory: [u64; 2],
    error: CString,
    explanation: CString,
}

/// Does something with a detector, which keeps the text of an error.
pub(crate) fn with(detector: Option<&mut dp_detector>, act: impl FnOnce(&mut dp_detector) -> Result<()>) -> dp_status {
    let Some(detector) = detector else {
        let error = Error::null("detector");
        keep_last(&error);
        return error.status;
    };
    match guarded(|| act(detector)) {
        Ok(()) => dp_status::DP_OK,
        Err(error) => {
            detector.error = for_c(&error.text);
            error.status
        }
    }
}

/// States something of a detector.
pub(crate) fn state(detector: Option<&mut dp_detector>, act: impl FnOnce(&mut Settings) -> Result<()>) -> dp_status {
    with(detector, |detector| {
        act(&mut detector.settings)?;
        (detector.reader, detector.idle) = (None, None);
        Ok(())
    })
}

impl dp_detector {
    fn read<'m>(&mut self, map: &Pixels<'m>) -> Result<Read<'m>> {
        let (width, height) = map.size();
        let needed = memory::of_detection(self.settings.method, width, height);
        if needed > self.memory {
            memory::check(needed[0], needed[1])?;
            self.memory = needed;
        }
        let reader = match self.reader.take() {
            Some(reader) => reader,
            None => Reader::new(self.settings.reading()?),
        };
        self.reader.insert(reader).read(map)
    }

    /// Reads the map that a detection is of once more.
    ///
    /// # Errors
    /// Its numbers mean something else than those that the detection is of: another type, another unit of this detector.
    fn read_of<'m>(&mut self, map: &Pixels<'m>, detection: &dp_detection) -> Result<Read<'m>> {
        let read = self.read(map)?;
        if read.sensor().value_kind != detection.sensor.value_kind {
            let what = "the numbers of the map mean something else than those that the detection is of";
            return Err(Error::invalid(format!(
                "{what}; accepted: its map, and a detector with the same type of pixels and unit"
            )));
        }
        Ok(read)
    }

    /// The detector that is idle, or a new one. It does not come back if something fails: then its memory is anybody's.
    fn finder(&mut self, sensor: Sensor) -> Result<Detector> {
        let finder = self.idle.take().map_or_else(|| self.settings.detector(), Ok)?;
        Ok(finder.sensor(sensor))
    }

    /// Writes what is found to a detection that was emptied; the memory of `spare` is used for it.
    fn detect(&mut self, map: &dp_map, detection: &mut dp_detection, spare: Detection) -> Result<()> {
        let map = map.checked()?;
        let read = self.read(&map)?;
        let sensor = read.sensor();
        let mut finder = self.finder(sensor)?;
        finder.detect(read.view()?)?;
        let found = finder.exchange(spare);
        self.idle = Some(finder);
        let notes = match &read {
            Read::Copied(frame) => self.notes(&map, frame, &found)?,
            Read::InPlace(..) => String::new(),
        };
        let outlines = self.outliner.as_mut().map(|outliner| outliner.outline_seen_by(&found, &sensor)).transpose()?;
        detection.fill(found, sensor, outlines, &notes);
        Ok(())
    }

    /// What a person should know of a map and of what was found in it, if it is the first of its size and type.
    fn notes(&mut self, map: &Pixels<'_>, frame: &Frame, found: &Detection) -> Result<String> {
        if !self.reader.as_mut().map_or(Ok(false), |reader| reader.remember(map, frame))? {
            return Ok(String::new());
        }
        let Settings { method, values, coplanar, .. } = &self.settings;
        let report = Report { coplanar: *coplanar, ..Report::new("map", frame, method, values, found) };
        let notes: Vec<String> = frame.warnings.iter().cloned().chain(doubts(&report)).collect();
        Ok(notes.join("\n"))
    }

    fn points(
        &mut self,
        map: &dp_map,
        detection: &dp_detection,
        label: u16,
        places: &mut [MaybeUninit<[f64; 3]>],
    ) -> Result<()> {
        let (map, sensor) = (map.checked()?, detection.sensor);
        let found = detection.found_in(&map)?;
        let count = found.planes.len();
        let plane = found
            .plane(label)
            .ok_or_else(|| Error::invalid(format!("there is no plane {label}; there are {count}")))?;
        if places.len() < plane.pixel_count {
            let (given, needed) = (places.len(), plane.pixel_count);
            return Err(Error::invalid(format!("there is room for {given} points; plane {label} has {needed}")));
        }
        if !sensor.is_metric() {
            let is_disparity = sensor.value_kind == ValueKind::Disparity;
            return Err(depthplanes::Error::NotMetric { wants: "points", is_disparity }.into());
        }
        let read = self.read_of(&map, detection)?;
        with_view!(read.view()?, view => {
            let valid = view.validity();
            for ([u, v], place) in found.pixels_of(label).zip(places) {
                let value = view.row(v)[u];
                let depth = valid.holds(value).then(|| sensor.value_kind.depth_m(value.into())).flatten();
                let ray = sensor.ray(u as f64, v as f64);
                place.write(ray.zip(depth).map_or([f64::NAN; 3], |(ray, depth)| ray.map(|part| part * depth)));
            }
        });
        Ok(())
    }

    fn ground(&mut self, map: &dp_map, detection: &dp_detection, ground: &mut dp_ground) -> Result<()> {
        ground.clear();
        let map = map.checked()?;
        let found = detection.found_in(&map)?;
        Ok(ground.find(self.read_of(&map, detection)?.view()?, found, &detection.sensor)?)
    }

    fn track(
        &mut self,
        map: &dp_map,
        detection: &dp_detection,
        pose: Option<&[[f64; 4]; 3]>,
        tracker: &mut dp_tracker,
    ) -> Result<()> {
        let map = map.checked()?;
        let found = detection.found_in(&map)?;
        let pose = pose.map(|rows| CameraPose::new(rows.map(|[x, y, z, _]| [x, y, z]), rows.map(|row| row[3])));
        let pose = pose.transpose()?;
        Ok(tracker.track(self.read_of(&map, detection)?.view()?, found, &detection.sensor, pose.as_ref())?)
    }

    fn explain(&mut self, map: &dp_map, at: [usize; 2]) -> Result<()> {
        let read = self.read(&map.checked()?)?;
        let mut finder = self.finder(read.sensor())?;
        let why = finder.explain(read.view()?, at)?;
        self.idle = Some(finder);
        self.explanation = for_c(&readable(&why));
        Ok(())
    }
}

/// The verdict, and what to change.
fn readable(why: &Explanation) -> String {
    let suggestion = |tried: &depthplanes::explanation::Suggestion| {
        let changes: Vec<String> = tried.parameters.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        format!("\nTry {}: the pixel is then on a plane of {} pixels.", changes.join(", "), tried.plane_pixels)
    };
    why.verdict.to_string() + &why.suggestions.iter().map(suggestion).collect::<String>()
}

/// A detector of the method of that name (`dp_methods`), null for the usual one, which needs no parameter. Null if there is
/// no such method; `dp_error(NULL)` then says which there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dp_detector_new(method: *const c_char) -> Option<Box<dp_detector>> {
    let made = guarded(|| {
        if method.is_null() {
            return Ok(Box::default());
        }
        // SAFETY: it is a text of C.
        let method = methods::find(unsafe { text("method", method) }?)?;
        Ok(Box::new(dp_detector { settings: Settings::new(method), ..dp_detector::default() }))
    });
    made.inspect_err(keep_last).ok()
}

/// Frees a detector; null is none. What it has found stays.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detector_free(detector: Option<Box<dp_detector>>) {
    drop(detector);
}

/// The text of the last error of a detector: what was given, what is accepted. Of null: of the last call of this thread that
/// failed without a detector, such as `dp_detector_new`. It is empty if there was none, and valid until the next error.
#[unsafe(no_mangle)]
pub extern "C" fn dp_error(detector: Option<&dp_detector>) -> *const c_char {
    detector.map_or_else(last, |detector| detector.error.as_ptr())
}

/// Finds the planes of a map and writes them to a detection, whatever it held before. If that fails, it holds nothing.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detector_detect(
    detector: Option<&mut dp_detector>,
    map: Option<&dp_map>,
    mut detection: Option<&mut dp_detection>,
) -> dp_status {
    let spare = detection.as_mut().map(|detection| detection.emptied()).unwrap_or_default();
    with(detector, |detector| detector.detect(required("map", map)?, required("detection", detection)?, spare))
}

/// Writes the points of a plane as they were measured, metres in camera coordinates, row by row: `pixel_count` of them, NaN where
/// nothing was measured. There is room for `capacity` of them. The map is read again; it has to be the one that the detection
/// is of. Needs unit and camera.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dp_detector_points(
    detector: Option<&mut dp_detector>,
    map: Option<&dp_map>,
    detection: Option<&dp_detection>,
    label: u16,
    points: *mut [f64; 3],
    capacity: usize,
) -> dp_status {
    with(detector, |detector| {
        let (map, detection) = (required("map", map)?, required("detection", detection)?);
        let start = required("points", (!points.is_null()).then_some(points))?;
        // SAFETY: there is room for as many, as the caller of C says; they may hold anything.
        let places = unsafe { std::slice::from_raw_parts_mut(start.cast::<MaybeUninit<[f64; 3]>>(), capacity) };
        detector.points(map, detection, label, places)
    })
}

/// Finds the floor of a map by what was found in it, what stands on it, and what each plane is, and writes it to a ground,
/// whatever it held before. If that fails, it holds nothing. The map is read again; it has to be the one that the detection is of.
/// Needs unit and camera.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detector_ground(
    detector: Option<&mut dp_detector>,
    map: Option<&dp_map>,
    detection: Option<&dp_detection>,
    ground: Option<&mut dp_ground>,
) -> dp_status {
    with(detector, |detector| {
        let ground = required("ground", ground)?;
        detector.ground(required("map", map)?, required("detection", detection)?, ground)
    })
}

/// Gives what was found in the next frame of a camera to a tracker, by which planes keep their ids. `pose` is null, or the camera's
/// pose if it is known: 12 numbers, row by row the first three rows of the matrix that takes camera coordinates to those of a
/// world that stays the same, metres; of a matrix of 4 x 4 in row-major order they are the first 12. Without it the motion is
/// estimated from the planes. The map is read again; it has to be the one that the
/// detection is of. If it fails, the tracker stays as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dp_detector_track(
    detector: Option<&mut dp_detector>,
    map: Option<&dp_map>,
    detection: Option<&dp_detection>,
    pose: *const f64,
    tracker: Option<&mut dp_tracker>,
) -> dp_status {
    with(detector, |detector| {
        // SAFETY: it is null or leads to 12 numbers, as the caller of C says.
        let pose = unsafe { pose.cast::<[[f64; 4]; 3]>().as_ref() };
        let tracker = required("tracker", tracker)?;
        detector.track(required("map", map)?, required("detection", detection)?, pose, tracker)
    })
}

/// Says why the pixel in column u, row v of a map has a plane or none: a sentence, and a line for each parameter that helps, with
/// its value. Runs the method several times. What `text` is set to is valid until the next call of it with this detector.
#[unsafe(no_mangle)]
pub extern "C" fn dp_detector_explain(
    detector: Option<&mut dp_detector>,
    map: Option<&dp_map>,
    u: usize,
    v: usize,
    text: Option<&mut MaybeUninit<*const c_char>>,
) -> dp_status {
    with(detector, |detector| {
        let text = required("text", text)?;
        detector.explain(required("map", map)?, [u, v])?;
        text.write(detector.explanation.as_ptr());
        Ok(())
    })
}
