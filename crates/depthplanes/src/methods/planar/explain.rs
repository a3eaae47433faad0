//! Why a pixel has a plane or none.
//!
//! In: a run of the method that is observed at a few checkpoints. Out: an [`Explanation`]: what was seen ([`Trace`]),
//! the verdict, and changes of parameters that were tried.

use super::grow::fewest;
use super::parameters::Planar;
use super::pipeline::{Checkpoint, Runner};
use super::trace::{Fate, Trace};
use crate::detection::Detection;
use crate::error::Result;
use crate::explanation::{Explanation, Limit, Verdict};
use crate::map::AnyView;
use crate::map::with_view;
use crate::methods::method::{Job, MethodInfo};
use crate::methods::tries::{Change, Tries, lower_min_pixels, rounded_down, rounded_up};
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
    let mut observe = |checkpoint: Checkpoint, run: &Runner, noise: &NoiseModel| seen.look(checkpoint, run, noise);
    with_view!(map, map => runner.planar(map, job, &mut out, &mut observe))?;
    let value = with_view!(map, map => map.row(at[1])[at[0]].into());
    seen.conclude(runner, &out);
    let verdict = verdict(&seen, runner, &out);
    let verdict = if is_dropped(&seen, &out) { dropped(runner, map, job, at)? } else { verdict };
    let mut findings = vec![seen.pixel(value)];
    findings.append(&mut seen.findings);
    let values = runner.params.values();
    let tries = Tries { info, values: &values, map, sensor: job.sensor, at, planes: out.planes.len() };
    let suggestions = changes(&seen, &verdict, runner).into_iter().filter_map(|changes| tries.first(changes)).collect();
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

fn verdict(trace: &Trace, run: &Runner, out: &Detection) -> Verdict {
    let label = out.labels[trace.at[1] * out.width + trace.at[0]];
    let [pixels, roughness] = trace.tile;
    let least = f64::from(fewest(&run.pyramid.grids[0]));
    let nearest = trace.against.iter().find(|against| !against.is_curved);
    if label > 0 {
        let chosen = trace.against.iter().find(|against| against.id + 1 == u32::from(trace.assigned));
        let off = chosen.map(|against| against.off);
        return Verdict::Plane { label, pixels: out.planes[usize::from(label) - 1].pixel_count, off };
    }
    if trace.q.is_nan() {
        return Verdict::NotMeasured;
    }
    if trace.assigned > 0 {
        return Verdict::Small { pixels: trace.piece, min_pixels: run.params.min_pixels, early: false };
    }
    if trace.is_on_curved {
        return Verdict::Curved;
    }
    match (trace.fate, nearest) {
        (Fate::Small(pixels), _) => {
            Verdict::Small { pixels: pixels as usize, min_pixels: run.params.min_pixels, early: true }
        }
        (Fate::Curved, _) => Verdict::Curved,
        (Fate::EdgeOn, _) => Verdict::EdgeOn,
        (Fate::None, _) if pixels < least => Verdict::Sparse { pixels: pixels as usize, least: least as usize },
        (_, Some(near)) if near.off <= MOST_INLIER_THRESHOLD.max(2.0 * trace.most) || trace.fate != Fate::None => {
            Verdict::Off { off: near.off, most: trace.most, label: run.label_of(out, near.id) }
        }
        _ if roughness > 1.0 => Verdict::Uneven { roughness },
        _ => Verdict::Alone,
    }
}

/// Whether its piece is large enough and has no label all the same.
fn is_dropped(trace: &Trace, out: &Detection) -> bool {
    trace.is_large && out.labels[trace.at[1] * out.width + trace.at[0]] == 0
}

/// Changes worth trying, a list for each parameter.
fn changes(trace: &Trace, verdict: &Verdict, run: &Runner) -> Vec<Vec<Change>> {
    let inlier_threshold = run.params.inlier_threshold;
    let nothing = Vec::new;
    match *verdict {
        Verdict::Small { pixels, .. } => vec![lower_min_pixels(pixels).collect()],
        Verdict::Off { off, most, .. } => {
            let times = off / most;
            vec![inlier_thresholds(times * inlier_threshold), noises(trace, run, times)]
        }
        Verdict::Uneven { .. } | Verdict::Alone | Verdict::Sparse { .. } => {
            vec![
                lower_min_pixels(run.params.min_pixels as usize / 2).take(3).collect(),
                inlier_thresholds(inlier_threshold),
                noises(trace, run, 1.2),
            ]
        }
        Verdict::Dropped { parameter, value, .. } => {
            let smaller = [0.99 * value, 0.0].map(|value| vec![(parameter, rounded_down(value))]);
            vec![smaller.to_vec()]
        }
        // Sensors bend walls a little; a ball is bent by much more.
        Verdict::Curved => {
            trace.bow.filter(|bow| *bow < SLIGHT).map(|bow| noises(trace, run, bow)).into_iter().collect()
        }
        _ => nothing(),
    }
}

