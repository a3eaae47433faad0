//! Why a pixel has a plane or none.
//!
//! In: a run of the method that is observed at a few checkpoints. Out: an [`Explanation`]: what was seen ([`Trace`]),
//! the verdict, and changes of parameters that were tried.

use super::grow::fewest;
use super::parameters::Planar;
use super::pipeline::{Checkpoint, Runner};
use super::trace::{Fate, Trace, label_of};
use crate::detection::Detection;
use crate::error::Result;
use crate::explanation::{Explanation, Limit, Verdict};
use crate::map::AnyView;
use crate::map::with_view;
use crate::methods::method::{Job, MethodInfo};
use crate::methods::tries::{Change, Tries, rounded_down, rounded_up, smaller_min};
use crate::noise::{NoiseModel, Space};

/// Factors by which the noise or the inlier threshold may be raised for a suggestion; with more, anything is a plane.
const FACTORS: [f64; 6] = [1.0, 1.2, 1.5, 2.0, 3.0, 4.0];
/// Bows of less than so many times what is taken for flat may be those of a distorted plane.
const SLIGHT: f64 = 1.5;
/// Largest inlier threshold that is suggested: further off, a pixel is on something else.
const MOST_INLIER_THRESHOLD: f64 = 12.0;

/// Says why a pixel has a plane or none. `info`: the row of the method, whose parameters are tried.
///
/// # Errors
/// As [`crate::Detector::explain`].
pub(super) fn explain(
    runner: &mut Runner,
    info: &'static MethodInfo,
    map: AnyView<'_>,
    job: &mut Job<'_>,
    at: [usize; 2],
) -> Result<Explanation> {
    let (mut seen, mut out) = (Trace::new(at, job.sensor), Detection::default());
    let mut observe = |moment: Checkpoint, run: &Runner, noise: &NoiseModel| seen.look(moment, run, noise);
    with_view!(map, map => runner.planar(map, job, &mut out, &mut observe))?;
    let value = with_view!(map, map => map.row(at[1])[at[0]].into());
    seen.conclude(runner, &out);
    let verdict = seen.verdict(runner, &out);
    let verdict = if seen.is_dropped(&out) { dropped(runner, map, job, at)? } else { verdict };
    let mut findings = vec![seen.pixel(value)];
    findings.append(&mut seen.findings);
    let values = runner.params.values();
    let tries = Tries { info, values: &values, map, sensor: job.sensor, at, planes: out.planes.len() };
    let suggestions = seen.changes(&verdict, runner).into_iter().filter_map(|changes| tries.first(changes)).collect();
    Ok(Explanation { at, method: info.name, findings, verdict, suggestions })
}

/// Which of the conditions on whole planes drops that of a pixel: its area.
fn dropped(run: &Runner, map: AnyView<'_>, job: &mut Job<'_>, at: [usize; 2]) -> Result<Verdict> {
    let mut all = Detection::default();
    let mut other = Runner { params: Planar { min_area: 0.0, ..run.params }, ..Runner::default() };
    with_view!(map, map => other.planar(map, job, &mut all, &mut |_, _, _| ()))?;
    let plane = all.labels[at[1] * all.width + at[0]].checked_sub(1).map(|index| &all.planes[usize::from(index)]);
    let area = plane.and_then(|plane| plane.metric.as_ref()?.area_m2).unwrap_or(0.0);
    Ok(Verdict::Dropped { parameter: "min-area", value: area, limit: Limit::AtLeast(run.params.min_area) })
}

