//! Maps that are in memory, as arrays of a program, which have no format.
//!
//! In: samples, row by row, and what the user states. Out: a [`Frame`], as of a file. What of its reading rests on size, type
//! and the user's words alone is [`Settled`], so that later maps of the camera are read where they lie, without a copy.

use std::sync::Arc;

use depthplanes::{AnyView, Sensor, ValueKind, with_view};

use crate::choice::{IN_MEMORY, rests_on_values};
use crate::encoding;
use crate::error::Result;
use crate::formats::image_of;
use crate::frame::{Frame, Pixels, with_validity};
use crate::presets;
use crate::read::{ReadOptions, frame_of, known_missing};
use crate::traps::missing::not_measured;

/// Reads one map from samples in memory, row by row, top row first, `(width, height)` of them. `sample` is the name of their
/// type in numpy's words ([`crate::formats::raw_types`]). Floats are metres unless something else is stated.
///
/// # Errors
/// Those of [`crate::decode`], and [`crate::Error::Parameter`] for a type without a name or another number of samples.
///
/// ```
/// use depthplanes_io::{ReadOptions, frame_of_samples};
/// let depth_m: Vec<u8> = [1.5f64, 0.0, 2.0, 2.5].iter().flat_map(|depth| depth.to_le_bytes()).collect();
/// let frame = frame_of_samples(&depth_m, "float64", (2, 2), &ReadOptions::default())?;
/// assert_eq!((frame.encoding, frame.sensor.value_kind.depth_m(1.5)), ("metre", Some(1.5)));
/// # Ok::<(), depthplanes_io::Error>(())
/// ```
pub fn frame_of_samples(
    samples: &[u8],
    sample: &str,
    (width, height): (usize, usize),
    options: &ReadOptions,
) -> Result<Frame> {
    frame_of(image_of(samples, sample, (width, height), &options.decode.limits)?, IN_MEMORY, options)
}

/// What is the same for all maps of one size and type that are in memory: what their numbers mean, and the camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Settled {
    sensor: Sensor,
    valid_range: Option<(f64, f64)>,
    missing: Option<f64>,
    /// Whether a value for "missing" is to be looked for in each map.
    may_have_odd_values: bool,
}

impl Settled {
    /// Of a frame that [`frame_of_samples`] made of samples of `u8`, `u16` or `f32` with the same options; `None` where the
    /// reading rests on the map's values, or where these are others than the samples: each map is then read anew.
    pub fn of(frame: &Frame, options: &ReadOptions) -> Option<Settled> {
        let preset = options.preset.as_deref().map(presets::by_name).transpose().ok()?;
        let encoding = encoding::by_name(frame.encoding).ok()?;
        let is_changed = encoding.unpacks || options.ray_distance || options.swap_bytes;
        let (is_stated, disparity) = (options.encoding.is_some(), frame.provenance.disparity);
        if is_changed || rests_on_values(&frame.pixels, is_stated, disparity, preset.is_some()) {
            return None;
        }
        let missing = known_missing(options, preset, encoding, None, &frame.pixels);
        let may_have_odd_values =
            missing.is_none() && options.valid_range.is_none() && !matches!(frame.pixels, Pixels::U8(_));
        Some(Settled { sensor: frame.sensor, valid_range: frame.valid_range, missing, may_have_odd_values })
    }

    /// What the numbers mean, the camera and the noise.
    pub fn sensor(&self) -> Sensor {
        self.sensor
    }

    /// A map of that size and type, with the rule for which of its pixels are valid: as [`Frame::view`] of the same map.
    ///
    /// # Errors
    /// [`depthplanes::Error::ValidRange`].
    pub fn view<'m>(&self, map: impl Into<AnyView<'m>>) -> depthplanes::Result<AnyView<'m>> {
        let map = map.into();
        let odd = |value_kind: ValueKind| not_measured(map, value_kind).map(|(value, _)| value);
        let missing = self.missing.or_else(|| odd(self.sensor.value_kind).filter(|_| self.may_have_odd_values));
        with_validity(map, missing, self.valid_range)
    }
}

/// What is settled of the maps of one camera, by their size and type.
#[derive(Clone, Debug, Default)]
pub struct SettledMaps {
    /// The last one first.
    kinds: Vec<Known>,
}

/// What is known of the maps of one size and type.
#[derive(Clone, Debug)]
struct Known {
    kind: Kind,
    /// What is settled, if anything is.
    settled: Option<Arc<Settled>>,
    /// Whether one of them showed enough for a look at what the numbers mean.
    was_seen: bool,
}

/// A map of which fewer than one pixel in so many was measured shows nothing of what its numbers mean: cameras often begin with
/// blank frames. Maps of laser scanners that are sparse have one in thirty.
const BLANK: usize = 100;

/// Most sizes and types of a camera's maps that are remembered: a camera has few.
const MOST_KINDS: usize = 8;

/// Columns, rows, and bytes of a pixel; 0 of one whose numbers are converted.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Kind(usize, usize, u8);

impl Kind {
    fn of(map: &AnyView<'_>) -> Self {
        let bytes = match map {
            AnyView::U8(_) => 1,
            AnyView::U16(_) => 2,
            AnyView::F32(_) => 4,
        };
        Kind(map.width(), map.height(), bytes)
    }
}

impl SettledMaps {
    /// What is settled of maps of that size and type; `None` until one of them was measured, and if each of them is read anew.
    pub fn of(&self, map: &AnyView<'_>) -> Option<Arc<Settled>> {
        self.kinds.iter().find(|known| known.kind == Kind::of(map))?.settled.clone()
    }

