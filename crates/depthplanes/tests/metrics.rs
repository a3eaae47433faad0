//! The measures against truth: cases worked out by hand, and what holds for all label images.

use depthplanes::metrics::{
    Contingency, Match, Overlap, Region, Split, Tolerance, adjacent, angle_errors, evops, partition, plane_error,
    plane_errors, segcomp,
};
use depthplanes::scene::Spec;
use depthplanes::{Detector, Error, HessianNormalForm, Ngaf};
use proptest::collection::vec;
use proptest::prelude::*;

/// A table from (truth label, predicted label, pixels).
fn table(counts: &[(u16, u16, usize)]) -> Contingency {
    Contingency::of_pairs(counts.iter().flat_map(|&(truth, prediction, n)| std::iter::repeat_n((truth, prediction), n)))
}

fn matched(pairs: &[(u16, u16)]) -> Vec<Match> {
    pairs.iter().map(|&(truth, prediction)| Match { truth, prediction }).collect()
}

fn split(whole: u16, parts: &[u16]) -> Split {
    Split { whole, parts: parts.to_vec() }
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-12
}

#[test]
fn the_table_counts_each_pair_of_labels() {
    let truth = [0, 3, 3, 3, 9, 9, 0];
    let prediction = [0, 2, 2, 0, 2, 5, 0];
    let table = Contingency::new(&truth, &prediction).unwrap();
    let region = |label, pixels| Region { label, pixels };
    assert_eq!(table.truth(), [region(0, 2), region(3, 3), region(9, 2)]);
    assert_eq!(table.truth_planes(), [region(3, 3), region(9, 2)]);
    assert_eq!(table.predicted_planes(), [region(2, 3), region(5, 1)]);
    let cells: Vec<_> = table.overlaps().iter().map(|o| (o.truth.label, o.prediction.label, o.pixels)).collect();
    assert_eq!(cells, [(0, 0, 2), (3, 0, 1), (3, 2, 2), (9, 2, 1), (9, 5, 1)]);
    assert_eq!((table.pixels(), table.overlaps_of_planes().count()), (7, 3));
    let overlap: Overlap = table.overlaps()[2];
    assert!(close(overlap.share_of_truth(), 2.0 / 3.0) && close(overlap.share_of_prediction(), 2.0 / 3.0));
    assert!(close(overlap.iou(), 2.0 / 4.0) && close(overlap.dice(), 4.0 / 6.0));
}

#[test]
fn truth_labels_below_the_lowest_are_no_plane() {
    let all = table(&[(0, 1, 4), (2, 1, 3), (10, 1, 5), (11, 0, 2)]);
    assert_eq!(all.truth_from(10), table(&[(0, 1, 7), (10, 1, 5), (11, 0, 2)]));
    assert_eq!(all.truth_from(1), all);
    assert_eq!(all.on_truth_planes(), table(&[(2, 1, 3), (10, 1, 5), (11, 0, 2)]));
    assert_eq!(all.swapped(), table(&[(1, 0, 4), (1, 2, 3), (1, 10, 5), (0, 11, 2)]));
}

#[test]
fn noise_of_many_runs_is_counted_as_well() {
    let label = |i: usize, step: usize| (i * step % 251) as u16;
    let (truth, prediction): (Vec<u16>, Vec<u16>) = (0..300_000).map(|i| (label(i, 7), label(i, 11) % 13)).unzip();
    let table = Contingency::new(&truth, &prediction).unwrap();
    assert_eq!(table.pixels(), 300_000);
    let expected = truth.iter().zip(&prediction).filter(|pair| pair == &(&5, &6)).count() as u64;
    let found = table.overlaps().iter().find(|o| (o.truth.label, o.prediction.label) == (5, 6));
    assert_eq!(found.map_or(0, |o| o.pixels), expected);
}

#[test]
fn images_of_different_sizes_are_refused_with_both_numbers() {
    let error = Contingency::new(&[1, 2], &[1, 2, 3]).unwrap_err();
    assert_eq!(error, Error::LabelCounts { truth: 2, prediction: 3 });
    assert!(error.to_string().contains("2 labels") && error.to_string().contains('3'), "{error}");
}

