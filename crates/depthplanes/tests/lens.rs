//! Planes behind lenses that distort: labels of the map's own pixels, metres as a pinhole camera would give them.

use depthplanes::{
    Coplanar, DepthView, Detector, Distortion, DistortionModel, HessianNormalForm, Intrinsics, Planar, Sensor,
    ValueKind,
};
use depthplanes::{describe_labels, outline::Outliner};

const WIDTH: usize = 320;
const HEIGHT: usize = 288;

/// A wall turned by a tenth, a floor and a side wall that stands at an angle, camera coordinates.
fn room() -> [HessianNormalForm; 3] {
    let unit = |n: [f64; 3]| {
        let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
        n.map(|x| x / length)
    };
    [([0.1, 0.2, -1.0], 4.0), ([0.05, -0.98, -0.2], 1.2), ([1.0, 0.1, -0.3], 1.5)]
        .map(|(normal, distance)| HessianNormalForm { normal: unit(normal), distance })
}

/// Depth in metres of each pixel and the number of its plane from 1, along the true rays.
fn seen(sensor: &Sensor) -> (Vec<f64>, Vec<u16>) {
    seen_in(&room(), sensor)
}

fn seen_in(planes: &[HessianNormalForm; 3], sensor: &Sensor) -> (Vec<f64>, Vec<u16>) {
    let pixel = |at: usize| {
        let Some(ray) = sensor.ray((at % WIDTH) as f64, (at / WIDTH) as f64) else { return (0.0, 0) };
        let depth = |plane: &HessianNormalForm| -plane.distance / (0..3).map(|i| plane.normal[i] * ray[i]).sum::<f64>();
        let all = planes.map(|plane| depth(&plane)).map(|depth| if depth > 0.0 { depth } else { f64::MAX });
        let nearest = (0..3).min_by(|&a, &b| all[a].total_cmp(&all[b])).unwrap();
        (all[nearest], nearest as u16 + 1)
    };
    (0..WIDTH * HEIGHT).map(pixel).unzip()
}

fn lenses() -> Vec<(Sensor, &'static str)> {
    use DistortionModel::*;
    let made = [
        (252.0, BrownConrady, &[-0.05][..], "slight barrel"),
        (252.0, BrownConrady, &[-0.28, 0.09, 1e-3, -5e-4, -0.01], "strong barrel"),
        (252.0, BrownConrady, &[0.12, -0.05, 0.0, 0.0, 0.0], "pincushion"),
        (252.0, BrownConrady, &[6.084, 4.375, -5.5e-5, 6.5e-5, 0.236, 6.409, 6.418, 1.220], "Azure Kinect"),
        (170.0, KannalaBrandt, &[-0.013, 0.02, -0.02, 0.007], "fisheye"),
        (252.0, InverseBrownConrady, &[-0.056, 0.068, -7e-4, -2.5e-5, -0.022], "RealSense"),
        (252.0, ModifiedBrownConrady, &[0.14, -0.1, 1e-3, -2e-3, 0.0], "modified"),
    ];
    let sensor = |(focal, model, coefficients, name)| {
        let camera = Intrinsics::new(focal, focal, 159.5, 143.5).unwrap();
        (Sensor::default().intrinsics(camera).distortion(Distortion::new(model, coefficients).unwrap()), name)
    };
    made.into_iter().map(sensor).collect()
}

fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 53) as f64
}

/// The map in millimetres with a noise of `growth` z^2, and the truth.
fn map(sensor: &Sensor, growth: f64) -> (Vec<u16>, Vec<u16>) {
    let (depth, truth) = seen(sensor);
    let mut seed = 7;
    let noisy = |z: f64| {
        let normal: f64 = (0..12).map(|_| random(&mut seed)).sum::<f64>() - 6.0;
        let z = z + normal * growth * z * z;
        if z < 60.0 { (1000.0 * z).round() as u16 } else { 0 }
    };
    (depth.into_iter().map(noisy).collect(), truth)
}

#[test]
fn planes_behind_a_lens_are_those_of_the_room() {
    for (sensor, name) in lenses() {
        for growth in [0.0, 1e-3] {
            let (pixels, truth) = map(&sensor, growth);
            let mut detector = Detector::new(Planar::default()).unwrap().sensor(sensor);
            let found = detector.detect(DepthView::new(&pixels, WIDTH, HEIGHT).unwrap()).unwrap();
            assert_eq!(found.planes.len(), 3, "{name} {growth}");
            let mut right = 0;
            for plane in &found.planes {
                let own = found.labels.iter().zip(&truth).filter(|(label, _)| **label == plane.label);
                let mut votes = [0; 4];
                own.for_each(|(_, truth)| votes[usize::from(*truth)] += 1);
                let best = (1..4).max_by_key(|&at| votes[at]).unwrap();
                right += votes[best];
                assert_eq!(plane.pixel_count, votes.iter().sum::<usize>(), "{name}");
                let (true_plane, given) = (room()[best - 1], plane.metric.unwrap().plane);
                let cosine: f64 = (0..3).map(|i| true_plane.normal[i] * given.normal[i]).sum();
                assert!(cosine > 0.9998, "{name} {growth}: {given:?}");
                assert!((given.distance / true_plane.distance - 1.0).abs() < 0.01, "{name} {growth}: {given:?}");
            }
            let valid = pixels.iter().filter(|&&value| value > 0).count();
            println!("{name} {growth}: {:.4}", right as f64 / valid as f64);
            assert!(right as f64 > 0.95 * valid as f64, "{name} {growth}: {right} of {valid}");
            assert_eq!(found.valid_pixels, valid);
            assert!(found.labels.iter().zip(&pixels).all(|(&label, &value)| label == 0 || value > 0));
        }
    }
}