impl Trace {
    fn verdict(&self, run: &Runner, out: &Detection) -> Verdict {
        let label = out.labels[self.at[1] * out.width + self.at[0]];
        let [pixels, roughness] = self.tile;
        let least = f64::from(fewest(&run.pyramid.grids[0]));
        let nearest = self.against.iter().find(|against| !against.is_curved);
        let is_on_curved = self.against.first().is_some_and(|against| against.is_curved && against.off <= self.most);
        if label > 0 {
            let chosen = self.against.iter().find(|against| against.id + 1 == u32::from(self.assigned));
            let off = chosen.map(|against| against.off);
            return Verdict::Plane { label, pixels: out.planes[usize::from(label) - 1].pixel_count, off };
        }
        if self.q.is_nan() {
            return Verdict::NotMeasured;
        }
        if self.assigned > 0 {
            return Verdict::Small { pixels: self.piece, min: run.params.min, early: false };
        }
        match (self.fate, nearest) {
            (Fate::Small(pixels), _) => Verdict::Small { pixels: pixels as usize, min: run.params.min, early: true },
            (Fate::Curved, _) => Verdict::Curved,
            (Fate::EdgeOn, _) => Verdict::EdgeOn,
            (Fate::None, _) if is_on_curved => Verdict::Curved,
            (Fate::None, _) if pixels < least => Verdict::Sparse { pixels: pixels as usize, least: least as usize },
            (_, Some(near)) if near.off <= MOST_INLIER_THRESHOLD.max(2.0 * self.most) || self.fate != Fate::None => {
                Verdict::Off { off: near.off, most: self.most, label: label_of(run, out, near.id) }
            }
            _ if roughness > 1.0 => Verdict::Uneven { roughness },
            _ => Verdict::Alone,
        }
    }

    /// Whether its piece is large enough and has no label all the same.
    fn is_dropped(&self, out: &Detection) -> bool {
        self.is_large && out.labels[self.at[1] * out.width + self.at[0]] == 0
    }

    /// Changes worth trying, a list for each parameter.
    fn changes(&self, verdict: &Verdict, run: &Runner) -> Vec<Vec<Change>> {
        let inlier_threshold = run.params.inlier_threshold;
        let nothing = Vec::new;
        match *verdict {
            Verdict::Small { pixels, .. } => vec![smaller_min(pixels).collect()],
            Verdict::Off { off, most, .. } => {
                let times = off / most;
                vec![self.inlier_thresholds(times * inlier_threshold), self.noises(run, times)]
            }
            Verdict::Uneven { .. } | Verdict::Alone | Verdict::Sparse { .. } => {
                vec![
                    smaller_min(run.params.min as usize / 2).take(3).collect(),
                    self.inlier_thresholds(inlier_threshold),
                    self.noises(run, 1.2),
                ]
            }
            Verdict::Dropped { parameter, value, .. } => {
                let smaller = [0.99 * value, 0.0].map(|value| vec![(parameter, rounded_down(value))]);
                vec![smaller.to_vec()]
            }
            // Sensors bend walls a little; a ball is bent by much more.
            Verdict::Curved => {
                self.bow.filter(|bow| *bow < SLIGHT).map(|bow| self.noises(run, bow)).into_iter().collect()
            }
            _ => nothing(),
        }
    }

    fn inlier_thresholds(&self, least: f64) -> Vec<Change> {
        let values = FACTORS.map(|factor| rounded_up(1.01 * factor * least));
        values
            .into_iter()
            .filter(|&value| value <= MOST_INLIER_THRESHOLD)
            .map(|value| vec![("inlier-threshold", value)])
            .collect()
    }

    /// The noise in use so many times, as parameters.
    fn noises(&self, run: &Runner, least: f64) -> Vec<Change> {
        let Some(noise) = self.noise else { return Vec::new() };
        // What `noise-scale` makes of it comes on top again.
        let here = noise.variance(self.q).sqrt() / run.params.noise_scale;
        let most = FACTORS[FACTORS.len() - 1];
        let factors = FACTORS.into_iter().map(|factor| 1.01 * factor * least).filter(|&factor| factor <= most);
        let scaled = |factor: f64| match Space::of(self.sensor.measure) {
            Space::Value => vec![("noise", rounded_up(factor * here))],
            Space::InverseDepth { .. } => {
                let (z, sigma_m) = (self.q.recip(), here / (self.q * self.q));
                // At no range, as good as; what is below a nanometre is growth.
                let base = noise.depth_sigma_m(1e-6).filter(|base| *base > 1e-9).unwrap_or(0.0);
                let own = noise.depth_sigma_m(z).unwrap_or(0.0);
                let growth = ((own - base) / (z * z)).max(0.0);
                // What rounding adds counts as well, since the noise as stated may be nothing.
                let times = factor * sigma_m / own;
                if own > 0.0 && own > 0.3 * sigma_m {
                    vec![("noise", rounded_up(times * base)), ("noise-growth", rounded_up(times * growth))]
                } else {
                    vec![("noise", rounded_up(factor * sigma_m)), ("noise-growth", 0.0)]
                }
            }
        };
        factors.map(scaled).collect()
    }
}
