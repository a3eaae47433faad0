//! The parameters of `ngaf`.

use super::enhance::WINDOW;
use crate::limits::MAX_SIDE;
use crate::methods::parameter::{Param, ParamKind, defaults, setters};
use crate::statistics::PlaneSums;

pub(super) const PARAMS: &[Param] = &[
    Param {
        name: "theta",
        alias: None,
        default: 1.0,
        min: 0.0,
        max: f64::MAX,
        kind: ParamKind::Real,
        unit: "map units",
        meaning: "Largest difference between neighbours of one group; the paper takes 1 for near-perfect maps, 2 for sensors.",
        source: Some("paper, 3c"),
    },
    Param {
        name: "min-pixels",
        alias: Some("min"),
        default: 32.0,
        min: 0.0,
        max: u32::MAX as f64,
        kind: ParamKind::Whole,
        unit: "pixels",
        meaning: "A group is a plane if it has more pixels than this; the paper calls it min and takes 32, 64, 128, 256.",
        source: Some("paper, 3d"),
    },
    Param {
        name: "window",
        alias: None,
        default: 0.0,
        min: *WINDOW.start() as f64,
        max: *WINDOW.end() as f64,
        kind: ParamKind::OddOrOff,
        unit: "pixels",
        meaning: "Side of the window whose mean fills a missing pixel, unless more than half of it is missing.",
        source: Some("paper, 3b"),
    },
    Param {
        name: "passes",
        alias: None,
        default: 1.0,
        min: 1.0,
        max: 100.0,
        kind: ParamKind::Whole,
        unit: "times",
        meaning: "How often the map is enhanced, each pass reading what the one before left; without `window` it does nothing.",
        source: None,
    },
    Param {
        name: "max-rms",
        alias: None,
        default: 0.0,
        min: 0.0,
        max: f64::MAX,
        kind: ParamKind::Real,
        unit: "map units",
        meaning: "Drops planes whose least-squares fit leaves a larger root mean square residual, or that have no fit; 0 for off.",
        source: None,
    },
    Param {
        name: "min-fill",
        alias: None,
        default: 0.0,
        min: 0.0,
        max: 1.0,
        kind: ParamKind::Real,
        unit: "share",
        meaning: "Drops planes that cover a smaller share of their bounding box; 0 for off.",
        source: None,
    },
    Param {
        name: "margin",
        alias: None,
        default: 0.0,
        min: 0.0,
        max: MAX_SIDE as f64,
        kind: ParamKind::Whole,
        unit: "pixels",
        meaning: "Pixels closer than this to the map's edge do not count towards `min-pixels`.",
        source: None,
    },
];

/// Parameters of the method `ngaf`: the defaults, which are the paper's, changed by setters.
///
/// ```
/// use depthplanes::{Detector, Ngaf};
/// let detector = Detector::new(Ngaf::default().theta(2.0).min_pixels(256))?;
/// # Ok::<(), depthplanes::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[non_exhaustive]
pub struct Ngaf {
    /// Largest difference between neighbours of one group, map units, 0 and up (section 3c).
    pub theta: f64,
    /// A group is a plane if it has strictly more pixels than this; the paper calls it min (section 3d).
    #[cfg_attr(feature = "serde", serde(alias = "min"))]
    pub min_pixels: u32,
    /// Side of the enhancing window, odd 3..=31, or 0 for no enhancing (section 3b).
    pub window: u32,
    /// How often to enhance, 1..=100. Ours.
    pub passes: u32,
    /// Largest rms residual of a plane's fit, map units; 0 for off. Ours.
    pub max_rms: f64,
    /// Least share of the bounding box that a plane covers, 0..=1; 0 for off. Ours.
    pub min_fill: f64,
    /// Pixels closer than this to the map's edge do not count towards `min-pixels`; 0 for off. Ours.
    pub margin: u32,
}

impl Ngaf {
    pub(super) fn from_values(values: &[f64]) -> Self {
        let &[theta, min_pixels, window, passes, max_rms, min_fill, margin] = values else {
            panic!("one value for each row of PARAMS");
        };
        let (min_pixels, window, passes, margin) = (min_pixels as u32, window as u32, passes as u32, margin as u32);
        Ngaf { theta, min_pixels, window, passes, max_rms, min_fill, margin }
    }

    pub(super) fn values(&self) -> [f64; 7] {
        let &Ngaf { theta, min_pixels, window, passes, max_rms, min_fill, margin } = self;
        [theta, min_pixels.into(), window.into(), passes.into(), max_rms, min_fill, margin.into()]
    }

    /// Whether a plane may be dropped after it was fitted.
    pub(super) fn has_conditions(&self) -> bool {
        self.max_rms > 0.0 || self.min_fill > 0.0 || self.margin > 0
    }

    /// Our own conditions on a plane of a map of that size.
    pub(super) fn accepts(&self, plane: &PlaneSums) -> bool {
        let flat = self.max_rms == 0.0 || plane.fit.is_some_and(|fit| fit.rms <= self.max_rms);
        let filled = plane.pixel_count as f64 >= self.min_fill * plane.bounding_box.area() as f64;
        flat && filled && plane.inner_pixels > self.min_pixels as usize
    }
}

impl Default for Ngaf {
    fn default() -> Self {
        Self::from_values(&defaults(PARAMS))
    }
}

setters!(Ngaf: theta: f64, min_pixels: u32, window: u32, passes: u32, max_rms: f64, min_fill: f64, margin: u32);
