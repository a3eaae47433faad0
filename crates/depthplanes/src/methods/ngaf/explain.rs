//! Why a pixel has a plane or none.
//!
//! In: one run of the method, observed when its groups are selected and described, before our own conditions drop
//! any. Out: an [`Explanation`].

use super::parameters::Ngaf;
use super::pipeline::{Observer, Runner};
use crate::components::selection::Selection;
use crate::components::{Connectivity, Groups};
use crate::detection::Detection;
use crate::error::Result;
use crate::explanation::{Explanation, Finding, Limit, Verdict};
use crate::map::with_view;
use crate::map::{AnyView, DepthView, Pixel};
use crate::methods::method::{Job, MethodInfo};
use crate::methods::tries::{Change, Tries, lower_min_pixels, rounded_up};
use crate::statistics::PlaneSums;

pub(super) fn explain(
    runner: &mut Runner,
    info: &'static MethodInfo,
    map: AnyView<'_>,
    job: &mut Job<'_>,
    at: [usize; 2],
) -> Result<Explanation> {
    let (mut out, params) = (Detection::default(), runner.params);
    let mut trace =
        Trace { at, params, before: None, findings: Vec::new(), nearest: None, pixels: 0, place: None, dropped: None };
    with_view!(map, map => {
        trace.look_at_pixel(&map);
        runner.ngaf(map, job, &mut out, &mut trace)
    })?;
    let verdict = trace.verdict(&out);
    let values = params.values();
    let tries = Tries { info, values: &values, map, sensor: job.sensor, at, planes: out.planes.len() };
    let suggestions = trace.changes(&verdict).into_iter().filter_map(|changes| tries.first(changes)).collect();
    Ok(Explanation { at, method: info.name, findings: trace.findings, verdict, suggestions })
}

/// What was seen of one pixel.
struct Trace {
    at: [usize; 2],
    params: Ngaf,
    /// The map's value, if valid.
    before: Option<f64>,
    findings: Vec<Finding>,
    /// Smallest difference from a neighbour that is not linked, map units.
    nearest: Option<f64>,
    /// Pixels of its group; 0 if it is not valid.
    pixels: usize,
    /// Its group's place among those kept, from 0.
    place: Option<usize>,
    /// The first of our own conditions that drops its group.
    dropped: Option<Verdict>,
}

impl Observer for Trace {
    fn selected<T: Pixel>(&mut self, map: &DepthView<'_, T>, groups: &Groups, selection: &Selection) {
        let [u, v] = self.at;
        let value = valid(map, u, v);
        if self.params.window > 0 {
            let outcome = match (self.before, value) {
                (Some(_), _) => "kept",
                (None, Some(_)) => "filled",
                (None, None) => "not filled",
            };
            let finding = Finding::new("enhance", "the pixel", outcome);
            self.findings.push(match value {
                Some(value) => finding.with("value", value.into(), "map units"),
                None => finding,
            });
        }
        let Some(value) = value else { return };
        self.look_at_neighbours(map, value);
        self.look_at_group(groups, selection);
    }

    fn described(&mut self, tallies: &[PlaneSums]) {
        if let Some(place) = self.place {
            self.look_at_conditions(&tallies[place]);
        }
    }
}

fn valid<T: Pixel>(map: &DepthView<'_, T>, u: usize, v: usize) -> Option<T> {
    let value = map.row(v)[u];
    map.validity().holds(value).then_some(value)
}

impl Trace {
    fn look_at_pixel<T: Pixel>(&mut self, map: &DepthView<'_, T>) {
        let [u, v] = self.at;
        self.before = valid(map, u, v).map(Into::into);
        let finding = Finding::new("map", "the pixel", if self.before.is_some() { "" } else { "not measured" });
        let finding = finding.with("value", map.row(v)[u].into(), "map units").refusing(self.before.is_none());
        self.findings.push(finding);
    }