/// Eighths of a pixel of disparity of a rig of 43.5 pixels times metres, in millimetres: steps of 46 mm at 4 m.
#[test]
fn planes_in_coarse_steps_behind_a_lens_are_those_of_the_room() {
    for (sensor, name) in lenses() {
        let (depth, _) = seen(&sensor);
        let stepped =
            |z: &f64| if *z < 20.0 { (1000.0 * 43.5 * 8.0 / (43.5 * 8.0 / z).round()).round() as u16 } else { 0 };
        let pixels: Vec<u16> = depth.iter().map(stepped).collect();
        let mut detector = Detector::default().sensor(sensor);
        let found = detector.detect(DepthView::new(&pixels, WIDTH, HEIGHT).unwrap()).unwrap();
        println!("{name}: {} planes, {:.4}", found.planes.len(), found.labelled_share());
        assert_eq!(found.planes.len(), 3, "{name}");
        assert!(found.labelled_share() > 0.9, "{name}: {}", found.labelled_share());
        for plane in room() {
            let near = |given: f64| (given / plane.distance - 1.0).abs() < 0.02;
            assert!(found.planes.iter().any(|found| near(found.distance_m().unwrap())), "{name}: {plane:?}");
        }
    }
}

#[test]
fn a_lens_of_zeros_changes_nothing() {
    let (sensor, _) = lenses()[0];
    let plain = sensor.distortion(None);
    let (pixels, _) = map(&plain, 1e-3);
    let zeros = plain.distortion(Distortion::new(DistortionModel::BrownConrady, &[0.0; 5]).unwrap());
    let view = || DepthView::new(&pixels, WIDTH, HEIGHT).unwrap();
    let [a, b] = [plain, zeros].map(|sensor| Detector::default().sensor(sensor).detect(view()).unwrap().clone());
    assert_eq!(a, b);
    assert_eq!(plain.ray(3.0, 4.0), plain.intrinsics.map(|camera| camera.ray(3.0, 4.0)));
}

#[test]
fn labels_do_not_depend_on_threads_and_the_memory_is_reused_from_size_to_size() {
    let (sensor, _) = lenses()[1];
    let (pixels, _) = map(&sensor, 1e-3);
    let view = DepthView::new(&pixels, WIDTH, HEIGHT).unwrap();
    let once = Detector::default().sensor(sensor).detect(view).unwrap().clone();
    let mut detector = Detector::default().sensor(sensor).threads(3);
    let small = DepthView::with_stride(&pixels[..WIDTH * 200], 200, 200, WIDTH).unwrap();
    for _ in 0..2 {
        detector.detect(small).unwrap();
        assert_eq!(*detector.detect(view).unwrap(), once);
    }
}

