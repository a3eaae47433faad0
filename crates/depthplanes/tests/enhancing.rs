//! Map enhancing (paper, section 3b) matches the naive version value for value, and the paper's text
//! by hand.

mod naive;

use depthplanes::internals::{Enhancer, Fillable};
use depthplanes::{DepthView, Pixel};
use naive::Random;

const CASES: u64 = 3600;

fn odd_window(random: &mut Random) -> u32 {
    3 + 2 * random.below(15) as u32
}

fn size(random: &mut Random, case: u64) -> (usize, usize) {
    let mut side = |most: u64| 1 + random.below(most) as usize;
    match case % 4 {
        0 => (side(4), side(60)),
        1 => (side(60), side(4)),
        2 => (side(12), side(12)),
        _ => (side(60), side(60)),
    }
}

/// Bit patterns, so that NaN equals itself and 0 differs from -0.
fn bits<T: Pixel>(values: impl Iterator<Item = T>) -> Vec<u64> {
    values.map(|value| value.into().to_bits()).collect()
}

/// Compares one map with the naive version; returns how many pixels were filled.
fn check<T: Fillable>(view: &DepthView<'_, T>, window: u32, passes: u32, enhancer: &mut Enhancer) -> usize {
    let rule = view.validity();
    let ok = |value: f64| naive::valid(value, rule.sentinel.into(), rule.low.into(), rule.high.into());
    let mean = if T::IS_INTEGER { naive::whole_mean } else { naive::single_mean };
    let mut expected: Vec<f64> = view.rows().flatten().map(|&value| value.into()).collect();
    let mut expected_count = 0;
    for _ in 0..passes {
        let (map, count) = naive::enhance(&expected, view.width(), ok, window as usize, mean);
        (expected, expected_count) = (map, expected_count + count);
    }
    let (filled, count) = enhancer.enhance(view, window, passes).unwrap();
    let what = format!("{}x{}, window {window}, {passes} passes", view.width(), view.height());
    assert_eq!((filled.width(), filled.height()), (view.width(), view.height()));
    assert_eq!(format!("{:?}", filled.validity()), format!("{rule:?}"), "{what}");
    assert_eq!(count, expected_count, "{what}");
    let expected: Vec<u64> = expected.into_iter().map(f64::to_bits).collect();
    assert!(bits(filled.rows().flatten().copied()) == expected, "{what}: {view:?}");
    count
}

#[test]
fn every_8_bit_map_is_filled_as_defined() {
    let mut random = Random(11);
    let mut enhancer = Enhancer::default();
    let mut filled = 0;
    for case in 0..CASES {
        let (width, height) = size(&mut random, case);
        let stride = width + random.below(4) as usize;
        let (holes, spread) = (random.below(101), 1 + random.below(255));
        let value = |random: &mut Random| if random.below(100) < holes { 0 } else { random.below(spread + 1) as u8 };
        let map: Vec<u8> = (0..stride * height).map(|_| value(&mut random)).collect();
        let mut view = DepthView::with_stride(&map, width, height, stride).unwrap();
        if case % 3 == 0 {
            view = view.missing_value(map[0]);
        }
        if case % 5 == 0 {
            view = view.valid_range(random.below(100) as u8, 100 + random.below(156) as u8).unwrap();
        }
        filled += check(&view, odd_window(&mut random), 1 + (case % 3) as u32, &mut enhancer);
    }
    assert!(filled > 100_000, "{filled}");
}

#[test]
fn every_16_bit_map_is_filled_as_defined() {
    let mut random = Random(12);
    let mut enhancer = Enhancer::default();
    let mut filled = 0;
    for case in 0..CASES {
        let (width, height) = size(&mut random, case);
        let stride = width + random.below(4) as usize;
        let (holes, kinect) = (random.below(101), case % 2 == 0);
        let (low, most) = if kinect { (300, 1090) } else { (65_535 - random.below(65_535), 65_535) };
        let value = |random: &mut Random| match random.below(100) < holes {
            true if kinect && random.below(2) == 0 => 2047,
            true => 0,
            false => (low + random.below(most - low + 1)) as u16,
        };
        let map: Vec<u16> = (0..stride * height).map(|_| value(&mut random)).collect();
        let mut view = DepthView::with_stride(&map, width, height, stride).unwrap();
        if kinect {
            view = view.missing_value(2047);
        }
        if case % 5 == 0 {
            view = view.valid_range(random.below(500) as u16, 501 + random.below(60_000) as u16).unwrap();
        }
        filled += check(&view, odd_window(&mut random), 1 + (case % 3) as u32, &mut enhancer);
    }
    assert!(filled > 100_000, "{filled}");
}

