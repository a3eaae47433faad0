//! Grouping and selection on every kernel and number of threads match the naive flood, label for label.

mod naive;

use depthplanes::DepthView;
use depthplanes::internals::Selection;
use depthplanes::internals::{Compiles, ConnectedComponents, Connectivity, Kernel, kernels};
use naive::Random;

fn labels<T: Compiles>(
    view: &DepthView<'_, T>,
    theta: f64,
    min: u32,
    kernel: &'static Kernel,
    threads: usize,
) -> Vec<u16> {
    let mut grouper = ConnectedComponents::with_kernel(kernel);
    grouper.leave_out_singles(min >= 1);
    let mut selection = Selection::default();
    let rule = Connectivity::new(view.validity(), theta).unwrap();
    let groups = grouper.group(view, &rule, threads);
    selection.select(groups, min).unwrap();
    let mut labels = Vec::new();
    selection.paint(groups, &mut labels);
    labels
}

/// Compares all kernels and several thread counts with the flood.
fn check<T: Compiles>(view: &DepthView<'_, T>, theta: f64, min: u32, what: &str) {
    let map: Vec<f64> = view.rows().flatten().map(|&value| value.into()).collect();
    let rule = view.validity();
    let ok = |value: f64| naive::valid(value, rule.sentinel.into(), rule.low.into(), rule.high.into());
    let groups = naive::flood(&map, view.width(), ok, theta, !T::IS_INTEGER);
    let expected = naive::select(&groups, min as usize);
    for kernel in kernels() {
        for threads in [1, 2, 5] {
            let got = labels(view, theta, min, kernel, threads);
            assert!(
                got == expected,
                "{what}: {kernel:?} on {threads} threads differs, {}x{}, theta {theta}, min {min}",
                view.width(),
                view.height()
            );
        }
    }
}

fn random_size(random: &mut Random, case: u64) -> (usize, usize) {
    match case % 4 {
        0 => (1 + random.below(8) as usize, 1 + random.below(8) as usize),
        1 => (1 + random.below(200) as usize, 1 + random.below(200) as usize),
        2 => (60 + random.below(10) as usize, 1 + random.below(70) as usize),
        _ => (1 + random.below(130) as usize, 1 + random.below(20) as usize),
    }
}

#[test]
fn every_kernel_matches_the_flood_on_8_bit_maps() {
    let mut random = Random(1);
    for case in 0..5000 {
        let (width, height) = random_size(&mut random, case);
        let map = naive::awkward_map(&mut random, width, height);
        let view = DepthView::new(&map, width, height).unwrap();
        check(&view, random.below(9) as f64 / 2.0, random.below(6) as u32, "u8");
    }
}

#[test]
fn every_kernel_matches_the_flood_on_16_bit_maps_with_stride_sentinel_and_range() {
    let mut random = Random(2);
    for case in 0..5000 {
        let (width, height) = random_size(&mut random, case);
        let stride = width + random.below(5) as usize;
        let scale = [1, 7, 250][random.below(3) as usize];
        let small = naive::awkward_map(&mut random, stride, height);
        let map: Vec<u16> = small.iter().map(|&value| u16::from(value) * scale).collect();
        let mut view = DepthView::with_stride(&map, width, height, stride).unwrap();
        if random.below(2) == 0 {
            view = view.missing_value(map[random.below(map.len() as u64) as usize]);
        }
        if random.below(2) == 0 {
            view = view.valid_range(30 * scale, 150 * scale).unwrap();
        }
        check(&view, (random.below(5) * u64::from(scale)) as f64, random.below(6) as u32, "u16");
    }
}

#[test]
fn every_kernel_matches_the_flood_on_floating_point_maps_with_every_kind_of_missing() {
    let mut random = Random(3);
    for case in 0..5000 {
        let (width, height) = random_size(&mut random, case);
        let small = naive::awkward_map(&mut random, width, height);
        let map: Vec<f32> = small
            .iter()
            .map(|&value| match (value, random.below(5)) {
                (0, 0) => f32::NAN,
                (0, 1) => f32::INFINITY,
                (0, 2) => f32::NEG_INFINITY,
                (0, 3) => -1.0,
                (value, _) => f32::from(value) * 0.01 + random.below(100) as f32 * 1e-5,
            })
            .collect();
        let mut view = DepthView::new(&map, width, height).unwrap();
        if random.below(2) == 0 {
            view = view.missing_value(-1.0);
        }
        if random.below(3) == 0 {
            view = view.valid_range(0.3, 1.5).unwrap();
        }
        check(&view, random.below(5) as f64 * 0.01, random.below(6) as u32, "f32");
    }
}

#[test]
fn values_at_the_ends_of_their_type_are_compared_without_overflow() {
    let map: Vec<u16> = vec![65535, 1, 65535, 65534, 1, 2, 32768, 32767, 65535];
    let view = DepthView::new(&map, 3, 3).unwrap();
    for theta in [0.0, 1.0, 32767.0, 65533.0, 65534.0, 65535.0, 1e9, f64::INFINITY] {
        check(&view, theta, 0, "ends of u16");
    }
    let map: Vec<u8> = vec![255, 1, 255, 254, 1, 2, 128, 127, 255];
    let view = DepthView::new(&map, 3, 3).unwrap();
    for theta in [0.0, 1.0, 127.0, 253.0, 254.0, 255.0, 256.0, 1e9] {
        check(&view, theta, 0, "ends of u8");
    }
}

#[test]
fn a_large_map_is_the_same_on_every_kernel_and_thread_count() {
    let mut random = Random(4);
    let (width, height) = (1000, 700);
    let map: Vec<u16> =
        (0..width * height).map(|at| (500 + at / 999 % 300 + random.below(7) as usize) as u16).collect();
    check(&DepthView::new(&map, width, height).unwrap(), 2.0, 20, "large");
}

#[test]
fn rows_that_fill_a_block_by_themselves_match_the_flood() {
    let mut random = Random(5);
    for (width, height) in [(20_000, 5), (9_000, 7), (5_000, 11), (63, 600), (64, 600), (65, 600)] {
        let map: Vec<u8> = (0..width * height)
            .map(|at| match random.below(50) {
                0 => 0,
                odd => (1 + at % width / 90 + at / width / 3 + (odd < 4) as usize) as u8,
            })
            .collect();
        for min in [0, 5] {
            check(&DepthView::new(&map, width, height).unwrap(), 1.0, min, "wide or high");
        }
    }
}

#[test]
fn theta_must_be_a_number_of_at_least_0() {
    let view = DepthView::new(&[1u8], 1, 1).unwrap();
    for theta in [-1.0, f64::NAN, f64::NEG_INFINITY] {
        let error = Connectivity::new(view.validity(), theta).unwrap_err();
        assert!(error.to_string().contains("theta"), "{error}");
    }
}

#[test]
fn more_planes_than_labels_is_an_error_that_names_the_remedy() {
    let map: Vec<u8> = (0..400 * 400).map(|at| 1 + ((at % 400 + at / 400) % 2 * 100) as u8).collect();
    let view = DepthView::new(&map, 400, 400).unwrap();
    let mut grouper = ConnectedComponents::new();
    let groups = grouper.group(&view, &Connectivity::new(view.validity(), 1.0).unwrap(), 1);
    let error = Selection::default().select(groups, 0).unwrap_err();
    assert!(error.to_string().contains("160000 planes") && error.to_string().contains("raise `min-pixels`"), "{error}");
}