#[test]
fn the_tolerance_is_from_051_to_095() {
    for share in [0.51, 0.8, 0.95] {
        assert_eq!(Tolerance::new(share).unwrap().share(), share);
    }
    for share in [0.5, 0.509, 0.951, 1.0, -1.0, f64::NAN, f64::INFINITY] {
        let message = Tolerance::new(share).unwrap_err().to_string();
        assert!(message.contains(&share.to_string()) && message.contains("0.51 to 0.95"), "{message}");
    }
}

#[test]
fn a_plane_is_correct_if_both_shares_exceed_the_tolerance() {
    // 9 of 10 and 9 of 10; then 8 of 10, which does not exceed 0.8.
    let found = segcomp(&table(&[(1, 4, 9), (1, 0, 1), (0, 4, 1)]), Tolerance::default());
    assert_eq!((found.correct, found.missed, found.noise), (matched(&[(1, 4)]), vec![], vec![]));
    let found = segcomp(&table(&[(1, 4, 8), (1, 0, 2)]), Tolerance::default());
    assert_eq!((found.correct, found.missed, found.noise), (matched(&[]), vec![1], vec![4]));
}

#[test]
fn a_plane_in_two_pieces_is_over_segmented() {
    // 45 + 45 of 100 pixels, each piece wholly inside.
    let found = segcomp(&table(&[(1, 4, 45), (1, 7, 45), (1, 0, 10)]), Tolerance::default());
    assert_eq!(found.over_segmented, [split(1, &[4, 7])]);
    assert_eq!((found.correct, found.missed, found.noise), (matched(&[]), vec![], vec![]));
    // Together only 80 of 100: not more than the tolerance.
    let found = segcomp(&table(&[(1, 4, 40), (1, 7, 40), (1, 0, 20)]), Tolerance::default());
    assert_eq!((found.over_segmented, found.missed, found.noise), (vec![], vec![1], vec![4, 7]));
    // The third piece lies mostly elsewhere and is no part.
    let found = segcomp(&table(&[(1, 4, 45), (1, 7, 45), (1, 8, 10), (0, 8, 10)]), Tolerance::default());
    assert_eq!((found.over_segmented, found.noise), (vec![split(1, &[4, 7])], vec![8]));
}

#[test]
fn a_plane_over_two_of_the_truth_is_under_segmented() {
    let found = segcomp(&table(&[(1, 4, 45), (2, 4, 45), (0, 4, 10)]), Tolerance::default());
    assert_eq!(found.under_segmented, [split(4, &[1, 2])]);
    assert_eq!((found.correct, found.missed, found.noise), (matched(&[]), vec![], vec![]));
    let found = segcomp(&table(&[(1, 4, 40), (2, 4, 40), (0, 4, 20)]), Tolerance::default());
    assert_eq!((found.under_segmented, found.missed, found.noise), (vec![], vec![1, 2], vec![4]));
}

#[test]
fn what_meets_nothing_is_missed_or_noise() {
    let found = segcomp(&table(&[(1, 0, 5), (0, 4, 5), (2, 5, 5)]), Tolerance::default());
    assert_eq!((found.correct, found.missed, found.noise), (matched(&[(2, 5)]), vec![1], vec![4]));
    assert_eq!((found.f, found.k), (Some(0.5), Some(0.5)));
}