#[test]
fn explanations_curved_surfaces_parts_and_outlines_are_of_the_maps_pixels() {
    let (sensor, _) = lenses()[1];
    let (mut pixels, _) = map(&sensor, 5e-4);
    // A gap through the picture parts its planes.
    pixels
        .iter_mut()
        .enumerate()
        .filter(|(at, _)| (140..170).contains(&(at % WIDTH)))
        .for_each(|(_, value)| *value = 0);
    let view = DepthView::new(&pixels, WIDTH, HEIGHT).unwrap();
    let mut detector = Detector::default().sensor(sensor).curved(true);
    let apart = detector.detect(view).unwrap().clone();
    for at in [[20, 40], [60, 280], [300, 150], [150, 20]] {
        let label = apart.labels[at[1] * WIDTH + at[0]];
        let why = detector.explain(view, at).unwrap();
        assert_eq!(why.at, at);
        match why.verdict {
            depthplanes::explanation::Verdict::Plane { label: given, .. } => assert_eq!(given, label),
            _ => assert_eq!(label, 0),
        }
    }
    let mut joining = Detector::default().sensor(sensor).merge_coplanar(Coplanar::default()).unwrap();
    let joined = joining.detect(view).unwrap().clone();
    assert!(joined.planes.len() < apart.planes.len() && !joined.parts.is_empty());
    for plane in joined.planes.iter().filter(|plane| !joined.parts_of(plane.label).is_empty()) {
        let parts = joined.parts_of(plane.label).iter().map(|part| part.plane.pixel_count);
        assert_eq!(parts.sum::<usize>(), plane.pixel_count);
    }
    let curved = apart.curved.unwrap();
    assert!(curved.labels.iter().zip(&apart.labels).all(|(&a, &b)| a == 0 || b == 0));
    let mut outliner = Outliner::default();
    let outlines = outliner.outline_seen_by(&joined, &sensor).unwrap();
    for plane in &joined.planes {
        let equation = plane.metric.unwrap().plane;
        let outline = outlines.get(plane.label).unwrap();
        for polygon in outline.polygons() {
            let corners = polygon.outer().points_px().zip(polygon.outer().points_m().unwrap());
            for ([u, v], point) in corners {
                let off: f64 = (0..3).map(|i| equation.normal[i] * point[i]).sum::<f64>() + equation.distance;
                assert!(off.abs() < 1e-9);
                let ray = sensor.ray(u, v).unwrap();
                assert!((point[0] / point[2] - ray[0]).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn planes_of_a_label_image_are_described_by_true_rays() {
    let (sensor, _) = lenses()[1];
    let (pixels, truth) = map(&sensor, 0.0);
    let (found, names) = describe_labels(DepthView::new(&pixels, WIDTH, HEIGHT).unwrap(), &truth, &sensor).unwrap();
    assert_eq!(found.planes.len(), 3);
    for (plane, name) in found.planes.iter().zip(names) {
        let (right, given) = (room()[usize::from(name) - 1], plane.metric.unwrap().plane);
        assert!((given.distance / right.distance - 1.0).abs() < 0.005, "{given:?} {right:?}");
        assert_eq!(plane.pixel_count, found.labels.iter().filter(|&&label| label == plane.label).count());
    }
}

#[test]
fn disparities_and_floats_behind_a_lens_have_the_same_planes() {
    let (sensor, _) = lenses()[1];
    let (depth, _) = seen(&sensor);
    let far = |z: f64| z > 60.0;
    let metres: Vec<f32> = depth.iter().map(|&z| if far(z) { f32::NAN } else { z as f32 }).collect();
    let of_metres = sensor.value_kind(ValueKind::depth(1.0).unwrap());
    let found = Detector::default()
        .sensor(of_metres)
        .detect(DepthView::new(&metres, WIDTH, HEIGHT).unwrap())
        .unwrap()
        .planes
        .len();
    assert_eq!(found, 3);
    let disparities: Vec<u16> = depth.iter().map(|&z| if far(z) { 0 } else { (25_600.0 / z).round() as u16 }).collect();
    let of_disparity = sensor.value_kind(ValueKind::InverseDepth { slope: 1.0 / 25_600.0, offset: 0.0 });
    let mut detector = Detector::default().sensor(of_disparity);
    let found = detector.detect(DepthView::new(&disparities, WIDTH, HEIGHT).unwrap()).unwrap();
    assert_eq!(found.planes.len(), 3);
    assert!(found.planes.iter().any(|plane| (plane.distance_m().unwrap() - 1.2).abs() < 0.012));
}

/// A map of metres without noise whose planes bend by up to half a pixel's slant if its border is not resampled as the rest:
/// the border of the map, or that of missing columns and rows.
#[test]
fn no_false_plane_lies_along_the_border_of_the_map_or_of_a_gap() {
    let mut seed = 11;
    for (sensor, name) in lenses().into_iter().filter(|(_, name)| *name != "fisheye") {
        for round in 0..6 {
            let mut camera = sensor.intrinsics.unwrap();
            camera.cx += 60.0 * (random(&mut seed) - 0.5);
            camera.cy += 60.0 * (random(&mut seed) - 0.5);
            let sensor = sensor.intrinsics(camera).value_kind(ValueKind::depth(1.0).unwrap());
            let is_gap = |at: usize| round % 2 == 1 && (at % WIDTH < 37 || at / WIDTH > 270);
            let near = |(at, z): (usize, f64)| if z > 40.0 || is_gap(at) { 0.0 } else { z as f32 };
            let turned = room().map(|plane| {
                let normal = plane.normal.map(|n| n + 0.4 * (random(&mut seed) - 0.5));
                let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
                HessianNormalForm {
                    normal: normal.map(|x| x / length),
                    distance: plane.distance * (0.6 + random(&mut seed)),
                }
            });
            let (depth, truth) = seen_in(&turned, &sensor);
            let pixels: Vec<f32> = depth.into_iter().enumerate().map(near).collect();
            let mut detector = Detector::default().sensor(sensor);
            let found = detector.detect(DepthView::new(&pixels, WIDTH, HEIGHT).unwrap()).unwrap();
            let count = |label: u16| (0..WIDTH * HEIGHT).filter(|&at| truth[at] == label && pixels[at] > 0.0).count();
            let visible = (1..=3).filter(|&label| count(label) > 200).count();
            assert!(found.planes.len() <= visible, "{name} {round}: {} of {visible}", found.planes.len());
            assert!(found.labelled_share() > 0.98, "{name} {round}: {}", found.labelled_share());
        }
    }
}
