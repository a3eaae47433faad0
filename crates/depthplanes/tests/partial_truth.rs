//! Measures for recorded frames: surfaces of a partial truth, and planes from frame to frame.

use depthplanes::Error;
use depthplanes::metrics::{Contingency, Fate, NOT_PLANAR, Partial, STEADY_PIXELS, Sequence, next_frame, partial};
use proptest::collection::vec;
use proptest::prelude::*;

/// A table from (truth label, predicted label, pixels).
fn table(counts: &[(u16, u16, usize)]) -> Contingency {
    Contingency::of_pairs(counts.iter().flat_map(|&(truth, prediction, n)| std::iter::repeat_n((truth, prediction), n)))
}

fn fates(found: &Partial) -> Vec<(u16, Fate, usize)> {
    found.surfaces.iter().map(|one| (one.region.label, one.fate, one.pieces)).collect()
}

#[test]
fn a_small_map_has_a_surface_of_each_class() {
    #[rustfmt::skip]
    let truth = [
        1, 1, 1, 1, 1, 2, 2, 2, 2, 2,
        3, 3, 3, 3, 3, 4, 4, 4, 4, 4,
        5, 5, 5, 5, 5, 0, 0, 0, 0, 0,
    ];
    #[rustfmt::skip]
    let prediction = [
        1, 1, 1, 1, 0, 2, 2, 2, 2, 2,
        3, 3, 4, 4, 0, 5, 5, 0, 0, 0,
        2, 2, 2, 2, 0, 1, 1, 1, 1, 1,
    ];
    let found = partial(&Contingency::new(&truth, &prediction).unwrap(), &[]);
    let expected = [
        (1, Fate::Correct, 1), // four of five pixels; what plane 1 has where nobody labelled costs nothing
        (2, Fate::Merged, 1),  // plane 2 covers it all, but four of its nine pixels lie on surface 5
        (3, Fate::Split, 2),
        (4, Fate::Missed, 1),
        (5, Fate::Merged, 1),
    ];
    assert_eq!(fates(&found), expected);
    let counts = found.of_at_least(1);
    assert_eq!((counts.surfaces, counts.correct, counts.merged, counts.split, counts.missed), (5, 1, 2, 1, 1));
    assert_eq!((counts.pixels, counts.correct_pixels, counts.pieces), (25, 5, 6));
    assert_eq!((counts.correct_share(), counts.correct_pixel_share()), (Some(0.2), Some(0.2)));
    assert_eq!((counts.mean_pieces(), found.not_planar_share()), (Some(1.2), None));
    assert_eq!(found.of_at_least(6).correct_share(), None);
}

#[test]
fn shares_that_are_just_reached_do() {
    let of = |counts: &[(u16, u16, usize)]| partial(&table(counts), &[]).surfaces[0].fate;
    assert_eq!(of(&[(1, 1, 80), (1, 0, 20), (2, 1, 20)]), Fate::Correct);
    assert_eq!(of(&[(1, 1, 80), (1, 0, 20), (2, 1, 21)]), Fate::Merged);
    assert_eq!(of(&[(1, 1, 79), (1, 0, 21)]), Fate::Missed);
    assert_eq!(of(&[(1, 1, 79), (1, 2, 1), (1, 0, 20)]), Fate::Split);
    // Half of a plane makes it a piece, less does not.
    assert_eq!(of(&[(1, 1, 50), (1, 2, 50), (2, 2, 50)]), Fate::Split);
    assert_eq!(of(&[(1, 1, 50), (1, 2, 50), (2, 2, 51)]), Fate::Missed);
    let pieces = partial(&table(&[(1, 1, 91), (1, 2, 5), (1, 3, 4)]), &[]).surfaces[0].pieces;
    assert_eq!(pieces, 2);
}

