//! Surfaces that bend: how often a flat one is called so, how often a curved one is, and what is reported of them.

use depthplanes::explanation::Explanation;
use depthplanes::methods::METHODS;
use depthplanes::noise::SensorNoise;
use depthplanes::scene::{Camera, Place, Pose, Random, Scene, SceneFrame, SensorModel, Spec, render};
use depthplanes::{DepthView, Detector, Error, Planar, Sensor, ValueKind};

fn scene(spec: &str) -> SceneFrame {
    spec.parse::<Spec>().unwrap().frame().unwrap()
}

const WIDTH: usize = 320;
const HEIGHT: usize = 240;
/// Disparity, map units.
const SIGMA: f64 = 0.5;

/// A normal number.
fn normal(random: &mut Random) -> f64 {
    // Of twelve uniform numbers; its tails end at six deviations.
    (0..12).map(|_| random.uniform()).sum::<f64>() - 6.0
}

/// A map with noise, of a function that is NaN where nothing is measured.
fn noisy(random: &mut Random, of: impl Fn(usize, usize) -> f64) -> Vec<f32> {
    (0..WIDTH * HEIGHT).map(|at| (of(at % WIDTH, at / WIDTH) + SIGMA * normal(random)) as f32).collect()
}

/// How many flat regions there are and how many of them are called curved, by the sign that tells.
#[derive(Default, Debug)]
struct Alarms {
    flat: usize,
    bow: usize,
    joint: usize,
    around: usize,
}

impl Alarms {
    /// Looks at a map of flat patches, each known by a pixel in its middle.
    fn add(&mut self, map: &[f32], middles: &[[usize; 2]]) {
        let view = DepthView::new(map, WIDTH, HEIGHT).unwrap();
        let noise = Some(SensorNoise::Value { sigma: SIGMA });
        let sensor = Sensor::default().value_kind(ValueKind::Disparity).noise(noise);
        let mut detector = Detector::new(Planar::default()).unwrap().sensor(sensor).curved(true);
        let found = detector.detect(view).unwrap().clone();
        let labels = found.curved.as_ref().unwrap();
        self.flat += middles.len();
        for &at in middles {
            if labels.labels[at[1] * WIDTH + at[0]] > 0 {
                self.count(&detector.explain(view, at).unwrap());
            }
        }
    }

    fn count(&mut self, why: &Explanation) {
        let told = why.findings.iter().find(|finding| finding.outcome.starts_with("curved: "));
        match told.map(|finding| finding.outcome.as_str()) {
            Some(outcome) if outcome.contains("bows") => self.bow += 1,
            Some(outcome) if outcome.contains("neighbour") => self.joint += 1,
            _ => self.around += 1,
        }
    }

    fn all(&self) -> usize {
        self.bow + self.joint + self.around
    }
}

/// Flat squares with nothing between them.
fn squares(random: &mut Random, side: usize, alarms: &mut Alarms) {
    let pitch = side + 8;
    let (columns, rows) = (WIDTH / pitch, HEIGHT / pitch);
    let planes: Vec<[f64; 3]> = (0..columns * rows)
        .map(|_| [random.between(-0.4, 0.4), random.between(-0.4, 0.4), random.between(100.0, 300.0)])
        .collect();
    let map = noisy(random, |u, v| {
        let (column, row) = (u / pitch, v / pitch);
        if column >= columns || row >= rows || u % pitch >= side || v % pitch >= side {
            return f64::NAN;
        }
        let [a, b, c] = planes[row * columns + column];
        a * (u % pitch) as f64 + b * (v % pitch) as f64 + c
    });
    let middle = |at: usize| [at % columns * pitch + side / 2, at / columns * pitch + side / 2];
    alarms.add(&map, &(0..columns * rows).map(middle).collect::<Vec<_>>());
}

/// Roofs of two flat halves, `width` columns each, whose ridge is `height` noise deviations above their eaves.
fn roofs(random: &mut Random, width: usize, height: f64, alarms: &mut Alarms) {
    let (pitch, rows) = (2 * width + 8, HEIGHT / 48);
    let columns = WIDTH / pitch;
    let slants: Vec<[f64; 3]> = (0..columns * rows)
        .map(|_| [random.between(-0.4, 0.4), random.between(-0.4, 0.4), random.between(100.0, 300.0)])
        .collect();
    let per_column = height * SIGMA / width as f64;
    let map = noisy(random, |u, v| {
        let (column, row) = (u / pitch, v / 48);
        if column >= columns || row >= rows || u % pitch >= 2 * width || v % 48 >= 40 {
            return f64::NAN;
        }
        let [a, b, c] = slants[row * columns + column];
        let from_ridge = (u % pitch) as f64 - width as f64 + 0.5;
        a * (u % pitch) as f64 + b * (v % 48) as f64 + c - per_column * from_ridge.abs()
    });
    let halves = |at: usize| {
        let [first, row] = [at % columns * pitch, at / columns * 48 + 20];
        [[first + width / 2, row], [first + width + width / 2, row]]
    };
    alarms.add(&map, &(0..columns * rows).flat_map(halves).collect::<Vec<_>>());
}