fn inlier_thresholds(least: f64) -> Vec<Change> {
    let values = FACTORS.map(|factor| rounded_up(1.01 * factor * least));
    values
        .into_iter()
        .filter(|&value| value <= MOST_INLIER_THRESHOLD)
        .map(|value| vec![("inlier-threshold", value)])
        .collect()
}

/// The noise in use so many times, as parameters.
fn noises(trace: &Trace, run: &Runner, least: f64) -> Vec<Change> {
    let Some(noise) = trace.noise else { return Vec::new() };
    // What `noise-scale` makes of it comes on top again.
    let here = noise.variance(trace.q).sqrt() / run.params.noise_scale;
    let most = FACTORS[FACTORS.len() - 1];
    let factors = FACTORS.into_iter().map(|factor| 1.01 * factor * least).filter(|&factor| factor <= most);
    let scaled = |factor: f64| match Space::of(trace.sensor.value_kind) {
        Space::Value => vec![("noise", rounded_up(factor * here))],
        Space::InverseDepth { .. } => {
            let (z, sigma_m) = (trace.q.recip(), here / (trace.q * trace.q));
            let own = noise.depth_sigma_m(z).unwrap_or(0.0);
            // At no range, as good as; a part that is nothing beside the other is what is left by rounding.
            let part = |of: f64| if of > 1e-3 * own { of } else { 0.0 };
            let base = part(noise.depth_sigma_m(1e-6).unwrap_or(0.0));
            let growth = part(own - base) / (z * z);
            // What rounding adds counts as well, since the noise as stated may be nothing.
            let times = factor * sigma_m / own;
            let (base, growth) = if own > 0.0 && own > 0.3 * sigma_m {
                (rounded_up(times * base), rounded_up(times * growth))
            } else {
                (rounded_up(factor * sigma_m), 0.0)
            };
            // A part that is nothing is 0 unless it was stated.
            let parts = [("noise", base, run.params.noise), ("noise-growth", growth, run.params.noise_growth)];
            let needed = parts.into_iter().filter(|(_, value, stated)| *value > 0.0 || *stated > 0.0);
            needed.map(|(name, value, _)| (name, value)).collect()
        }
    };
    factors.map(scaled).collect()
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Made, SENSOR, SIGMA, Stages, noise};
    use super::super::trace::Against;
    use super::*;
    use crate::camera::ValueKind;
    use crate::noise::SensorNoise;
    use crate::sensor::Sensor;

    /// A run that found nothing in a map of 16 x 16.
    fn run() -> Stages {
        let mut stages = Stages::tiles(&Made::noisy([16, 16], 3, |_, _| 40.0), noise(0.0));
        stages.divide(|_, _| 0);
        let run = &mut stages.run;
        run.image = vec![0; run.affine.q.len()];
        run.contacts.join([].into_iter(), &mut run.regions.all, &mut run.image, 1);
        stages
    }

    fn out() -> Detection {
        Detection { width: 16, height: 16, labels: vec![0; 256], ..Detection::default() }
    }

    /// What was seen of a measured pixel in a full and flat tile.
    fn trace() -> Trace {
        Trace { q: 40.0, tile: [16.0, 0.5], most: 4.0, ..Trace::new([3, 5], SENSOR) }
    }

    fn against(off: f64, is_curved: bool) -> Vec<Against> {
        vec![Against { id: 0, off, is_curved, pixels: 500.0 }]
    }

    #[test]
    fn the_verdict_is_the_first_reason_that_the_stages_had() {
        let stages = run();
        let run = &stages.run;
        let min_pixels = run.params.min_pixels;
        let fated = |fate: Fate| verdict(&Trace { fate, ..trace() }, run, &out());
        assert_eq!(verdict(&Trace { q: f64::NAN, fate: Fate::Curved, ..trace() }, run, &out()), Verdict::NotMeasured);
        assert_eq!(fated(Fate::Small(30.0)), Verdict::Small { pixels: 30, min_pixels, early: true });
        assert_eq!((fated(Fate::Curved), fated(Fate::EdgeOn)), (Verdict::Curved, Verdict::EdgeOn));
        assert_eq!(fated(Fate::None), Verdict::Alone);
        let seen = |tile: [f64; 2], against: Vec<Against>| verdict(&Trace { tile, against, ..trace() }, run, &out());
        assert_eq!(seen([7.0, 0.5], vec![]), Verdict::Sparse { pixels: 7, least: 8 });
        assert_eq!(seen([8.0, 0.5], vec![]), Verdict::Alone);
        assert_eq!(seen([16.0, 3.0], vec![]), Verdict::Uneven { roughness: 3.0 });
        assert_eq!(seen([16.0, 3.0], against(5.0, false)), Verdict::Off { off: 5.0, most: 4.0, label: 0 });
        assert_eq!(seen([16.0, 3.0], against(50.0, false)), Verdict::Uneven { roughness: 3.0 });
        // What went to a curved region is said to be curved, however near a plane is and whatever became of its tile.
        for fate in [Fate::None, Fate::Kept, Fate::Redundant] {
            let seen = Trace { fate, is_on_curved: true, against: against(0.3, false), ..trace() };
            assert_eq!(verdict(&seen, run, &out()), Verdict::Curved);
        }
        assert_eq!(seen([16.0, 3.0], against(5.0, true)), Verdict::Uneven { roughness: 3.0 });
        let piece = Trace { assigned: 1, piece: 12, ..trace() };
        assert_eq!(verdict(&piece, run, &out()), Verdict::Small { pixels: 12, min_pixels, early: false });
        // A pixel that has a plane has it whatever else was seen.
        let mut found = out();
        found.labels[5 * 16 + 3] = 1;
        let place = crate::detection::PixelBox { u_min: 0, v_min: 0, u_max: 15, v_max: 15 };
        found.planes = vec![crate::detection::Plane::new(1, 222, place)];
        let seen = Trace { fate: Fate::Curved, assigned: 1, against: against(1.5, false), ..trace() };
        assert_eq!(verdict(&seen, run, &found), Verdict::Plane { label: 1, pixels: 222, off: Some(1.5) });
    }

    #[test]
    fn a_larger_inlier_threshold_is_suggested_that_reaches_the_pixel_and_none_beyond_the_most() {
        let thresholds = |least: f64| inlier_thresholds(least).into_iter().flatten().collect::<Vec<_>>();
        let found = thresholds(5.0);
        assert!(
            found.len() > 2
                && found.iter().all(|(name, value)| *name == "inlier-threshold" && (5.0..=12.0).contains(value))
        );
        assert!(found.windows(2).all(|pair| pair[0].1 < pair[1].1), "the smallest change first: {found:?}");
        assert_eq!(thresholds(12.5), []);
    }

    #[test]
    fn the_noise_that_is_suggested_is_so_many_times_the_one_in_use_at_the_pixel() {
        let stages = run();
        let value = |changes: &[Change], name: &str| -> Vec<f64> {
            changes.iter().flatten().filter(|(own, _)| *own == name).map(|(_, value)| *value).collect()
        };
        // Disparity: a deviation in map units.
        let seen = Trace { noise: Some(stages.noise), ..trace() };
        for least in [1.0, 1.7, 2.5] {
            let noises = value(&noises(&seen, &stages.run, least), "noise");
            assert!((noises[0] / (1.01 * least * SIGMA) - 1.0).abs() < 0.1, "{noises:?}");
            assert!(
                noises.windows(2).all(|pair| pair[0] < pair[1]) && noises.iter().all(|noise| *noise <= 4.1 * SIGMA)
            );
        }
        assert_eq!(noises(&Trace { noise: None, ..trace() }, &stages.run, 1.0), [] as [Change; 0]);
        // Depth: at 2 m the base and the growth together are so many times what they were.
        let value_kind = ValueKind::Depth { metres: 0.001 };
        let model = NoiseModel::new(value_kind, SensorNoise::Depth { base: 0.002, growth: 0.0015 }, 0.0).unwrap();
        let seen = Trace { q: 0.5, noise: Some(model), sensor: Sensor { value_kind, ..SENSOR }, ..trace() };
        let changes = noises(&seen, &stages.run, 2.0);
        let [base, growth] = ["noise", "noise-growth"].map(|name| value(&changes, name)[0]);
        let (before, after) = (0.002 + 0.0015 * 4.0, base + growth * 4.0);
        assert!((after / (2.02 * before) - 1.0).abs() < 0.05, "{after} m, before it was {before}");
        assert!((base / growth / (0.002 / 0.0015) - 1.0).abs() < 0.1, "the two grow alike: {base}, {growth}");
    }

    #[test]
    fn what_is_tried_suits_the_verdict() {
        let stages = run();
        let seen = Trace { noise: Some(stages.noise), ..trace() };
        let names = |verdict: Verdict| {
            let changes = changes(&seen, &verdict, &stages.run);
            changes.iter().map(|changes| changes[0][0].0).collect::<Vec<_>>()
        };
        assert_eq!(names(Verdict::Small { pixels: 50, min_pixels: 100, early: false }), ["min-pixels"]);
        assert_eq!(names(Verdict::Off { off: 6.0, most: 4.0, label: 1 }), ["inlier-threshold", "noise"]);
        assert_eq!(names(Verdict::Uneven { roughness: 2.0 }), ["min-pixels", "inlier-threshold", "noise"]);
        let dropped = Verdict::Dropped { parameter: "min-area", value: 0.5, limit: Limit::AtLeast(1.0) };
        assert_eq!(changes(&seen, &dropped, &stages.run), [[vec![("min-area", 0.49)], vec![("min-area", 0.0)]]]);
        assert_eq!(names(Verdict::NotMeasured), [""; 0]);
        // A slight bow may be the sensor's, a strong one is not.
        assert_eq!(names(Verdict::Curved), [""; 0]);
        for (bow, expected) in [(1.4, 1), (1.6, 0)] {
            let seen = Trace { bow: Some(bow), noise: Some(stages.noise), ..trace() };
            assert_eq!(changes(&seen, &Verdict::Curved, &stages.run).len(), expected);
        }
    }
}
