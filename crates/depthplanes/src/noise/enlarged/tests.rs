use super::*;
use crate::util::random::Random;

/// A room on 64 x 48 pixels, millimetres, with that much noise.
fn source(noise_mm: f64) -> Vec<u16> {
    let mut random = Random::new(1);
    let at = |u: usize, v: usize| {
        let [x, y] = [(u as f64 - 31.5) / 57.6, (v as f64 - 23.5) / 57.6];
        let wall = (0.98 - 0.199 * y) / 4.0;
        1e3 / [(0.98 * y + 0.199) / 1.2, x / 1.5].into_iter().fold(wall, f64::max)
    };
    (0..64 * 48).map(|place| (at(place % 64, place / 64) + noise_mm * random.gaussian()).round() as u16).collect()
}

/// A map enlarged to so many pixels; each shows the source pixel under its left edge (0) or its centre (0.5).
fn enlarged(source: &[u16], [width, height]: [usize; 2], edge: f64) -> Vec<u16> {
    let place = |at: usize, pixels: usize, length: usize| ((at as f64 + edge) * pixels as f64 / length as f64) as usize;
    (0..width * height).map(|at| source[place(at / width, 48, height) * 64 + place(at % width, 64, width)]).collect()
}

#[test]
fn every_factor_is_found_and_the_source_is_as_it_was() {
    let mut finder = EnlargementFinder::default();
    for noise_mm in [0.0, 10.0] {
        let source = source(noise_mm);
        for [x, y] in [
            [2.0, 2.0],
            [2.5, 2.5],
            [3.0, 3.0],
            [4.0, 4.0],
            [7.5, 7.5],
            [10.0, 10.0],
            [16.0, 16.0],
            [2.5, 4.0],
            [3.125, 3.125],
        ] {
            for edge in [0.0, 0.5] {
                let [width, height] = [(64.0 * x) as usize, (48.0 * y) as usize];
                let pixels = enlarged(&source, [width, height], edge);
                let map = DepthView::new(&pixels, width, height).unwrap();
                let found = finder.find(&map).unwrap_or_else(|| panic!("{x} {y} {edge} {noise_mm}"));
                assert_eq!(found.factor, [x, y], "{edge} {noise_mm}");
                let [columns, rows] = [found.columns, found.rows];
                let back = rows.iter().flat_map(|&v| columns.iter().map(move |&u| map.row(v as usize)[u as usize]));
                assert_eq!(back.collect::<Vec<_>>(), source, "{x} {y} {edge} {noise_mm}");
            }
        }
    }
}

#[test]
fn a_map_that_was_cut_off_within_a_pixel_is_found_by_a_round_factor() {
    let source = source(10.0);
    let pixels = enlarged(&source, [256, 192], 0.5);
    let map = DepthView::with_stride(&pixels[..190 * 256], 251, 190, 256).unwrap();
    assert_eq!(EnlargementFinder::default().find(&map).map(|found| found.factor), Some([4.0, 4.0]));
}

#[test]
fn missing_pixels_are_alike() {
    let mut random = Random::new(4);
    let source: Vec<f32> =
        source(10.0).into_iter().map(|mm| if random.uniform() < 0.3 { f32::NAN } else { mm.into() }).collect();
    let pixels: Vec<f32> = (0..192 * 144).map(|at| source[at / 192 / 3 * 64 + at % 192 / 3]).collect();
    let map = DepthView::new(&pixels, 192, 144).unwrap();
    assert_eq!(EnlargementFinder::default().find(&map).map(|found| found.factor), Some([3.0, 3.0]));
}

/// Maps that were not enlarged, with their descriptions.
fn ordinary() -> Vec<(&'static str, Vec<u16>)> {
    let [width, height] = [320, 240];
    let map = |of: &dyn Fn(usize, usize) -> f64| {
        (0..width * height).map(|at| of(at % width, at / width).round() as u16).collect::<Vec<u16>>()
    };
    let steps = |u: usize, v: usize| 1000.0 + 200.0 * (v / 40) as f64 + 10.0 * (u / 100) as f64;
    vec![
        ("constant", map(&|_, _| 1000.0)),
        ("missing", map(&|_, _| 0.0)),
        ("two walls", map(&|u, _| if u < 160 { 1000.0 } else { 2000.0 })),
        ("stairs", map(&steps)),
        ("facing the camera", map(&|u, v| 1000.0 + 0.01 * u as f64 + 0.02 * v as f64)),
        ("coarse disparity", map(&|u, v| 20.0 + 0.13 * u as f64 + 0.21 * v as f64)),
        ("coarse disparity along rows", map(&|u, _| 20.0 + 0.13 * u as f64)),
        ("coarse disparity with a bend", map(&|u, v| 20.0 + (0.31 * u as f64).max(0.27 * v as f64))),
        ("enlarged one way", map(&|u, v| 1000.0 + 7.0 * (u / 4) as f64 + 3.0 * v as f64)),
        (
            "one pixel more",
            map(&|u, v| f64::from(u8::from(u == 100 && v == 7)) + 1000.0 + (u / 4 * 7 + v / 4 * 3) as f64),
        ),
    ]
}

#[test]
fn ordinary_maps_were_not_enlarged() {
    let mut finder = EnlargementFinder::default();
    for (what, pixels) in ordinary() {
        assert_eq!(finder.find(&DepthView::new(&pixels, 320, 240).unwrap()), None, "{what}");
    }
    for (width, height) in [(1, 1), (2, 1), (1, 9), (5, 5)] {
        let pixels: Vec<u16> = (1..=width * height).map(|at| at as u16).collect();
        assert_eq!(finder.find(&DepthView::new(&pixels, width, height).unwrap()), None, "{width} x {height}");
    }
}