#[test]
fn every_floating_point_map_is_filled_as_defined() {
    let mut random = Random(13);
    let mut enhancer = Enhancer::default();
    let mut filled = 0;
    for case in 0..CASES {
        let (width, height) = size(&mut random, case);
        let stride = width + random.below(4) as usize;
        // Powers of ten: narrow spans take moving sums, wide ones direct sums; the middle is the border.
        let (low, high) = match case % 6 {
            0 => (-0.5, 1.0),
            1 => (-3.0, 4.0),
            2 => (-30.0, 30.0),
            3 => (-44.0, -36.0),
            4 => (37.0, 38.5),
            _ => (0.0, random.between(2.0, 7.0)),
        };
        let (holes, signed) = (random.below(101), random.below(2) == 0);
        let missing = [0.0, -0.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0];
        let value = |random: &mut Random| {
            if random.below(100) < holes {
                return missing[random.below(6) as usize];
            }
            let sign = if signed && random.below(3) == 0 { -1.0 } else { 1.0 };
            sign * 10f64.powf(random.between(low, high)) as f32
        };
        let map: Vec<f32> = (0..stride * height).map(|_| value(&mut random)).collect();
        let mut view = DepthView::with_stride(&map, width, height, stride).unwrap().missing_value(-1.0);
        if case % 5 == 0 {
            view = view.valid_range(10f64.powf((low + high) / 2.0) as f32, f32::INFINITY).unwrap();
        }
        filled += check(&view, odd_window(&mut random), 1 + (case % 3) as u32, &mut enhancer);
    }
    assert!(filled > 100_000, "{filled}");
}

#[test]
fn maps_of_the_largest_16_bit_values_sum_without_rounding() {
    let mut random = Random(14);
    let (width, height) = (5000, 40);
    let value = |random: &mut Random| if random.below(4) == 0 { 0 } else { 65_535 - random.below(2) as u16 };
    let map: Vec<u16> = (0..width * height).map(|_| value(&mut random)).collect();
    check(&DepthView::new(&map, width, height).unwrap(), 31, 1, &mut Enhancer::default());
}

/// Any window's mean: the sums next to each half-integer, for each count that a window can have.
#[test]
fn rounding_a_quotient_is_rounding_the_fraction() {
    for count in 1..=31 * 31u64 {
        for whole in (0..65_535u64).step_by(if count < 40 { 1 } else { 61 }).chain([65_533, 65_534]) {
            let half = whole * count + count / 2; // the last sum whose mean is at most whole + 1/2
            for sum in half.saturating_sub(2)..=(half + 2).min(65_535 * count) {
                let exact = (2 * sum + count) / (2 * count);
                assert_eq!(u64::from(u16::from_f64(sum as f64 / count as f64)), exact, "{sum} / {count}");
                if exact <= 255 {
                    assert_eq!(u64::from(u8::from_f64(sum as f64 / count as f64)), exact, "{sum} / {count}");
                }
            }
        }
    }
}

fn enhanced<const N: usize>(map: [u16; N], width: usize, window: u32) -> ([u16; N], usize) {
    let view = DepthView::new(&map, width, N / width).unwrap().missing_value(2047);
    let mut enhancer = Enhancer::default();
    let (filled, count) = enhancer.enhance(&view, window, 1).unwrap();
    let values: Vec<u16> = filled.rows().flatten().copied().collect();
    (values.try_into().unwrap(), count)
}

#[test]
fn a_missing_pixel_takes_the_mean_of_the_valid_ones_around_it() {
    let (filled, count) = enhanced([10, 20, 30, 40, 0, 60, 70, 80, 90], 3, 3);
    assert_eq!((filled[4], count), (50, 1));
    // The other missing pixel of the window counts for nothing.
    let (filled, count) = enhanced([10, 20, 30, 40, 0, 60, 70, 80, 2047], 3, 3);
    assert_eq!((filled[4], count), (44, 2)); // 310 / 7 = 44.3; the corner is filled from its own window
    assert_eq!(filled[8], 70); // (60 + 80) / 2, two of four missing
}

#[test]
fn a_pixel_with_more_than_half_of_its_window_missing_stays_missing() {
    // Five of nine are missing around the middle, six of nine or more elsewhere or clipped likewise.
    let (filled, _) = enhanced([10, 0, 0, 0, 0, 0, 10, 10, 10], 3, 3);
    assert_eq!(filled[4], 0);
    let (filled, count) = enhanced([0, 0, 0, 0, 7, 0, 0, 0, 0], 3, 3);
    assert_eq!((filled, count), ([0, 0, 0, 0, 7, 0, 0, 0, 0], 0));
    let (filled, count) = enhanced([2047; 9], 3, 3);
    assert_eq!((filled, count), ([2047; 9], 0));
}

