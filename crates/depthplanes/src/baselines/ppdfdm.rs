//! ppdfdm: a contrario search for planar patches, our reconstruction of Bughin and Almansa, *Planar Patch Detection for
//! Disparity Maps*, 3DPVT 2010.
//!
//! In: any map. Out: connected regions aligned with a plane that chance would not make, the most meaningful first; other
//! pixels have no plane. The paper's text was not at hand: it is put together from what is known of it and from how a
//! contrario methods are made. Thorough; `fpdidm` is the fast one.

use super::a_contrario::{Abc, Background, DELTA, EPS, Region, paint};
use super::affine::Affine;
use super::baseline::{Baseline, Input, SEED, Segmented, Values};
use super::work::Work;
use crate::limits::MAX_PLANES;
use crate::methods::extraction::{MIN_PIXELS, STAGES};
use crate::methods::method::Job;
use crate::methods::parameter::{Param, ParamKind};
use crate::util::random::Random;
use std::collections::BTreeSet;

/// Most pixels that are looked at for each pixel of the map while planes are drawn; by default it is 60.
const LOOKS_OF_DRAWS: usize = 4096;
/// And in all, some seconds; but so few of a disc at least.
const MOST_LOOKS: usize = 400_000_000;
const FEW_OF_DISC: usize = 64;
/// Most pixels of a disc that are looked at; of more, every second one, third one and so on.
const MOST_OF_DISC: usize = 1024;

pub(super) struct Ppdfdm {
    min_pixels: usize,
    log10_eps: f64,
    delta: f64,
    spacing: usize,
    radius: usize,
    draws: usize,
    seed: u64,
}

/// A pixel with the plane around it.
struct Seed {
    at: usize,
    plane: Abc,
    /// Share of the disc's pixels that are aligned.
    share: f64,
}

impl Baseline for Ppdfdm {
    const NAME: &'static str = "ppdfdm";
    const ABOUT: &'static str =
        "Takes the region that chance explains least, again and again; our reconstruction of Bughin and Almansa 2010.";
    const STAGES: &'static [&'static str] = &["draw", "search", "merge", STAGES[0], STAGES[1], STAGES[2], STAGES[3]];
    const PARAMS: &'static [Param] = &[
        MIN_PIXELS,
        EPS,
        DELTA,
        Param {
            name: "spacing",
            alias: None,
            default: 8.0,
            min: 1.0,
            max: 1000.0,
            kind: ParamKind::Whole,
            unit: "pixels",
            meaning: "Columns and rows from one seed to the next.",
            source: None,
        },
        Param {
            name: "radius",
            alias: None,
            default: 8.0,
            min: 1.0,
            max: 100.0,
            kind: ParamKind::Whole,
            unit: "pixels",
            meaning: "Radius of the disc around a seed that three points are drawn from.",
            source: None,
        },
        Param {
            name: "draws",
            alias: None,
            default: 20.0,
            min: 1.0,
            max: 1000.0,
            kind: ParamKind::Whole,
            unit: "draws",
            meaning: "How often three points are drawn around a seed; the plane with the most aligned pixels in the disc counts.",
            source: None,
        },
        SEED,
    ];

    fn new(values: &Values<'_>) -> Self {
        Ppdfdm {
            min_pixels: values.whole(MIN_PIXELS.name),
            log10_eps: values.of("eps").log10(),
            delta: values.of("delta"),
            spacing: values.whole("spacing"),
            radius: values.whole("radius"),
            draws: values.whole("draws"),
            seed: values.whole("seed") as u64,
        }
    }

    fn segment(&self, map: &Input<'_>, job: &mut Job<'_>) -> Segmented {
        let noise = map.noise();
        let mut background = Background::of(&map.affine, &noise, self.delta);
        let seeds = self.draw(&background);
        job.done("draw");
        let mut regions = self.search(&mut background, &seeds);
        job.done("search");
        merge(&background, &mut regions);
        job.done("merge");
        Segmented { image: paint(regions.iter(), map.affine.q.len()), noise: Some(noise) }
    }
}

impl Ppdfdm {
    /// The seeds of a regular grid with their planes, the best first.
    fn draw(&self, background: &Background<'_>) -> Vec<Seed> {
        let Affine { width, height, .. } = *background.affine;
        let places = |side: usize| (self.spacing.min(side) / 2..side).step_by(self.spacing);
        let count = places(height).count() * places(width).count();
        // Close seeds with large discs look at every pixel again and again.
        let looks = (LOOKS_OF_DRAWS * self.spacing * self.spacing).min(MOST_LOOKS / count.max(1)).max(4 * FEW_OF_DISC);
        let grid = places(height).flat_map(|v| places(width).map(move |u| v * width + u));
        let mut seeds: Vec<Seed> = grid.filter_map(|at| self.plane_at(background, at, looks)).collect();
        seeds.sort_by(|one, other| other.share.total_cmp(&one.share));
        seeds
    }

    /// Draws planes through three pixels of the disc; of those the seed lies on, the one with the most aligned
    /// pixels, fitted to these.
    fn plane_at(&self, background: &Background<'_>, at: usize, looks: usize) -> Option<Seed> {
        let disc = self.disc(background.affine, at, looks / 4);
        let looks = looks / disc.len().max(1);
        let mut random = Random::new((self.seed << 32) ^ at as u64);
        let mut best = (Abc::default(), 0);
        for _ in 0..self.draws.min(looks.max(1)) {
            let three = [(); 3].map(|()| disc.get(random.whole(0, disc.len().saturating_sub(1))).copied());
            let [Some(one), Some(two), Some(three)] = three else { return None };
            let Some(plane) = background.fit(&[one, two, three]) else { continue };
            let is_aligned = |&at: &u32| background.off(&plane, at as usize) <= 1.0;
            let aligned = disc.iter().filter(|&at| is_aligned(at)).count();
            if aligned > best.1 && is_aligned(&(at as u32)) {
                best = (plane, aligned);
            }
        }
        let (plane, count) = best;
        let aligned: Vec<u32> = disc.iter().copied().filter(|&at| background.off(&plane, at as usize) <= 1.0).collect();
        Some(Seed { at, plane: background.fit(&aligned)?, share: count as f64 / disc.len() as f64 })
            .filter(|_| count > 0)
    }