#[test]
fn of_several_classes_the_one_with_the_largest_average_is_kept() {
    let default = Tolerance::default();
    // Correct (1, 4): (0.9 + 1) / 2 = 0.95. Over-segmented 1: ((1 + 1) / 2 + 1) / 2 = 1.
    let found = segcomp(&table(&[(1, 4, 90), (1, 5, 10)]), default);
    assert_eq!((found.correct, found.over_segmented, found.noise), (matched(&[]), vec![split(1, &[4, 5])], vec![]));
    // Correct (1, 4): (0.94 + 1) / 2 = 0.97. Over-segmented: ((1 + 5 / 6) / 2 + 0.99) / 2 = 0.953.
    let found = segcomp(&table(&[(1, 4, 94), (1, 5, 5), (0, 5, 1), (1, 0, 1)]), default);
    assert_eq!((found.correct, found.over_segmented, found.noise), (matched(&[(1, 4)]), vec![], vec![5]));
    // The same the other way round.
    let found = segcomp(&table(&[(1, 4, 90), (2, 4, 10)]), default);
    assert_eq!((found.correct, found.under_segmented, found.missed), (matched(&[]), vec![split(4, &[1, 2])], vec![]));
    let found = segcomp(&table(&[(1, 4, 94), (2, 4, 5), (2, 0, 1), (0, 4, 1)]), default);
    assert_eq!((found.correct, found.under_segmented, found.missed), (matched(&[(1, 4)]), vec![], vec![2]));
    // All three, over and under with one average, larger than that of correct: over (our choice).
    let found = segcomp(&table(&[(1, 4, 90), (1, 5, 10), (2, 4, 10)]), default);
    assert_eq!((found.correct, found.over_segmented, found.missed), (matched(&[]), vec![split(1, &[4, 5])], vec![2]));
    assert_eq!((found.under_segmented, found.noise), (vec![], vec![]));
    // All three. Over: ((90 / 102 + 1) / 2 + 1) / 2 = 0.971; under: ((0.9 + 1) / 2 + 1) / 2 = 0.975.
    let found = segcomp(&table(&[(1, 4, 90), (1, 5, 10), (2, 4, 12)]), default);
    assert_eq!((found.correct, found.over_segmented), (matched(&[]), vec![]));
    assert_eq!((found.under_segmented, found.noise), (vec![split(4, &[1, 2])], vec![5]));
    // All three, and over has the largest average.
    let found = segcomp(&table(&[(1, 4, 90), (1, 5, 12), (2, 4, 10)]), default);
    assert_eq!((found.over_segmented, found.missed), (vec![split(1, &[4, 5])], vec![2]));
}

#[test]
fn f_counts_planes_and_k_weighs_them() {
    let found = segcomp(&table(&[(1, 4, 30), (2, 5, 10), (3, 0, 20)]), Tolerance::default());
    assert_eq!((found.f, found.k), (Some(2.0 / 3.0), Some(40.0 / 60.0)));
    let none = segcomp(&table(&[(0, 1, 5)]), Tolerance::default());
    assert_eq!((none.f, none.k, none.noise), (None, None, vec![1]));
}

#[test]
fn evops_by_hand() {
    // 1 = 4 by 9 / 10. 2 is cut in 5 and 6: 4 / 10 each. 7 joins 3 and 8: 5 / 10 each. 9 is missed
    // (10 has 2 / 10 of it, alone) and 10 is noise.
    let counts = [(1, 4, 9), (1, 0, 1), (2, 5, 4), (2, 6, 4), (2, 0, 2), (3, 7, 5), (8, 7, 5), (9, 10, 2), (9, 0, 8)];
    let found = evops(&table(&counts));
    assert_eq!(found.matched, matched(&[(1, 4)]));
    assert!(close(found.precision, 1.0 / 5.0) && close(found.recall, 1.0 / 5.0) && close(found.f_score, 1.0 / 5.0));
    assert!(close(found.mean_iou, 0.9) && close(found.mean_dice, 18.0 / 19.0));
    assert!(close(found.panoptic_iou, 0.18) && close(found.panoptic_dice, 18.0 / 95.0));
    assert!(close(found.under_segmented, 1.0 / 5.0) && close(found.over_segmented, 1.0 / 5.0));
    assert!(close(found.missed, 1.0 / 5.0) && close(found.noise, 1.0 / 5.0));
}