#[test]
fn flat_regions_are_rarely_called_curved() {
    let mut random = Random::new(21);
    for side in [12, 16, 24, 32, 64] {
        let mut alarms = Alarms::default();
        while alarms.flat < 2000 {
            squares(&mut random, side, &mut alarms);
        }
        println!("squares of {side} x {side}: {alarms:?}");
        assert!(alarms.all() <= 2, "{side}: {alarms:?}");
    }
    for width in [16, 32, 64] {
        for height in [4.0, 8.0, 16.0, 32.0, 64.0] {
            let mut alarms = Alarms::default();
            while alarms.flat < 1000 {
                roofs(&mut random, width, height, &mut alarms);
            }
            println!("roofs of halves {width} wide, {height} deviations high: {alarms:?}");
            // A lower one is no more than a bend of the surface.
            assert!(height < 16.0 || alarms.all() <= 2, "{width} {height}: {alarms:?}");
        }
    }
}

#[test]
fn most_of_balls_and_columns_is_reported() {
    let kinect = Some(SensorNoise::Depth { base: 0.0, growth: 1.425e-3 });
    for (sensor, noise) in [("kinect_white", kinect), ("tof_white", None), ("clean_mm", None)] {
        let (mut curved, mut told, mut flat, mut false_told, mut as_planes) = (0, 0, 0, 0, 0);
        let specs = (201..=210).map(|seed| format!("random:seed={seed},sensor={sensor}"));
        for spec in specs.chain([1, 2, 3].map(|seed| format!("curved:seed={seed},sensor={sensor}"))) {
            let mut frame = scene(&spec);
            frame.sensor.noise = noise;
            let mut detector = Detector::new(Planar::default()).unwrap().sensor(frame.sensor).curved(true);
            let found = detector.detect(frame.view()).unwrap();
            let labels = &found.curved.as_ref().unwrap().labels;
            for (at, &surface) in frame.truth.surfaces.iter().enumerate() {
                if surface == 0 || frame.value(at) <= 0.0 || frame.value(at).is_nan() {
                    continue;
                }
                if frame.truth.curved[surface as usize - 1] {
                    curved += 1;
                    told += usize::from(labels[at] > 0);
                    as_planes += usize::from(found.labels[at] > 0);
                } else {
                    flat += 1;
                    false_told += usize::from(labels[at] > 0);
                }
            }
        }
        let share = |part: usize, whole: usize| part as f64 / whole as f64;
        let (rate, false_rate) = (share(told, curved), share(false_told, flat));
        println!(
            "{sensor}: {:.1} % of the curved pixels reported, {:.1} % on planes; {:.2} % of the flat ones reported",
            100.0 * rate,
            100.0 * share(as_planes, curved),
            100.0 * false_rate
        );
        assert!(rate > 0.72 && false_rate < 0.01, "{sensor}: {rate} {false_rate}");
    }
}

#[test]
fn curved_regions_are_as_their_labels_say_and_planes_stay_the_same() {
    let frame = scene("curved:sensor=kinect_white,size=320x240");
    let detect = |curved: bool| {
        let mut detector = Detector::new(Planar::default()).unwrap().sensor(frame.sensor).curved(curved);
        detector.detect(frame.view()).unwrap();
        detector.detect(frame.view()).unwrap().clone() // as after the first frame
    };
    let (with, without) = (detect(true), detect(false));
    assert_eq!((&with.labels, &with.planes), (&without.labels, &without.planes));
    assert!(without.curved.is_none());
    let curved = with.curved.unwrap();
    assert!(curved.regions.len() > 3);
    assert_eq!(curved.labels.len(), with.labels.len());
    assert!(curved.labels.iter().zip(&with.labels).all(|(&curved, &plane)| curved == 0 || plane == 0));
    for (label, region) in (1..).zip(&curved.regions) {
        assert_eq!(region.label, label);
        let own: Vec<usize> = (0..curved.labels.len()).filter(|&at| curved.labels[at] == label).collect();
        assert_eq!(own.len(), region.pixel_count);
        assert!(region.pixel_count > 100);
        let columns = || own.iter().map(|at| (at % with.width) as u32);
        let bounds = region.bounding_box;
        assert_eq!((columns().min(), columns().max()), (Some(bounds.u_min), Some(bounds.u_max)));
    }
    let counts: Vec<usize> = curved.regions.iter().map(|region| region.pixel_count).collect();
    assert!(counts.is_sorted_by(|a, b| a >= b));
}

#[test]
fn curved_surfaces_of_a_method_that_does_not_tell_them_are_an_error() {
    let frame = scene("curved:sensor=clean_mm,size=160x120");
    for method in METHODS {
        let mut detector = Detector::new(*method).unwrap().sensor(frame.sensor).curved(true);
        match detector.detect(frame.view()) {
            Ok(found) => assert!(method.tells_curved && found.curved.is_some()),
            Err(error) => {
                assert_eq!(error, Error::NoCurved { method: method.name, accepted: "planar".to_string() });
                assert!(error.to_string().contains(method.name) && error.to_string().contains("accepted: planar"));
            }
        }
        let mut detector = Detector::new(*method).unwrap().sensor(frame.sensor);
        assert!(detector.detect(frame.view()).unwrap().curved.is_none());
    }
}