    /// The valid pixels around a seed, or evenly some of them.
    fn disc(&self, affine: &Affine, at: usize, most: usize) -> Vec<u32> {
        let (u, v, radius) = (at % affine.width, at / affine.width, self.radius);
        // Every so many columns and rows, if all of them are too many.
        let step = (1..).find(|step| 4 * radius * radius <= most * step * step).unwrap_or(1);
        let first = |middle: usize| middle - middle.min(radius) / step * step;
        let span = |middle: usize, side: usize| (first(middle)..(middle + radius + 1).min(side)).step_by(step);
        let square = |a: usize, b: usize| a.abs_diff(b).pow(2);
        let all: Vec<u32> = span(v, affine.height)
            .flat_map(|y| span(u, affine.width).map(move |x| (x, y)))
            .filter(|&(x, y)| square(x, u) + square(y, v) <= radius * radius)
            .map(|(x, y)| y * affine.width + x)
            .filter(|&at| affine.q[at].is_finite())
            .map(|at| at as u32)
            .collect();
        let every = all.len().div_ceil(MOST_OF_DISC).max(1);
        all.into_iter().step_by(every).collect()
    }

    /// Takes the region with the fewest false alarms, and searches on in what is left.
    ///
    /// A seed inside of another's region waits (our choice, for speed): it would grow the same one.
    fn search(&self, background: &mut Background<'_>, seeds: &[Seed]) -> Vec<Region> {
        let area = background.affine.q.len();
        let (mut is_free, mut cover) = (vec![true; area], vec![0u32; area]);
        let mut waits = vec![true; seeds.len()];
        let mut open: Vec<(usize, Region)> = Vec::new();
        let mut found = Vec::new();
        while found.len() < MAX_PLANES && !background.work.is_spent() {
            background.work.count(seeds.len());
            for (number, seed) in seeds.iter().enumerate() {
                if waits[number] && is_free[seed.at] && cover[seed.at] == 0 {
                    waits[number] = false;
                    if background.work.is_spent() {
                        break;
                    }
                    if let Some(region) = background.settle(seed.at, &seed.plane, &is_free) {
                        region.pixels.iter().for_each(|&at| cover[at as usize] += 1);
                        open.push((number, region));
                    }
                }
            }
            let is_plane =
                |region: &Region| region.pixels.len() > self.min_pixels && region.log10_nfa <= self.log10_eps;
            let planes = open.iter().enumerate().filter(|(_, (_, region))| is_plane(region));
            let best = planes.min_by(|(_, (_, one)), (_, (_, other))| one.log10_nfa.total_cmp(&other.log10_nfa));
            let Some(best) = best.map(|(place, _)| place) else { break };
            let (_, region) = open.swap_remove(best);
            region.pixels.iter().for_each(|&at| is_free[at as usize] = false);
            found.push(region);
            background.work.count(open.iter().map(|(_, region)| region.pixels.len()).sum());
            // Regions that share pixels with it grow anew; the others stay as they are.
            open.retain(|(number, region)| {
                let is_touched = region.pixels.iter().any(|&at| !is_free[at as usize]);
                if is_touched {
                    region.pixels.iter().for_each(|&at| cover[at as usize] -= 1);
                    waits[*number] = true;
                }
                !is_touched
            });
        }
        found
    }
}

/// Joins two regions that touch if one plane explains both with fewer false alarms than two planes do.
fn merge(background: &Background<'_>, regions: &mut Vec<Region>) {
    let mut work = Work::new(background.affine.q.len());
    loop {
        let image = paint(regions.iter(), background.affine.q.len());
        let mut is_changed = vec![false; regions.len()];
        for [one, other] in touching(background.affine, &image) {
            if is_changed[one] || is_changed[other] || work.is_spent() {
                continue;
            }
            work.count(regions[one].pixels.len() + regions[other].pixels.len());
            let pixels = [&regions[one].pixels[..], &regions[other].pixels[..]].concat();
            let rim = regions[one].rim + regions[other].rim;
            let Some(plane) = background.fit(&pixels) else { continue };
            let log10_nfa = background.log10_nfa(&pixels, rim, &plane);
            if log10_nfa < regions[one].log10_nfa + regions[other].log10_nfa {
                regions[one] = Region { plane, pixels, rim, log10_nfa };
                regions[other].pixels.clear();
                (is_changed[one], is_changed[other]) = (true, true);
            }
        }
        if !is_changed.contains(&true) {
            return;
        }
        regions.retain(|region| !region.pixels.is_empty());
        work.count(background.affine.q.len());
    }
}

/// Pairs of regions that have pixels beside each other.
fn touching(affine: &Affine, image: &[u16]) -> BTreeSet<[usize; 2]> {
    let mut pairs = BTreeSet::new();
    for at in 0..image.len() {
        for beside in affine.neighbours(at) {
            let (one, other) = (usize::from(image[at]), usize::from(image[beside]));
            if 0 < one && one < other {
                pairs.insert([one - 1, other - 1]);
            }
        }
    }
    pairs
}
