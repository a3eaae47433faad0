//! fpdidm: regions grown from the flattest pixels and tested against chance, our reconstruction of Bughin, Almansa,
//! Grompone von Gioi and Tendero, *Fast Plane Detection in Disparity Maps*, ICIP 2010.
//!
//! In: any map. Out: connected regions aligned with a plane that chance would not make; other pixels have no plane.
//! The paper's text was not at hand: the plan is that of the line detector LSD, by one of its authors, which grows
//! first and validates afterwards. Fast; unlike `ppdfdm`, it does not look twice at a region that starts on the wrong plane.

use super::a_contrario::{Abc, Background, DELTA, EPS, Region, paint};
use super::affine::{Affine, Around};
use super::baseline::{Baseline, Input, Segmented, Values};
use crate::methods::extraction::{MIN_PIXELS, STAGES};
use crate::methods::method::Job;
use crate::methods::parameter::{Param, ParamKind};
use crate::statistics::least_squares::Moments;

/// Smallest share of delta to which a region that chance explains is cut, by halves (five times, as in LSD).
const SMALLEST: f64 = 1.0 / 32.0;

pub(super) struct Fpdidm {
    min_pixels: usize,
    log10_eps: f64,
    delta: f64,
    radius: usize,
}

impl Baseline for Fpdidm {
    const NAME: &'static str = "fpdidm";
    const ABOUT: &'static str = "Grows regions from the flattest pixels and keeps those that chance does not explain; our reconstruction of Bughin et al. 2010.";
    const STAGES: &'static [&'static str] = &["planes", "grow", STAGES[0], STAGES[1], STAGES[2], STAGES[3]];
    const PARAMS: &'static [Param] = &[
        MIN_PIXELS,
        EPS,
        DELTA,
        Param {
            name: "radius",
            alias: None,
            default: 3.0,
            min: 1.0,
            max: 100.0,
            kind: ParamKind::Whole,
            unit: "pixels",
            meaning: "Radius of the window whose plane a region starts from: 2 radius + 1 columns and rows.",
            source: None,
        },
    ];

    fn new(values: &Values<'_>) -> Self {
        Fpdidm {
            min_pixels: values.whole(MIN_PIXELS.name),
            log10_eps: values.of("eps").log10(),
            delta: values.of("delta"),
            radius: values.whole("radius"),
        }
    }

    fn segment(&self, map: &Input<'_>, job: &mut Job<'_>) -> Segmented {
        let noise = map.noise();
        let mut background = Background::of(&map.affine, &noise, self.delta);
        let around = map.affine.planes(self.radius);
        job.done("planes");
        let regions = self.search(&mut background, &around);
        job.done("grow");
        Segmented { image: paint(regions.iter(), around.len()), noise: Some(noise) }
    }
}

impl Fpdidm {
    /// The regions that are planes, from the flattest seed on.
    fn search(&self, background: &mut Background<'_>, around: &[Option<Around>]) -> Vec<Region> {
        let mut is_free = vec![true; around.len()];
        let mut is_seed = is_free.clone();
        let mut found = Vec::new();
        for (seed, plane) in seeds(background, around) {
            if background.work.is_spent() {
                break;
            }
            if !is_seed[seed] {
                continue;
            }
            let (members, plane) = self.grow(background, seed, plane, &is_free);
            // Seeds that grew no plane may still join one.
            members.iter().for_each(|&at| is_seed[at as usize] = false);
            if let Some(region) = self.validate(background, seed, &plane, &is_free) {
                for &at in &region.pixels {
                    (is_free[at as usize], is_seed[at as usize]) = (false, false);
                }
                found.push(region);
            }
        }
        found
    }

    /// Free pixels that are aligned with the seed's plane, which is fitted anew whenever they have become a quarter more.
    fn grow(&self, background: &mut Background<'_>, seed: usize, mut plane: Abc, is_free: &[bool]) -> (Vec<u32>, Abc) {
        let affine = background.affine;
        let ([u, v], q) = (affine.place(seed), affine.q[seed]);
        let mut members = vec![seed as u32];
        let mut sums = Moments::default();
        sums.add(0.0, 0.0, 0.0);
        // With fewer pixels the plane of the window is the better one.
        let mut fit_at = (2 * self.radius + 1).pow(2);
        let mut next = 0;
        background.start_flood();
        background.see(seed);
        while let Some(&at) = members.get(next) {
            next += 1;
            for beside in around_pixel(affine, at as usize) {
                if is_free[beside] && background.off(&plane, beside) <= 1.0 && background.see(beside) {
                    members.push(beside as u32);
                    let [x, y] = affine.place(beside);
                    sums.add(x - u, y - v, affine.q[beside] - q);
                    if members.len() >= fit_at {
                        fit_at = members.len() * 5 / 4 + 1;
                        plane = sums.fit().map_or(plane, |fit| fit.moved([u, v, q]).abc);
                    }
                }
            }
        }
        background.work.count(members.len());
        (members, sums.fit().map_or(plane, |fit| fit.moved([u, v, q]).abc))
    }

    /// The pixels connected with the seed that are aligned with the plane, cut to smaller deltas until chance does
    /// not explain them; none if it always does.
    fn validate(&self, background: &mut Background<'_>, seed: usize, plane: &Abc, is_free: &[bool]) -> Option<Region> {
        let mut region = background.settle(seed, plane, is_free)?;
        let mut scale = 1.0;
        while region.log10_nfa > self.log10_eps && scale > SMALLEST {
            scale /= 2.0;
            region = background.region(seed, &region.plane, scale, is_free)?;
        }
        Some(region).filter(|region| region.pixels.len() > self.min_pixels && region.log10_nfa <= self.log10_eps)
    }
}

/// Pixels and the planes around them, the flattest first: by the residuals in deltas.
fn seeds(background: &Background<'_>, around: &[Option<Around>]) -> Vec<(usize, Abc)> {
    let known = around.iter().enumerate().filter_map(|(at, around)| Some((at, around.as_ref()?)));
    let mut order: Vec<_> = known.map(|(at, around)| (around.rms / background.delta[at], at, around)).collect();
    order.sort_by(|(one, ..), (other, ..)| one.total_cmp(other));
    let plane = |at: usize, &Around { gradient: [a, b], q, .. }: &Around| {
        let [u, v] = background.affine.place(at);
        [a, b, q - a * u - b * v]
    };
    order.into_iter().map(|(_, at, around)| (at, plane(at, around))).collect()
}

/// The eight neighbours of a pixel.
fn around_pixel(affine: &Affine, at: usize) -> impl Iterator<Item = usize> + use<> {
    let (u, v, width) = (at % affine.width, at / affine.width, affine.width);
    let (rows, columns) = (v.saturating_sub(1)..(v + 2).min(affine.height), u.saturating_sub(1)..(u + 2).min(width));
    rows.flat_map(move |y| columns.clone().map(move |x| y * width + x)).filter(move |&other| other != at)
}
