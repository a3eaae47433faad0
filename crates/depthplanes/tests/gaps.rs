//! Maps that were measured at some of their pixels, in patterns, and `planar`.

mod room;

use depthplanes::DepthView;
use room::{FOCAL, SIZE, chance, check, detect, detector, room};

#[test]
fn rows_and_columns_that_are_missing_leave_the_planes_of_the_room() {
    for (some, of) in [(1, 2), (1, 3), (1, 4), (1, 6), (1, 8), (2, 3), (2, 4), (2, 8), (3, 4), (4, 8)] {
        for first in [0, 1] {
            check(
                &format!("{some} of {of} rows"),
                &detect(&mut detector(), &room(|_, v| (v + first) % of < some)),
                0.95,
            );
            check(
                &format!("{some} of {of} columns"),
                &detect(&mut detector(), &room(|u, _| (u + first) % of < some)),
                0.95,
            );
        }
    }
}

#[test]
fn lattices_and_chequers_leave_the_planes_of_the_room() {
    for step in [2, 3, 4, 5] {
        let pixels = room(|u, v| u % step == step / 2 && v % step == step / 2);
        check(&format!("every {step}. pixel"), &detect(&mut detector(), &pixels), 0.95);
        let pixels = room(|u, v| (u + v).is_multiple_of(step));
        check(&format!("diagonals of {step}"), &detect(&mut detector(), &pixels), 0.95);
    }
    for side in [1, 2, 3, 4, 5, 8] {
        let pixels = room(|u, v| (u / side + v / side).is_multiple_of(2));
        check(&format!("squares of {side}"), &detect(&mut detector(), &pixels), 0.95);
    }
}

#[test]
fn pixels_at_random_leave_the_planes_of_the_room() {
    for percent in [75, 65, 50, 35, 25, 20, 15, 10] {
        for of in [20, 21, 22] {
            let pixels = room(|u, v| chance(u, v, of) < f64::from(percent) / 100.0);
            check(&format!("{percent} % at random"), &detect(&mut detector(), &pixels), 0.93);
        }
    }
}

#[test]
fn grids_of_lines_that_are_missing_leave_the_planes_of_the_room() {
    for (line, of) in [(1, 8), (1, 16), (2, 12), (2, 16), (3, 16), (3, 32), (4, 16), (5, 24)] {
        let pixels = room(|u, v| (u + 3) % of >= line && (v + 5) % of >= line);
        check(&format!("lines of {line} each {of}"), &detect(&mut detector(), &pixels), 0.95);
    }
}

#[test]
fn a_sparse_map_gives_the_same_on_any_number_of_threads_and_to_a_detector_that_saw_others() {
    let sparse = room(|u, v| u % 3 == 1 && chance(u, v, 9) < 0.7);
    let expected = detect(&mut detector(), &sparse);
    for threads in [2, 3] {
        let mut detector = detector().threads(threads);
        detect(&mut detector, &room(|_, _| true));
        detect(&mut detector, &room(|_, v| v.is_multiple_of(4)));
        let found = detect(&mut detector, &sparse);
        assert_eq!((&found.labels, &found.planes), (&expected.labels, &expected.planes));
    }
}

#[test]
fn a_pixel_of_a_sparse_map_is_explained_by_its_bin_and_a_missing_one_as_missing() {
    let pixels = room(|u, v| u.is_multiple_of(2) && v % 3 == 1);
    let view = DepthView::new(&pixels, SIZE[0], SIZE[1]).unwrap();
    let mut detector = detector();
    let found = detect(&mut detector, &pixels);
    for at in [[40, 100], [200, 40], [200, 220]] {
        let why = detector.explain(view, at).unwrap();
        let label = found.labels[at[1] * SIZE[0] + at[0]];
        match why.verdict {
            depthplanes::explanation::Verdict::Plane { label: said, pixels, .. } => {
                assert_eq!((said, pixels), (label, found.planes[usize::from(label) - 1].pixel_count), "{at:?}");
            }
            other => panic!("{at:?}: {other:?}"),
        }
        assert!(why.findings[0].outcome.contains("few of its pixels"), "{:?}", why.findings[0]);
    }
    assert_eq!(detector.explain(view, [41, 100]).unwrap().verdict.kind(), "not_measured");
}

#[test]
fn bends_of_a_sparse_map_are_curved_and_no_pixel_is_both() {
    // A column 0.5 m thick before a wall.
    let depth = |u: usize, v: usize| {
        let x = (u as f64 - 159.5) / FOCAL;
        let (a, b, c) = (x * x + 1.0, -2.0 * 1.5, 1.5 * 1.5 - 0.25);
        let root = b * b - 4.0 * a * c;
        if root > 0.0 { (-b - root.sqrt()) / (2.0 * a) } else { 2.0 + 0.002 * v as f64 }
    };
    let is_measured = |u: usize, v: usize| u % 2 == 1 && v.is_multiple_of(2);
    let pixels: Vec<u16> = (0..SIZE[0] * SIZE[1])
        .map(|at| [at % SIZE[0], at / SIZE[0]])
        .map(
            |[u, v]| {
                if is_measured(u, v) { (1e3 * depth(u, v) + 6.0 * chance(u, v, 1) - 3.0).round() as u16 } else { 0 }
            },
        )
        .collect();
    let found = detect(&mut detector().curved(true), &pixels);
    let curved = found.curved.as_ref().unwrap();
    assert!(!curved.regions.is_empty());
    for (at, (&plane, &bend)) in found.labels.iter().zip(&curved.labels).enumerate() {
        let [u, v] = [at % SIZE[0], at / SIZE[0]];
        assert!(plane == 0 || bend == 0);
        assert!(is_measured(u, v) || plane + bend == 0, "what was not measured has a label");
    }
}