#[test]
fn evops_of_nothing_is_0_as_in_the_package() {
    for counts in [&[][..], &[(0, 0, 5)], &[(1, 0, 5)], &[(0, 1, 5)]] {
        let found = evops(&table(counts));
        assert_eq!((found.precision, found.recall, found.f_score, found.mean_iou), (0.0, 0.0, 0.0, 0.0));
        assert!(found.mean_iou.is_sign_positive() && found.panoptic_dice.is_sign_positive());
        let (truth, prediction) = (counts.iter().any(|c| c.0 > 0), counts.iter().any(|c| c.1 > 0));
        assert_eq!((found.missed, found.noise), (f64::from(truth), f64::from(prediction)));
    }
}

#[test]
fn partition_measures_by_hand() {
    // Two regions of 2 against one of 4: of 6 pairs 2 are together in both, 4 in one only.
    let found = partition(&table(&[(1, 1, 2), (2, 1, 2)])).unwrap();
    assert!(close(found.rand_index, 2.0 / 6.0));
    assert!(close(found.variation_of_information, 1.0)); // which of the two: one bit
    assert!(close(found.segmentation_covering, 0.5)); // each best intersection over union is 1 / 2
    // "No plane" is one more region; on the truth's planes only 2 of 4 pixels are left.
    let all = table(&[(0, 0, 1), (0, 1, 1), (1, 1, 2)]);
    let found = partition(&all).unwrap();
    assert!(close(found.rand_index, 1.0 - ((4.0 + 4.0 + 1.0 + 9.0) / 2.0 - 6.0) / 6.0));
    assert!(close(found.segmentation_covering, ((2.0 * 0.5 + 2.0 * 2.0 / 3.0) + (0.5 + 3.0 * 2.0 / 3.0)) / 8.0));
    let on_planes = partition(&all.on_truth_planes()).unwrap();
    assert_eq!((on_planes.rand_index, on_planes.variation_of_information), (1.0, 0.0));
    assert!(on_planes.variation_of_information.is_sign_positive());
    assert_eq!(on_planes.segmentation_covering, 1.0);
}

#[test]
fn a_partition_of_no_pixel_has_no_measures() {
    assert_eq!(partition(&table(&[])), None);
    assert_eq!(partition(&table(&[(0, 3, 5)]).on_truth_planes()), None);
    assert_eq!(partition(&table(&[(0, 3, 1)])).unwrap().rand_index, 1.0);
}

fn plane(normal: [f64; 3], distance: f64) -> HessianNormalForm {
    let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
    HessianNormalForm { normal: normal.map(|x| x / length), distance }
}

#[test]
fn errors_of_normals_are_in_degrees_and_of_offsets_in_metres() {
    let wall = plane([0.0, 0.0, -1.0], 2.0);
    let error = plane_error(&wall, &plane([0.0, 1.0, -1.0], 2.5));
    assert!(close(error.normal_deg, 45.0) && close(error.offset_m, 0.5));
    // The same plane, seen from its other side.
    let error = plane_error(&plane([0.0, 1.0, 0.0], 0.01), &plane([0.0, -1.0, 0.0], -0.01));
    assert!(close(error.normal_deg, 0.0) && close(error.offset_m, 0.0));
    // A tiny angle keeps its digits.
    let error = plane_error(&wall, &plane([1e-9, 0.0, -1.0], 2.0));
    assert!((error.normal_deg - 1e-9_f64.to_degrees()).abs() < 1e-20);
}

#[test]
fn matches_without_a_plane_are_passed_over() {
    let known = |label| (label != 2).then(|| plane([0.0, 0.0, -1.0], f64::from(label)));
    let errors = plane_errors(&matched(&[(1, 3), (2, 5), (4, 2), (6, 6)]), known, known);
    let told: Vec<_> = errors.iter().map(|(pair, error)| (pair.truth, error.offset_m)).collect();
    assert_eq!(told, [(1, 2.0), (6, 0.0)]);
}

#[test]
fn neighbours_share_an_edge() {
    #[rustfmt::skip]
    let labels = [
        1, 1, 0, 5,
        1, 2, 0, 5,
        3, 2, 4, 4,
    ];
    assert_eq!(adjacent(&labels, 4, 3).unwrap(), [(1, 2), (1, 3), (2, 3), (2, 4), (4, 5)]);
    assert_eq!(adjacent(&[], 0, 7).unwrap(), []);
    assert_eq!(adjacent(&labels, 4, 4), Err(Error::Length { given: 12, least: 16, most: 16 }));
}

