//! ransac: planes by random sampling (Schnabel, Wahl, Klein, *Efficient RANSAC for point-cloud shape detection*, 2007),
//! from its description. It finds the planes of HSBSR (Labatut, Pons, Keriven 2009).
//!
//! In: any map; lengths are in metres where unit and camera are known. Out: connected pieces of planes through three
//! points with normals. The octree over points is a quadtree over pixels here, and pieces are connected in the image.
//! It stops when the probability of having overlooked a plane of more than `min-pixels` pixels is as small as stated. What
//! is nearer to a plane than `epsilon` is part of it, low steps and shallow bends included.

mod draw;
mod score;

use super::affine::Affine;
use super::baseline::{Baseline, Input, SEED, Segmented, Values};
use super::cloud::Cloud;
use super::pieces::{EPSILON, Pieces, Tolerance};
use crate::limits::MAX_PLANES;
use crate::methods::extraction::{MIN_PIXELS, STAGES};
use crate::methods::method::Job;
use crate::methods::parameter::{Param, ParamKind};
use crate::util::random::Random;
use draw::Draws;
use score::{Candidate, FIRST, Free};

/// Draws between two looks at the candidates.
const BATCH: usize = 128;
/// A piece of this share of the largest is as good, since planes are fitted to their pieces (our choice).
const GOOD: f64 = 0.9;

pub(super) struct Ransac {
    min_pixels: usize,
    epsilon: f64,
    cosine: f64,
    overlooked: f64,
    reach: usize,
    seed: u64,
}

impl Baseline for Ransac {
    const NAME: &'static str = "ransac";
    const ABOUT: &'static str = "Finds planes by random sampling (Efficient RANSAC, Schnabel et al. 2007, the detector of HSBSR), from its description.";
    const STAGES: &'static [&'static str] = &["points", "search", STAGES[0], STAGES[1], STAGES[2], STAGES[3]];
    const PARAMS: &'static [Param] = &[
        MIN_PIXELS,
        EPSILON,
        Param {
            name: "angle",
            alias: None,
            default: 25.0,
            min: 0.0,
            max: 90.0,
            kind: ParamKind::Real,
            unit: "degrees",
            meaning: "How far a point's normal may lie from that of its plane.",
            source: Some("Schnabel et al. 2007"),
        },
        Param {
            name: "overlooked",
            alias: None,
            default: 0.05,
            min: 0.001,
            max: 0.5,
            kind: ParamKind::Real,
            unit: "probability",
            meaning: "Accepted probability of overlooking a plane; a smaller one takes longer.",
            source: Some("Schnabel et al. 2007"),
        },
        Param {
            name: "reach",
            alias: None,
            default: 4.0,
            min: 1.0,
            max: 100.0,
            kind: ParamKind::Whole,
            unit: "pixels",
            meaning: "Radius of the window that a point's normal is fitted to.",
            source: None,
        },
        SEED,
    ];

    fn new(values: &Values<'_>) -> Self {
        Ransac {
            min_pixels: values.whole(MIN_PIXELS.name),
            epsilon: values.of("epsilon"),
            // Rounding may not cost a flat wall its points.
            cosine: values.of("angle").to_radians().cos() - 1e-9,
            overlooked: values.of("overlooked"),
            reach: values.whole("reach"),
            seed: values.whole("seed") as u64,
        }
    }

    fn segment(&self, map: &Input<'_>, job: &mut Job<'_>) -> Segmented {
        let cloud = Cloud::of(&map.affine, &map.sensor, self.reach);
        job.done("points");
        let image = self.search(&map.affine, &cloud);
        job.done("search");
        Segmented { image, noise: None }
    }
}

impl Ransac {
    /// The region of every pixel, 0 for none (section 4 of Schnabel et al.).
    fn search(&self, affine: &Affine, cloud: &Cloud) -> Vec<u16> {
        let mut random = Random::new(self.seed);
        let mut pieces = Pieces::new(affine, cloud, Tolerance::new(self.epsilon, self.cosine, cloud), self.reach);
        let mut free = Free::new(cloud, &mut random);
        let mut draws = Draws::new(affine);
        let mut candidates: Vec<Candidate> = Vec::new();
        while free.len() > self.min_pixels && pieces.count() < MAX_PLANES && !pieces.work.is_spent() {
            pieces.work.count(BATCH * FIRST.min(free.len()));
            candidates.extend((0..BATCH).filter_map(|_| draws.draw(&free, &pieces, &mut random)));
            candidates.retain(|candidate| candidate.most > self.min_pixels as f64);
            while let Some(best) = self.best(&mut candidates, &free, &mut pieces, &draws) {
                let Candidate { plane, samples, .. } = candidates.swap_remove(best);
                if let Some(size) = pieces.take(&plane, &samples, self.min_pixels) {
                    pieces.work.count(free.len());
                    draws.forget(size as f64 / free.len() as f64);
                    free.retain(&pieces);
                    candidates.retain(|candidate| candidate.samples.iter().all(|&at| pieces.is_free(at as usize)));
                    candidates.iter_mut().for_each(Candidate::restart);
                }
            }
            if draws.missed(self.min_pixels as f64 + 1.0, free.len()) < self.overlooked {
                break;
            }
        }
        pieces.finish()
    }

    /// The candidate with the largest piece, or nearly, if one with as large a piece is likely to have been drawn by now.
    ///
    /// The candidate that may have the largest piece is tested on more points, until one whose piece is known is as good.
    fn best(
        &self,
        candidates: &mut Vec<Candidate>,
        free: &Free,
        pieces: &mut Pieces<'_>,
        draws: &Draws,
    ) -> Option<usize> {
        while !pieces.work.is_spent() {
            pieces.work.count(candidates.len());
            let most = |&a: &usize, &b: &usize| candidates[a].most.total_cmp(&candidates[b].most);
            let top = (0..candidates.len()).max_by(most)?;
            if draws.missed(candidates[top].most, free.len()) > self.overlooked {
                return None;
            }
            let known = (0..candidates.len()).filter(|&at| candidates[at].is_known).max_by(most);
            if let Some(known) = known.filter(|&known| candidates[known].most >= GOOD * candidates[top].most) {
                return Some(known);
            }
            candidates[top].refine(free, pieces);
            if candidates[top].most <= self.min_pixels as f64 {
                candidates.swap_remove(top);
            }
        }
        None
    }
}