#[test]
fn coplanar_surfaces_may_share_a_plane_and_need_not() {
    let shared = table(&[(1, 7, 60), (2, 7, 40), (3, 8, 50)]);
    assert_eq!(partial(&shared, &[]).of_at_least(1).merged, 2); // 60 and 40 % of plane 7
    assert_eq!(fates(&partial(&shared, &[]))[0].1, Fate::Merged);
    let stated = partial(&shared, &[vec![1, 2], vec![9, 10]]);
    assert_eq!(stated.of_at_least(1).correct, 3);
    let apart = table(&[(1, 7, 60), (2, 6, 40)]);
    assert_eq!(partial(&apart, &[vec![1, 2]]).of_at_least(1).correct, 2);
    // Coplanar surfaces are no excuse for a third one, and a label that is stated twice counts once.
    let third = table(&[(1, 7, 60), (2, 7, 10), (3, 7, 30)]);
    assert_eq!(fates(&partial(&third, &[vec![1, 2], vec![2, 1, 1]]))[0].1, Fate::Merged);
}

#[test]
fn pixels_that_are_not_planar_are_labelled_and_no_surface() {
    let found = partial(&table(&[(1, 1, 60), (NOT_PLANAR, 1, 40), (NOT_PLANAR, 0, 60), (0, 1, 500)]), &[]);
    assert_eq!(fates(&found), [(1, Fate::Merged, 1)]);
    assert_eq!((found.not_planar, found.not_planar_covered, found.not_planar_share()), (100, 40, Some(0.4)));
    // Nobody can state that they are on a plane.
    let stated = partial(&table(&[(1, 1, 60), (NOT_PLANAR, 1, 40)]), &[vec![1, NOT_PLANAR]]);
    assert_eq!(fates(&stated)[0].1, Fate::Merged);
    assert_eq!(partial(&table(&[]), &[]).of_at_least(1).surfaces, 0);
}

#[test]
fn frames_are_added_up_surface_by_surface() {
    let one = partial(&table(&[(1, 1, 10_000)]), &[]);
    let other = partial(&table(&[(1, 0, 3000), (2, 0, 2999), (3, 1, 9999)]), &[]);
    let mut all = one.of_at_least(3000);
    all += other.of_at_least(3000);
    assert_eq!((all.surfaces, all.correct, all.missed, all.pixels), (3, 2, 1, 22_999));
    assert_eq!(all.correct_share(), Some(2.0 / 3.0));
    assert_eq!(other.of_at_least(10_000).surfaces, 0);
}

#[test]
fn a_plane_is_held_against_the_best_of_the_next_frame() {
    // 6,000 pixels of which 4,500 stay; the small plane is not looked for but counts.
    let found = next_frame(&table(&[(1, 5, 4500), (1, 6, 1500), (2, 6, 4999), (0, 5, 500), (0, 0, 9)]));
    assert_eq!(found.best_iou, [(1, 4500.0 / 6500.0)]);
    assert_eq!(found.planes, [2, 2]);
    let lost = next_frame(&table(&[(3, 0, 5000)]));
    assert_eq!((lost.best_iou, lost.planes), (vec![(3, 0.0)], [1, 0]));
}

#[test]
fn a_sequence_is_the_mean_over_planes_and_a_gap_joins_nothing() {
    let frame = |runs: &[(u16, usize)]| -> Vec<u16> {
        runs.iter().flat_map(|&(label, pixels)| std::iter::repeat_n(label, pixels)).collect()
    };
    let mut sequence = Sequence::default();
    assert_eq!((sequence.mean_iou(), sequence.mean_planes(), sequence.change_of_planes()), (None, None, None));
    sequence.add(frame(&[(1, 8000), (2, 8000)])).unwrap();
    assert_eq!((sequence.mean_iou(), sequence.mean_planes()), (None, Some(2.0)));
    sequence.add(frame(&[(4, 8000), (5, 4000), (6, 4000)])).unwrap(); // whole; half
    sequence.add(frame(&[(4, 16_000)])).unwrap(); // plane 4 in half of it
    assert_eq!((sequence.pairs.len(), sequence.large_planes()), (2, 3));
    assert_eq!(sequence.mean_iou(), Some(2.0 / 3.0));
    assert_eq!(sequence.kept_share(), Some(1.0 / 3.0));
    assert_eq!(sequence.mean_planes(), Some(2.0));
    assert_eq!(sequence.change_of_planes(), Some(1.5)); // of +1 and -2
    sequence.skip();
    sequence.add(frame(&[(1, 16_000)])).unwrap();
    assert_eq!((sequence.pairs.len(), sequence.planes.len()), (2, 4));
    let other = sequence.add(vec![1; 7]);
    assert!(matches!(other, Err(Error::LabelCounts { truth: 16_000, prediction: 7 })), "{other:?}");
}