#[test]
fn a_pixel_with_exactly_half_of_its_window_missing_is_filled() {
    // At the left edge the window is 2 x 3: three missing, three valid.
    let (filled, _) = enhanced([0, 10, 10, 0, 11, 10, 0, 12, 10], 3, 3);
    assert_eq!((filled[0], filled[3], filled[6]), (11, 11, 12)); // 21 / 2, 33 / 3, 23 / 2
    // One valid pixel less, and it is more than half.
    let (filled, _) = enhanced([0, 10, 10, 0, 0, 10, 0, 12, 10], 3, 3);
    assert_eq!(filled[3], 0);
}

#[test]
fn windows_are_clipped_at_the_edge_not_filled_with_missing_pixels() {
    // The corner's window holds 4 pixels, 3 of them valid; as a full window 6 of 9 would be missing.
    let (filled, count) = enhanced([0, 30, 99, 30, 36, 99, 99, 99, 99], 3, 3);
    assert_eq!((filled[0], count), (32, 1));
    // A window larger than the map is the map.
    let (filled, count) = enhanced([0, 1, 2, 3], 2, 31);
    assert_eq!((filled[0], count), (2, 1));
}

#[test]
fn means_of_whole_numbers_round_half_up() {
    for (a, b, mean) in [(10, 11, 11), (10, 12, 11), (1, 2, 2), (65_534, 65_535, 65_535)] {
        assert_eq!(enhanced([a, 0, b], 3, 3).0, [a, mean, b]);
    }
}

#[test]
fn pixels_are_filled_from_the_original_and_not_from_each_other() {
    // Left to right, the filled 13 would make up half of the next pixel's window.
    assert_eq!(enhanced([10, 10, 10, 0, 0, 20, 0], 7, 5), ([10, 10, 10, 13, 0, 20, 0], 1));
    // Turning a map by half a turn turns its answer.
    let mut random = Random(15);
    let (width, height) = (40, 30);
    let map: Vec<u16> = (0..width * height).map(|_| (random.below(3).min(1) * random.below(3000)) as u16).collect();
    let turned: Vec<u16> = map.iter().rev().copied().collect();
    let fill = |map: &[u16]| -> Vec<u16> {
        let mut enhancer = Enhancer::default();
        let (filled, _) = enhancer.enhance(&DepthView::new(map, width, height).unwrap(), 5, 1).unwrap();
        filled.rows().flatten().copied().collect()
    };
    assert!(fill(&turned).into_iter().rev().eq(fill(&map)));
}

#[test]
fn a_mean_that_means_missing_fills_nothing() {
    let map = [99u8, 100, 101, 99, 100, 101];
    let view = DepthView::new(&map, 3, 2).unwrap().missing_value(100);
    let mut enhancer = Enhancer::default();
    let (filled, count) = enhancer.enhance(&view, 3, 100).unwrap();
    assert_eq!((filled.valid_pixels(), count), (4, 0));
    let map = [-2.0f32, 0.0, 2.0];
    let (filled, count) = enhancer.enhance(&DepthView::new(&map, 3, 1).unwrap(), 3, 5).unwrap();
    assert_eq!((filled.row(0), count), (&map[..], 0));
}

#[test]
fn a_second_pass_reads_what_the_first_left() {
    let after = |passes| {
        let map = [10u16, 10, 10, 0, 0, 20, 0];
        let mut enhancer = Enhancer::default();
        let (filled, count) = enhancer.enhance(&DepthView::new(&map, 7, 1).unwrap(), 5, passes).unwrap();
        (filled.row(0).to_vec(), count)
    };
    assert_eq!(after(1), (vec![10, 10, 10, 13, 0, 20, 0], 1));
    assert_eq!(after(2), (vec![10, 10, 10, 13, 14, 20, 0], 2));
    assert_eq!(after(3), (vec![10, 10, 10, 13, 14, 20, 17], 3));
    assert_eq!(after(100), after(3));
}

#[test]
fn windows_are_odd_and_from_3_to_31() {
    let map = [1u8, 0, 1];
    let view = DepthView::new(&map, 3, 1).unwrap();
    for window in [0, 1, 2, 4, 30, 32, 33, u32::MAX] {
        let error = Enhancer::default().enhance(&view, window, 1).unwrap_err().to_string();
        let expected = format!("parameter `window` is {window}; accepted: an odd whole number of pixels from 3 to 31");
        assert_eq!(error, expected);
    }
}