    /// Remembers what is settled of a frame that [`frame_of_samples`] made with these options, and of maps like `map`, its samples
    /// where they lie; `None` if they do not lie as those of a map. Whether a person should know what there is to say of it: it is
    /// the first of its size and type, or the first of them of which anything was measured.
    pub fn add(&mut self, frame: &Frame, map: Option<&AnyView<'_>>, options: &ReadOptions) -> bool {
        let kind = map.map_or(Kind(frame.width, frame.height, 0), Kind::of);
        let at = self.kinds.iter().position(|known| known.kind == kind);
        if at.is_some_and(|at| self.kinds[at].was_seen) {
            return false;
        }
        let was_seen = frame
            .view()
            .is_ok_and(|view| with_view!(view, view => view.valid_pixels()) * BLANK >= frame.width * frame.height);
        let settled = map.filter(|_| was_seen).and_then(|_| Settled::of(frame, options)).map(Arc::new);
        if let Some(at) = at {
            self.kinds.remove(at);
        }
        self.kinds.truncate(MOST_KINDS - 1);
        self.kinds.insert(0, Known { kind, settled, was_seen });
        at.is_none() || was_seen
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use depthplanes::{DepthView, Detector};

    fn bytes(values: &[u16]) -> Vec<u8> {
        values.iter().flat_map(|value| value.to_le_bytes()).collect()
    }

    /// A wall with a corner that was not measured.
    fn wall(far: u16, hole: u16) -> Vec<u16> {
        (0..64 * 48).map(|at| if at % 64 < 20 && at / 64 < 20 { hole } else { far + (at % 7) as u16 }).collect()
    }

    #[test]
    fn a_later_map_is_read_where_it_lies_as_if_it_were_alone() {
        let options = ReadOptions::default();
        let first = frame_of_samples(&bytes(&wall(2000, 0)), "uint16", (64, 48), &options).unwrap();
        let settled = Settled::of(&first, &options).expect("millimetres need no look at the values");
        // Only the second map has a value that no sensor measures.
        for map in [wall(2000, 0), wall(1500, 65_535)] {
            let alone = frame_of_samples(&bytes(&map), "uint16", (64, 48), &options).unwrap();
            let mut detector = Detector::default().sensor(alone.sensor);
            let expected = detector.detect(alone.view().unwrap()).unwrap().clone();
            assert_eq!(settled.sensor(), alone.sensor);
            let view = settled.view(DepthView::new(&map, 64, 48).unwrap()).unwrap();
            assert_eq!(detector.detect(view).unwrap(), &expected);
        }
    }

    #[test]
    fn maps_are_remembered_by_size_and_type() {
        let options = ReadOptions::default();
        let (values, halves) = (wall(2000, 0), wall(2000, 0).split_off(64 * 24));
        let frame = frame_of_samples(&bytes(&values), "uint16", (64, 48), &options).unwrap();
        let view: AnyView<'_> = DepthView::new(&values, 64, 48).unwrap().into();
        let lower: AnyView<'_> = DepthView::new(&halves, 64, 24).unwrap().into();
        let mut maps = SettledMaps::default();
        assert!(maps.of(&view).is_none() && maps.add(&frame, Some(&view), &options));
        assert!(maps.of(&view).is_some() && !maps.add(&frame, Some(&view), &options));
        assert!(maps.of(&lower).is_none());
        assert!(maps.add(&frame, None, &options) && !maps.add(&frame, None, &options));
    }

    #[test]
    fn nothing_is_settled_by_blank_maps() {
        let options = ReadOptions::default();
        let mut maps = SettledMaps::default();
        let mut add = |values: &[u16]| {
            let frame = frame_of_samples(&bytes(values), "uint16", (64, 48), &options).unwrap();
            let view: AnyView<'_> = DepthView::new(values, 64, 48).unwrap().into();
            (maps.add(&frame, Some(&view), &options), maps.of(&view).is_some())
        };
        let blank = vec![0; 64 * 48];
        let mut specks = blank.clone();
        specks[..30].fill(1234);
        let told = [&blank, &blank, &specks, &wall(2000, 0), &blank].map(|values| add(values));
        assert_eq!(told, [(true, false), (false, false), (false, false), (true, true), (false, true)]);
    }

    #[test]
    fn what_rests_on_the_values_is_read_anew() {
        let settled = |options: &ReadOptions| {
            let frame = frame_of_samples(&bytes(&wall(800, 0)), "uint16", (64, 48), options).unwrap();
            Settled::of(&frame, options).is_some()
        };
        let named = |name: &str| ReadOptions { encoding: Some(name.into()), ..ReadOptions::default() };
        assert!(settled(&named("tum")) && !settled(&named("kinect-sdk")));
        assert!(!settled(&ReadOptions { disparity: true, ..ReadOptions::default() }));
        assert!(settled(&ReadOptions { disparity: true, ..named("kitti") }));
        assert!(settled(&ReadOptions { preset: Some("kinect1".into()), ..ReadOptions::default() }));
    }

    #[test]
    fn floats_are_metres_and_other_types_follow_the_rules_of_files() {
        let floats: Vec<u8> = [3000.0f32; 12].iter().flat_map(|value| value.to_le_bytes()).collect();
        let frame = frame_of_samples(&floats, "float32", (4, 3), &ReadOptions::default()).unwrap();
        assert_eq!((frame.encoding, frame.format), ("metre", "array"));
        let signed: Vec<u8> = [-1i32, 1500, 70_000, 0].iter().flat_map(|value| value.to_le_bytes()).collect();
        let frame = frame_of_samples(&signed, "int32", (2, 2), &ReadOptions::default()).unwrap();
        assert_eq!(frame.pixels, Pixels::F32(vec![0.0, 1500.0, 70_000.0, 0.0]));
        let error = frame_of_samples(&signed, "int32", (2, 3), &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().contains("16 bytes"), "{error}");
    }
}