#[test]
fn the_angle_between_correct_neighbours_is_compared() {
    let found = segcomp(&table(&[(1, 11, 9), (2, 12, 9), (3, 13, 9), (4, 0, 9)]), Tolerance::default());
    let truth = |label| match label {
        1 => Some(plane([0.0, 0.0, -1.0], 1.0)),
        2 => Some(plane([0.0, -1.0, 0.0], 1.0)),
        3 | 4 => Some(plane([0.0, -1.0, -1.0], 1.0)),
        _ => None,
    };
    let prediction = |label| match label {
        11 => Some(plane([0.0, 0.0, -1.0], 1.0)),
        12 => Some(plane([0.0, -1.0, -1.0], 1.0)),
        _ => None,
    };
    // (1, 2) is 45 degrees instead of 90; 13 has no plane; 4 is missed.
    let errors = angle_errors(&found, &[(1, 2), (1, 3), (1, 4)], truth, prediction);
    assert!(errors.len() == 1 && close(errors[0], 45.0), "{errors:?}");
}

#[test]
fn the_largest_planes_found_in_a_clean_scene_lie_where_they_are() {
    let frame = "room:sensor=clean_mm".parse::<Spec>().unwrap().frame().unwrap();
    let truth = &frame.truth;
    let mut detector = Detector::new(Ngaf::default().theta(4.0).min_pixels(1000)).unwrap().sensor(frame.sensor);
    let detection = detector.detect(frame.view()).unwrap();
    let found = segcomp(&Contingency::new(&truth.labels, &detection.labels).unwrap(), Tolerance::default());
    let true_plane = |label: u16| truth.planes.get(usize::from(label) - 1).map(|plane| plane.plane);
    let plane = |label: u16| detection.planes.get(usize::from(label) - 1)?.metric.map(|metric| metric.plane);
    let errors = plane_errors(&found.correct, true_plane, plane);
    assert!(errors.len() == found.correct.len() && errors.len() > 3, "{errors:?}");
    // By size; up to a fifth of a correct plane may lie elsewhere, which tilts the small ones.
    for (pair, error) in &errors[..3] {
        assert!(error.normal_deg < 1.0 && error.offset_m < 0.01, "{pair:?} {error:?}");
    }
}

