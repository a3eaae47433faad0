//! What the paper claims of its method, and what is measured here.

use super::super::report::table::Table;
use super::super::report::{Section, by, mean, share};
use super::super::rows::{Found, Row};
use super::figures::of_map;
use super::trial::{COMPARED, NGAF, Results, label};

/// A number that the paper gives for `ngaf` against another method.
struct Claim {
    says: &'static str,
    /// The method that stands for the paper's comparator.
    other: &'static str,
    /// The number, for a measure of `ngaf` and of the other.
    number: fn(f64, f64) -> f64,
    measure: fn(&Row, &Found) -> f64,
    /// The paper's.
    least: f64,
    written: fn(f64) -> String,
}

const fn faster(says: &'static str, other: &'static str, least: f64) -> Claim {
    let measure = |_: &Row, found: &Found| found.median_ms;
    Claim {
        says,
        other,
        number: |own, other| other / own,
        measure,
        least,
        written: |times| format!("{times:.1} times"),
    }
}

const fn more_planes(says: &'static str, other: &'static str, least: f64) -> Claim {
    let number = |own, other| 100.0 * (own / other - 1.0);
    let measure = |_: &Row, found: &Found| found.planes as f64;
    Claim { says, other, number, measure, least, written: |percent| format!("{percent:+.1} %") }
}

const fn more_points(says: &'static str, other: &'static str, least: f64) -> Claim {
    let measure = |row: &Row, found: &Found| 100.0 * share(row, found);
    Claim {
        says,
        other,
        number: |own, other| own - other,
        measure,
        least,
        written: |points| format!("{points:+.1} points"),
    }
}

const CLAIMS: [Claim; 5] = [
    faster("33 times as fast as HSBSR (here ransac, its detector)", "ransac", 33.0),
    more_planes("about 8 % more planes than PPDFDM (our reconstruction)", "ppdfdm", 8.0),
    more_planes("about 8 % more planes than FPDIDM (our reconstruction)", "fpdidm", 8.0),
    more_points("at least 2 % more valid points than PPDFDM", "ppdfdm", 2.0),
    more_points("at least 2 % more valid points than FPDIDM", "fpdidm", 2.0),
];

/// The `min` at which the paper's `ngaf` has as many planes as FPDIDM.
const SAME_AS_FPDIDM: [(&str, u32); 5] =
    [("Sawtooth", 256), ("Venus", 256), ("Cones", 64), ("Teddy", 64), ("Books", 128)];

pub(super) fn section(middlebury: &Results<'_>, kinect: &Results<'_>) -> Section {
    let counts = counts(middlebury);
    Section {
        title: "What the paper claims".into(),
        text: format!(
            "The paper's numbers are of one map, Toulouse St-Michel, and of programs that are not at hand, nor is the map. \
             Here they are of means over the maps with min {COMPARED}; valid points are compared in points of their share. \
             It also says that FPDIDM has as many planes as ngaf with the min named below: {}.",
            summed_up(&counts)
        ),
        tables: vec![numbers(&[middlebury, kinect]), counts],
        ..Section::default()
    }
}

/// A line for each claim and set.
fn numbers(all: &[&Results<'_>]) -> Table {
    let line = |claim: &Claim, results: &Results<'_>| {
        let of = |method: &str| {
            let found = by(&results.rows, &label(method, COMPARED));
            mean(found.into_iter().map(|(row, found)| Some((claim.measure)(row, found))))
        };
        let here = of(NGAF).zip(of(claim.other)).map(|(own, other)| (claim.number)(own, other));
        let written = here.map_or(format!("{} was not run", claim.other), claim.written);
        let holds = here.map_or("-", |here| if here >= claim.least { "yes" } else { "no" });
        vec![claim.says.to_string(), results.trial.name.to_string(), written, holds.to_string()]
    };
    Table {
        title: "Claims".into(),
        head: ["the paper says of its method", "measured on", "here", "at least that"].map(str::to_string).to_vec(),
        rows: CLAIMS.iter().flat_map(|claim| all.iter().map(move |results| line(claim, results))).collect(),
    }
}

/// A line for each map: planes of `ngaf` and of `fpdidm`.
fn counts(middlebury: &Results<'_>) -> Table {
    let line = |(name, min): (&str, u32)| {
        let item = middlebury.trial.items.iter().find(|item| item.name.starts_with(name))?;
        let planes = |method| of_map(&middlebury.rows, &item.name, &label(method, min)).map(|(_, found)| found.planes);
        let (ngaf, fpdidm) = (planes(NGAF), planes("fpdidm"));
        let written = |planes: Option<usize>| planes.map_or("-".to_string(), |planes| planes.to_string());
        let same = ngaf.zip(fpdidm).map_or("-", |(a, b)| if a == b { "yes" } else { "no" });
        Some(vec![item.name.clone(), min.to_string(), written(ngaf), written(fpdidm), same.to_string()])
    };
    Table {
        title: "Planes of ngaf and fpdidm, both with that min".into(),
        head: ["map", "min", "ngaf", "fpdidm", "as many"].map(str::to_string).to_vec(),
        rows: SAME_AS_FPDIDM.into_iter().filter_map(line).collect(),
    }
}

fn summed_up(counts: &Table) -> String {
    let with = |word: &str| counts.rows.iter().filter(|row| row.last().is_some_and(|cell| cell == word)).count();
    match (with("yes"), with("no")) {
        (0, 0) => "fpdidm was not run".into(),
        (yes, no) => format!("so it is here on {yes} of {} maps", yes + no),
    }
}