    /// Section 3c: is it linked to its neighbours?
    fn look_at_neighbours<T: Pixel>(&mut self, map: &DepthView<'_, T>, value: T) {
        let [u, v] = self.at;
        let (width, height) = (map.width(), map.height());
        let neighbours = [
            ("the neighbour to the left", u > 0, u.wrapping_sub(1), v),
            ("the neighbour to the right", u + 1 < width, u + 1, v),
            ("the neighbour above", v > 0, u, v.wrapping_sub(1)),
            ("the neighbour below", v + 1 < height, u, v + 1),
        ];
        for (name, _, u, v) in neighbours.into_iter().filter(|(_, is_inside, ..)| *is_inside) {
            let Some(other) = valid(map, u, v) else {
                self.findings.push(Finding::new("group", name, "not measured, no link"));
                continue;
            };
            let difference = (value.into() - other.into()).abs();
            // As the method itself decides, with theta as the map's own type.
            let is_linked =
                Connectivity::new(map.validity(), self.params.theta).is_ok_and(|rule| rule.close(value, other));
            if !is_linked && self.nearest.is_none_or(|nearest| difference < nearest) {
                self.nearest = Some(difference);
            }
            let finding = Finding::new("group", name, if is_linked { "linked" } else { "no link" });
            self.findings
                .push(finding.with("difference", difference, "map units").limit(Limit::AtMost(self.params.theta)));
        }
    }

    /// Section 3d, and our own conditions.
    fn look_at_group(&mut self, groups: &Groups, selection: &Selection) {
        let [u, v] = self.at.map(|place| place as u32);
        self.pixels = 1; // groups of one may have been left out
        let mut own = None;
        groups.each_run(|run| {
            if run.v == v && (run.u_first..=run.u_last).contains(&u) {
                own = Some(run.group);
                self.pixels = groups.sizes()[run.group as usize] as usize;
            }
        });
        let is_large = self.pixels > self.params.min_pixels as usize;
        let finding = Finding::new("select", "its group", if is_large { "large enough" } else { "too small" });
        let limit = Limit::MoreThan(self.params.min_pixels.into());
        self.findings.push(finding.with("pixels", self.pixels as f64, "").limit(limit).refusing(!is_large));
        self.place = selection.kept().iter().position(|kept| Some(kept.group) == own);
    }

    fn look_at_conditions(&mut self, tally: &PlaneSums) {
        let Ngaf { max_rms, min_fill, margin, min_pixels, .. } = self.params;
        let rms = tally.fit.map_or(f64::INFINITY, |fit| fit.rms);
        let fill = tally.pixel_count as f64 / tally.bounding_box.area() as f64;
        let conditions = [
            ("max-rms", max_rms > 0.0, "rms about its plane", rms, "map units", Limit::AtMost(max_rms)),
            ("min-fill", min_fill > 0.0, "share of its box", fill, "", Limit::AtLeast(min_fill)),
            (
                "margin",
                margin > 0,
                "pixels off the map's edge",
                tally.inner_pixels as f64,
                "",
                Limit::MoreThan(min_pixels.into()),
            ),
        ];
        for (parameter, is_used, name, value, unit, limit) in conditions {
            if is_used {
                let holds = limit.holds(value);
                let finding = Finding::new("fit", "its group", if holds { "kept" } else { "dropped" });
                self.findings.push(finding.with(name, value, unit).limit(limit).refusing(!holds));
                if !holds && self.dropped.is_none() {
                    self.dropped = Some(Verdict::Dropped { parameter, value, limit });
                }
            }
        }
    }

    fn verdict(&self, out: &Detection) -> Verdict {
        let label = out.labels[self.at[1] * out.width + self.at[0]];
        match (label, self.pixels) {
            (0, 0) => Verdict::NotMeasured,
            (0, pixels) => {
                let small = Verdict::Small { pixels, min_pixels: self.params.min_pixels, early: false };
                self.dropped.clone().unwrap_or(small)
            }
            _ => Verdict::Plane { label, pixels: out.planes[usize::from(label) - 1].pixel_count, off: None },
        }
    }

    /// Changes worth trying, a list for each parameter.
    fn changes(&self, verdict: &Verdict) -> Vec<Vec<Change>> {
        match *verdict {
            Verdict::NotMeasured => vec![[3.0, 5.0, 9.0, 15.0].map(|window| vec![("window", window)]).to_vec()],
            Verdict::Small { pixels, .. } => vec![lower_min_pixels(pixels).collect(), self.thetas()],
            Verdict::Dropped { parameter: "max-rms", value, .. } if value.is_finite() => {
                vec![vec![vec![("max-rms", rounded_up(value))]]]
            }
            Verdict::Dropped { parameter, .. } => vec![vec![vec![(parameter, 0.0)]]],
            _ => Vec::new(),
        }
    }

    /// Values of theta from the least that links the pixel to one more neighbour up to four times that, which link
    /// more of what is around it.
    fn thetas(&self) -> Vec<Change> {
        let least = self.nearest.unwrap_or(self.params.theta).max(self.params.theta);
        [1.0, 1.5, 2.0, 3.0, 4.0].map(|factor| vec![("theta", rounded_up(factor * least))]).to_vec()
    }
}