/// Label images of a few labels, in runs or pixel by pixel.
fn images() -> impl Strategy<Value = (Vec<u16>, Vec<u16>)> {
    let pixel = (0u16..5, 0u16..5, 1usize..12, 0u16..3);
    vec(pixel, 0..40).prop_map(|runs| {
        let mut images = (Vec::new(), Vec::new());
        for (truth, other, length, tie) in runs {
            // Two of three times the prediction follows the truth.
            let prediction = if tie > 0 { truth } else { other };
            images.0.extend(std::iter::repeat_n(truth, length));
            images.1.extend(std::iter::repeat_n(prediction, length));
        }
        images
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn a_perfect_prediction_has_a_perfect_score((truth, _) in images(), share in 0.51..=0.95) {
        let renamed: Vec<u16> = truth.iter().map(|label| label * 17).collect();
        let table = Contingency::new(&truth, &renamed).unwrap();
        let planes: Vec<u16> = table.truth_planes().iter().map(|region| region.label).collect();
        let found = segcomp(&table, Tolerance::new(share).unwrap());
        let all: Vec<_> = planes.iter().map(|&label| Match { truth: label, prediction: label * 17 }).collect();
        prop_assert_eq!(&found.correct, &all);
        prop_assert!(found.missed.is_empty() && found.noise.is_empty());
        let one = f64::from(!planes.is_empty());
        prop_assert_eq!((found.f.unwrap_or(0.0), found.k.unwrap_or(0.0)), (one, one));
        let found = evops(&table);
        prop_assert_eq!((found.precision, found.recall, found.panoptic_iou, found.panoptic_dice), (one, one, one, one));
        prop_assert_eq!((found.under_segmented, found.over_segmented, found.missed, found.noise), (0.0, 0.0, 0.0, 0.0));
        if let Some(found) = partition(&table) {
            prop_assert_eq!((found.rand_index, found.variation_of_information), (1.0, 0.0));
            prop_assert!(close(found.segmentation_covering, 1.0));
        }
    }

    #[test]
    fn names_of_labels_change_nothing((truth, prediction) in images()) {
        let name = |label: &u16| if *label == 0 { 0 } else { 60000 - 1000 * label };
        let before = Contingency::new(&truth, &prediction).unwrap();
        let renamed = |labels: &[u16]| labels.iter().map(name).collect::<Vec<_>>();
        let after = Contingency::new(&renamed(&truth), &renamed(&prediction)).unwrap();
        let (a, b) = (segcomp(&before, Tolerance::default()), segcomp(&after, Tolerance::default()));
        prop_assert_eq!(a.correct.len(), b.correct.len());
        prop_assert_eq!(a.over_segmented.len(), b.over_segmented.len());
        prop_assert_eq!(a.under_segmented.len(), b.under_segmented.len());
        prop_assert_eq!((a.missed.len(), a.noise.len(), a.f, a.k), (b.missed.len(), b.noise.len(), b.f, b.k));
        let (a, b) = (evops(&before), evops(&after));
        prop_assert!(close(a.panoptic_iou, b.panoptic_iou) && close(a.panoptic_dice, b.panoptic_dice));
        prop_assert_eq!((a.missed, a.noise, a.over_segmented), (b.missed, b.noise, b.over_segmented));
        if let (Some(a), Some(b)) = (partition(&before), partition(&after)) {
            prop_assert!(close(a.rand_index, b.rand_index) && close(a.segmentation_covering, b.segmentation_covering));
            prop_assert!(close(a.variation_of_information, b.variation_of_information));
        }
    }

    #[test]
    fn each_plane_is_in_exactly_one_class((truth, prediction) in images(), share in 0.51..=0.95) {
        let table = Contingency::new(&truth, &prediction).unwrap();
        let found = segcomp(&table, Tolerance::new(share).unwrap());
        let mut of_truth: Vec<u16> = found.correct.iter().map(|pair| pair.truth).collect();
        of_truth.extend(found.over_segmented.iter().map(|split| split.whole));
        of_truth.extend(found.under_segmented.iter().flat_map(|split| split.parts.clone()));
        of_truth.extend(&found.missed);
        of_truth.sort_unstable();
        prop_assert!(of_truth.iter().eq(table.truth_planes().iter().map(|region| &region.label)), "{of_truth:?}");
        let mut of_prediction: Vec<u16> = found.correct.iter().map(|pair| pair.prediction).collect();
        of_prediction.extend(found.under_segmented.iter().map(|split| split.whole));
        of_prediction.extend(found.over_segmented.iter().flat_map(|split| split.parts.clone()));
        of_prediction.extend(&found.noise);
        of_prediction.sort_unstable();
        prop_assert!(of_prediction.iter().eq(table.predicted_planes().iter().map(|region| &region.label)));
    }

    #[test]
    fn exchanging_the_images_mirrors_the_measures((truth, prediction) in images()) {
        let there = Contingency::new(&truth, &prediction).unwrap();
        let back = Contingency::new(&prediction, &truth).unwrap();
        prop_assert_eq!(&there.swapped(), &back);
        if let (Some(a), Some(b)) = (partition(&there), partition(&back)) {
            prop_assert_eq!(a.rand_index, b.rand_index);
            prop_assert!(close(a.variation_of_information, b.variation_of_information));
            prop_assert!(close(a.segmentation_covering, b.segmentation_covering));
            prop_assert!((0.0..=1.0).contains(&a.rand_index) && a.segmentation_covering <= 1.0 + 1e-12);
        }
        let (a, b) = (evops(&there), evops(&back));
        prop_assert_eq!((a.precision, a.missed, a.under_segmented), (b.recall, b.noise, b.over_segmented));
    }
}
