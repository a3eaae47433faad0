//! gradient: neighbour grouping on gradients, as Hoa, Minh and Dung's later method for ground planes does, from its
//! description.
//!
//! In: any map. Out: connected regions whose neighbours have the same gradient: the (a, b) of the plane around a
//! pixel (eq. 5), in inverse depth or disparity, where a plane has one gradient. Unlike `ngaf` it tells surfaces that
//! meet at a crease. It does not tell parallel planes from each other unless values have to be continuous as well,
//! and loses what is narrower than its window.

use super::affine::{Affine, Around};
use super::baseline::{Baseline, Input, Segmented, Values};
use crate::limits::MAX_PLANES;
use crate::methods::extraction::{MIN_PIXELS, STAGES};
use crate::methods::method::Job;
use crate::methods::parameter::{Param, ParamKind};
use crate::noise::NoiseModel;

pub(super) struct Gradient {
    min_pixels: usize,
    /// Largest difference of gradients.
    theta: f64,
    radius: usize,
    continuity: f64,
}

impl Baseline for Gradient {
    const NAME: &'static str = "gradient";
    const ABOUT: &'static str =
        "Groups neighbours of the same depth gradient, after the description of Hoa, Minh and Dung's ground method.";
    const STAGES: &'static [&'static str] = &["gradients", "link", STAGES[0], STAGES[1], STAGES[2], STAGES[3]];
    const PARAMS: &'static [Param] = &[
        MIN_PIXELS,
        Param {
            name: "theta-gradient",
            alias: None,
            default: 3.0,
            min: 0.0,
            max: f64::MAX,
            kind: ParamKind::Real,
            unit: "standard deviations",
            meaning: "Largest difference between neighbours' gradients, in standard deviations of a window's gradient.",
            source: Some("eq. 5"),
        },
        Param {
            name: "radius",
            alias: None,
            default: 5.0,
            min: 1.0,
            max: 100.0,
            kind: ParamKind::Whole,
            unit: "pixels",
            meaning: "Gradients are those of windows of 2 radius + 1 columns and rows.",
            source: None,
        },
        Param {
            name: "continuity",
            // Three standard deviations of the difference of two pixels.
            alias: None,
            default: 4.2,
            min: 0.0,
            max: f64::MAX,
            kind: ParamKind::Real,
            unit: "standard deviations",
            meaning: "Largest distance of neighbours from each other's planes, in standard deviations of a pixel's noise; 0 for off, as in the description.",
            source: None,
        },
    ];

    fn new(values: &Values<'_>) -> Self {
        Gradient {
            min_pixels: values.whole(MIN_PIXELS.name),
            theta: values.of("theta-gradient"),
            radius: values.whole("radius"),
            continuity: values.of("continuity"),
        }
    }

    fn segment(&self, map: &Input<'_>, job: &mut Job<'_>) -> Segmented {
        let noise = map.noise();
        let gradients = self.gradients(&map.affine);
        job.done("gradients");
        let image = self.link(&map.affine, &noise, &gradients);
        job.done("link");
        Segmented { image, noise: Some(noise) }
    }
}

impl Gradient {
    /// For each pixel the gradient of the flattest of nine windows that hold it: around it, beside it, at its corners. One
    /// of them is clear of an edge nearby, as in Kuwahara's filter (our choice: at an edge the window around a pixel has
    /// the gradient of neither side).
    fn gradients(&self, affine: &Affine) -> Vec<Option<[f64; 2]>> {
        let around = affine.planes(self.radius);
        let reach = self.radius as isize;
        let within = |place: usize, by: isize, side: usize| place.checked_add_signed(by).filter(|&at| at < side);
        let flattest = |at: usize| {
            let (u, v) = (at % affine.width, at / affine.width);
            let mut best: Option<&Around> = None;
            for down in [0, -reach, reach] {
                for right in [0, -reach, reach] {
                    let place = within(u, right, affine.width).zip(within(v, down, affine.height));
                    let window = place.and_then(|(u, v)| around[v * affine.width + u].as_ref());
                    if window.is_some_and(|window| best.is_none_or(|best| window.rms < best.rms)) {
                        best = window;
                    }
                }
            }
            best.map(|best| best.gradient)
        };
        (0..around.len()).map(|at| flattest(at).filter(|_| affine.q[at].is_finite())).collect()
    }

    /// The group of every pixel, 0 for none and for small ones.
    fn link(&self, affine: &Affine, noise: &NoiseModel, gradients: &[Option<[f64; 2]>]) -> Vec<u16> {
        let mut image = vec![0; gradients.len()];
        let mut is_taken = vec![false; gradients.len()];
        let (mut groups, mut members) = (0, Vec::new());
        for seed in 0..gradients.len() {
            if std::mem::replace(&mut is_taken[seed], true) {
                continue;
            }
            members.clear();
            members.push(seed);
            let mut next = 0;
            while let Some(&at) = members.get(next) {
                next += 1;
                for beside in affine.neighbours(at) {
                    if !is_taken[beside] && self.belong(affine, noise, gradients, [at, beside]) {
                        is_taken[beside] = true;
                        members.push(beside);
                    }
                }
            }
            if members.len() > self.min_pixels && gradients[seed].is_some() && groups < MAX_PLANES {
                groups += 1;
                members.iter().for_each(|&at| image[at] = groups as u16);
            }
        }
        image
    }

    /// Whether two neighbours belong together.
    fn belong(
        &self,
        affine: &Affine,
        noise: &NoiseModel,
        gradients: &[Option<[f64; 2]>],
        [one, other]: [usize; 2],
    ) -> bool {
        let (Some(first), Some(second)) = (gradients[one], gradients[other]) else { return false };
        let sigma = noise.variance(affine.q[one].max(affine.q[other])).sqrt();
        let alike = self.theta * sigma * self.gradient_sigma();
        let is_alike = (0..2).all(|axis| (first[axis] - second[axis]).abs() <= alike);
        is_alike
            && (self.continuity == 0.0 || self.step(affine, [first, second], [one, other]) <= self.continuity * sigma)
    }

    /// How far two neighbours lie off the plane that goes on from one to the other.
    fn step(&self, affine: &Affine, [first, second]: [[f64; 2]; 2], [one, other]: [usize; 2]) -> f64 {
        let ([u, v], [x, y]) = (affine.place(one), affine.place(other));
        let rise = [0, 1].map(|axis| (first[axis] + second[axis]) / 2.0);
        (affine.q[other] - affine.q[one] - rise[0] * (x - u) - rise[1] * (y - v)).abs()
    }

    /// Standard deviation of a window's gradient, for pixels of standard deviation 1.
    fn gradient_sigma(&self) -> f64 {
        let radius = self.radius as f64;
        let side = 2.0 * radius + 1.0;
        (3.0 / (side * side * radius * (radius + 1.0))).sqrt()
    }
}