/// What no surface and no plane is, three surfaces, and what is not planar.
const LABELS: [u16; 5] = [0, 1, 2, 3, NOT_PLANAR];

/// Label images in runs, of which the prediction often follows the truth.
fn images() -> impl Strategy<Value = (Vec<u16>, Vec<u16>)> {
    vec((0usize..5, 0u16..5, 1usize..12, 0u16..3), 0..40).prop_map(|runs| {
        let mut images = (Vec::new(), Vec::new());
        for (truth, other, length, tie) in runs {
            let prediction = if tie > 0 { truth as u16 } else { other };
            images.0.extend(std::iter::repeat_n(LABELS[truth], length));
            images.1.extend(std::iter::repeat_n(prediction, length));
        }
        images
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn a_perfect_prediction_keeps_every_surface((truth, _) in images(), coplanar: bool) {
        let found: Vec<u16> = truth.iter().map(|&label| if label == NOT_PLANAR { 0 } else { label * 17 }).collect();
        let groups = if coplanar { vec![vec![1, 3]] } else { vec![] };
        let perfect = partial(&Contingency::new(&truth, &found).unwrap(), &groups);
        let all = perfect.of_at_least(1);
        prop_assert_eq!((all.correct, all.pieces, all.correct_pixels), (all.surfaces, all.surfaces, all.pixels));
        prop_assert_eq!(perfect.not_planar_covered, 0);
    }

    #[test]
    fn each_surface_is_in_exactly_one_class((truth, prediction) in images()) {
        let found = partial(&Contingency::new(&truth, &prediction).unwrap(), &[vec![1, 2]]);
        let all = found.of_at_least(1);
        prop_assert_eq!(all.correct + all.merged + all.split + all.missed, all.surfaces);
        let pixels = truth.iter().filter(|&&label| label != 0).count() as u64;
        prop_assert_eq!(all.pixels + found.not_planar, pixels);
        prop_assert!(found.not_planar_covered <= found.not_planar && all.correct_pixels <= all.pixels);
    }

    #[test]
    fn names_of_labels_change_nothing_of_surfaces((truth, prediction) in images()) {
        let new_truth = |&label: &u16| [0, 300, 41, 7][usize::from(label.min(3))];
        let renamed: Vec<u16> = truth.iter().map(|l| if *l == NOT_PLANAR { *l } else { new_truth(l) }).collect();
        let found: Vec<u16> = prediction.iter().map(|&label| if label > 0 { 900 - label } else { 0 }).collect();
        let before = partial(&Contingency::new(&truth, &prediction).unwrap(), &[vec![1, 2]]);
        let after = partial(&Contingency::new(&renamed, &found).unwrap(), &[vec![300, 41]]);
        prop_assert_eq!(before.of_at_least(1), after.of_at_least(1));
        prop_assert_eq!(before.not_planar_share(), after.not_planar_share());
    }

    #[test]
    fn a_frame_is_found_whole_in_itself_under_any_names((frame, _) in images()) {
        // Wide enough that a label is large where it occurs.
        let wide = |label: &u16| std::iter::repeat_n(*label, STEADY_PIXELS as usize);
        let frame: Vec<u16> = frame.iter().take(8).flat_map(wide).collect();
        let renamed: Vec<u16> = frame.iter().map(|&label| if label > 0 { label ^ 0x0550 } else { 0 }).collect();
        let found = next_frame(&Contingency::new(&frame, &renamed).unwrap());
        prop_assert!(found.best_iou.iter().all(|&(_, iou)| iou == 1.0));
        prop_assert_eq!(found.best_iou.len(), found.planes[0]);
        prop_assert_eq!(found.planes[0], found.planes[1]);
    }
}
