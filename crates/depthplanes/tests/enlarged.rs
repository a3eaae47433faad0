//! Maps that were enlarged by repeating pixels, and `planar`.

use depthplanes::{Coplanar, DepthView, Detection, Detector, Intrinsics, Planar, Sensor};

const SIZE: [usize; 2] = [160, 120];

/// A room of 160 x 120 pixels, millimetres: a wall 4 m away, a floor 1.2 m below, a side 1.5 m to the right.
fn room() -> Vec<u16> {
    let at = |u: usize, v: usize| {
        let [x, y] = [(u as f64 - 79.5) / 144.0, (v as f64 - 59.5) / 144.0];
        let noise = ((u * 7919 + v * 104_729) % 1009) as f64 / 1009.0 - 0.5;
        let wall = (0.98 - 0.199 * y) / 4.0;
        (1e3 / [(0.98 * y + 0.199) / 1.2, x / 1.5].into_iter().fold(wall, f64::max) + 8.0 * noise).round() as u16
    };
    (0..SIZE[0] * SIZE[1]).map(|place| at(place % SIZE[0], place / SIZE[0])).collect()
}

/// Where a pixel of an enlarged map comes from.
fn source_of(at: usize, width: usize, factor: [f64; 2]) -> usize {
    let [u, v] = [at % width, at / width].map(|place| place as f64 + 0.5);
    (v / factor[1]) as usize * SIZE[0] + (u / factor[0]) as usize
}

fn enlarged(source: &[u16], factor: [f64; 2]) -> (Vec<u16>, [usize; 2]) {
    let size @ [width, height] = [0, 1].map(|axis| (SIZE[axis] as f64 * factor[axis]) as usize);
    ((0..width * height).map(|at| source[source_of(at, width, factor)]).collect(), size)
}

/// A sensor whose camera saw the source in so many times its pixels.
fn sensor([x, y]: [f64; 2]) -> Sensor {
    let centre = |centre: f64, factor: f64| (centre + 0.5) * factor - 0.5;
    let intrinsics = Intrinsics::new(144.0 * x, 144.0 * y, centre(79.5, x), centre(59.5, y)).ok();
    Sensor::default().intrinsics(intrinsics)
}

fn detect(detector: &mut Detector, pixels: &[u16], [width, height]: [usize; 2]) -> Detection {
    detector.detect(DepthView::new(pixels, width, height).unwrap()).unwrap().clone()
}

#[test]
fn an_enlarged_map_has_the_planes_of_its_source() {
    let source = room();
    for min in [100, 2000] {
        let params = Planar::default().min_pixels(min);
        let right = detect(&mut Detector::new(params).unwrap().sensor(sensor([1.0, 1.0])), &source, SIZE);
        assert_eq!(right.planes.len(), 3);
        for factor @ [x, y] in [[2.0, 2.0], [3.0, 3.0], [2.5, 4.0], [7.5, 7.5]] {
            let (pixels, size) = enlarged(&source, factor);
            for threads in [1, 3] {
                let params = params.min_pixels((f64::from(min) * x * y) as u32);
                let detector = Detector::new(params).unwrap().threads(threads);
                let found = detect(&mut detector.sensor(sensor(factor)), &pixels, size);
                check(&found, &right, size[0], factor);
            }
        }
    }
}

fn check(found: &Detection, right: &Detection, width: usize, factor: [f64; 2]) {
    assert_eq!((found.planes.len(), found.valid_pixels), (right.planes.len(), found.labels.len()), "{factor:?}");
    for (at, &label) in found.labels.iter().enumerate() {
        assert_eq!(label, right.labels[source_of(at, width, factor)], "{factor:?}, pixel {at}");
    }
    for (found, right) in found.planes.iter().zip(&right.planes) {
        let [found, right] = [found, right].map(|plane| plane.metric.as_ref().unwrap());
        let off = (found.plane.distance / right.plane.distance - 1.0).abs();
        assert!(off < 0.003, "{factor:?}: {off}");
        // What a pixel is worth does not grow with its copies.
        let ratio = found.covariance[3][3] / right.covariance[3][3];
        assert!((0.7..1.4).contains(&ratio), "{factor:?}: {ratio}");
    }
}