#[test]
fn no_pixel_is_both_curved_and_in_a_plane() {
    for seed in 0..60 {
        let mut random = Random::new(seed);
        let (width, height) = (random.whole(20, 90), random.whole(20, 70));
        let [cu, cv, radius] = [width as f64, height as f64, 60.0].map(|most| random.between(8.0, most));
        let noise = [0.0, 3.0, 40.0][random.whole(0, 2)];
        let value = |at: usize, random: &mut Random| {
            let (u, v) = ((at % width) as f64 - cu, (at / width) as f64 - cv);
            let ball = (1.0 - (u * u + v * v) / (radius * radius)).max(0.0).sqrt();
            let gap = u.abs() < 1.0 || random.uniform() < 0.02;
            if gap { 0 } else { (2000.0 - 400.0 * ball + noise * random.gaussian()) as u16 }
        };
        let map: Vec<u16> = (0..width * height).map(|at| value(at, &mut random)).collect();
        let view = DepthView::new(&map, width, height).unwrap();
        for (scale, threshold) in [(1.0, 3.0), (0.02, 0.6), (0.1, 20.0)] {
            let planar = Planar::default().min_pixels(3).noise_scale(scale).inlier_threshold(threshold);
            let mut detector = Detector::new(planar).unwrap().curved(true);
            let found = detector.detect(view).unwrap();
            let curved = &found.curved.as_ref().unwrap().labels;
            let both = curved.iter().zip(&found.labels).filter(|(curved, plane)| **curved > 0 && **plane > 0);
            assert_eq!(both.count(), 0, "seed {seed}, noise scale {scale}");
        }
    }
}

/// Segments around a sphere as people model them, the fewest.
const SEGMENTS: usize = 16;

/// Adds a dome of flat quads, a mesh of half a sphere; how many there are.
fn dome(scene: &mut Scene, place: Place, radius: f64) -> usize {
    let step = std::f64::consts::TAU / SEGMENTS as f64;
    let corner = |ring: usize, segment: usize| {
        let (up, around) = (ring as f64 * step, segment as f64 * step);
        [radius * up.cos() * around.cos(), radius * up.cos() * around.sin(), radius * up.sin()]
    };
    let rings = SEGMENTS / 4;
    for (ring, segment) in (0..rings).flat_map(|ring| (0..SEGMENTS).map(move |segment| (ring, segment))) {
        let [foot, top] = [ring, ring + 1].map(|ring| [corner(ring, segment), corner(ring, segment + 1)]);
        // The last ring's quads are triangles: their upper corners are the pole.
        let corners = [foot[0], foot[1], top[1], top[0]];
        scene.facet_at(place, &corners[..if ring + 1 == rings { 3 } else { 4 }]);
    }
    rings * SEGMENTS
}

#[test]
fn a_dome_of_flat_facets_is_no_planes_and_a_box_beside_it_keeps_its_faces() {
    for (sensor, distance, yaw) in [
        (SensorModel::Clean, 2.0, 0.0),
        (SensorModel::Clean, 2.6, 7.0),
        (SensorModel::CleanMm, 2.0, 11.25),
        (SensorModel::CleanMm, 2.6, 3.0),
    ] {
        let mut scene = Scene::default();
        scene.facet(&[[-5.0, 0.1, 0.0], [5.0, 0.1, 0.0], [5.0, 6.0, 0.0], [-5.0, 6.0, 0.0]]);
        let facets = dome(&mut scene, Place::at(-0.45, distance).turned(yaw), 0.4);
        scene.block(Place::at(0.45, distance).turned(30.0), [-0.25, -0.25, 0.0], [0.25, 0.25, 0.4]);
        let camera = Camera::kinect(640, 480, Pose::at_height(1.2, 30.0)).unwrap();
        let frame = render(&scene, &camera, sensor, 0).unwrap();
        let found =
            Detector::new(Planar::default()).unwrap().sensor(frame.sensor).detect(frame.view()).unwrap().clone();
        let surfaces = &frame.truth.surfaces;
        let (mut pixels, mut covered) = (vec![0; scene.surfaces.len() + 1], vec![0; scene.surfaces.len() + 1]);
        for (&surface, &label) in surfaces.iter().zip(&found.labels) {
            pixels[surface as usize] += 1;
            covered[surface as usize] += usize::from(label > 0);
        }
        let share = |surfaces: std::ops::Range<usize>| {
            let sum = |of: &[usize]| of[surfaces.clone()].iter().sum::<usize>() as f64;
            sum(&covered) / sum(&pixels)
        };
        let (of_dome, of_box) = (share(2..facets + 2), share(facets + 2..facets + 8));
        println!(
            "{sensor:?} at {distance} m: {} planes, {of_dome:.3} of the dome, {of_box:.3} of the box",
            found.planes.len()
        );
        assert!(of_dome < 0.01 && of_box > 0.98, "{sensor:?} {distance}: {of_dome} {of_box}");
        assert_eq!(found.planes.len(), 4, "the floor and three faces");
    }
}