#[test]
fn min_counts_pixels_of_the_whole_map() {
    let (pixels, size) = enlarged(&room(), [2.0, 2.0]);
    let with = |min| detect(&mut Detector::new(Planar::default().min_pixels(min)).unwrap(), &pixels, size).planes.len();
    let all = detect(&mut Detector::default(), &pixels, size);
    let smallest = all.planes.last().unwrap().pixel_count as u32;
    assert_eq!([with(smallest - 1), with(smallest)], [all.planes.len(), all.planes.len() - 1]);
}

#[test]
fn stages_are_told_once_each_and_coplanar_planes_join() {
    let (pixels, [width, height]) = enlarged(&room(), [2.0, 2.0]);
    let view = DepthView::new(&pixels, width, height).unwrap();
    let within = Coplanar::new(5.0, 0.05).unwrap();
    let mut detector = Detector::default().sensor(sensor([2.0, 2.0])).merge_coplanar(within).unwrap();
    let mut told = Vec::new();
    let planes = detector.detect_observed(view, &mut |stage| told.push(stage)).unwrap().planes.len();
    assert_eq!((planes, told), (3, depthplanes::methods::default().stages.to_vec()));
}

#[test]
fn bends_of_an_enlarged_map_are_reported_on_it() {
    // A column 0.5 m thick before a wall.
    let at = |u: usize, v: usize| {
        let x = (u as f64 - 79.5) / 144.0;
        let (a, b, c) = (x * x + 1.0, -2.0 * 1.5, 1.5 * 1.5 - 0.25);
        let root = b * b - 4.0 * a * c;
        let z = if root > 0.0 { (-b - root.sqrt()) / (2.0 * a) } else { 2.0 + 0.002 * v as f64 };
        (1e3 * z + ((u * 7919 + v * 104_729) % 7) as f64 - 3.0).round() as u16
    };
    let source: Vec<u16> = (0..SIZE[0] * SIZE[1]).map(|place| at(place % SIZE[0], place / SIZE[0])).collect();
    let right = detect(&mut Detector::default().curved(true), &source, SIZE).curved.unwrap();
    assert!(!right.regions.is_empty());
    let (pixels, size) = enlarged(&source, [3.0, 3.0]);
    let params = Planar::default().min_pixels(900);
    let found = detect(&mut Detector::new(params).unwrap().curved(true), &pixels, size).curved.unwrap();
    assert_eq!(found.regions.len(), right.regions.len());
    for (at, &label) in found.labels.iter().enumerate() {
        assert_eq!(label, right.labels[source_of(at, size[0], [3.0, 3.0])]);
    }
}

#[test]
fn a_pixel_of_an_enlarged_map_is_explained_by_that_of_its_source() {
    let (pixels, [width, height]) = enlarged(&room(), [2.5, 2.5]);
    let view = DepthView::new(&pixels, width, height).unwrap();
    let mut detector = Detector::default().sensor(sensor([2.5, 2.5]));
    let found = detector.detect(view).unwrap().clone();
    for at in [[3, 5], [210, 290], [399, 150]] {
        let why = detector.explain(view, at).unwrap();
        let label = found.labels[at[1] * width + at[0]];
        let said = match why.verdict {
            depthplanes::explanation::Verdict::Plane { label, pixels, .. } => (label, pixels),
            other => panic!("{other:?}"),
        };
        assert_eq!((why.at, said), (at, (label, found.planes[usize::from(label) - 1].pixel_count)));
        assert!(why.findings[0].subject.contains("column"), "{:?}", why.findings[0]);
    }
    // All planes are too small: a smaller `min-pixels` is suggested, in pixels of this map.
    let mut detector = Detector::new(Planar::default().min_pixels(200_000)).unwrap();
    let why = detector.explain(view, [3, 5]).unwrap();
    assert_eq!(why.verdict.kind(), "small");
    let (name, min) = why.suggestions[0].parameters[0];
    let mut detector = Detector::new(Planar::default().min_pixels(min as u32)).unwrap();
    assert_eq!(name, "min-pixels");
    assert!(detector.detect(view).unwrap().labels[5 * width + 3] > 0, "{min}");
}
