//! What `Detector::explain` says is true: labels, refusals, and above all its suggestions.

use depthplanes::explanation::Verdict;
use depthplanes::methods::{METHODS, MethodInfo, find};
use depthplanes::scene::{Random, SceneFrame, Spec};
use depthplanes::{DepthView, Detection, Detector, Error, Planar};

fn scene(spec: &str) -> SceneFrame {
    spec.parse::<Spec>().unwrap().frame().unwrap()
}

fn detector(method: &'static MethodInfo, given: &[(&str, f64)], frame: &SceneFrame) -> Detector {
    Detector::new(method.with(given).unwrap()).unwrap().sensor(frame.sensor)
}

fn detector_of(name: &str, given: &[(&str, f64)], frame: &SceneFrame) -> Detector {
    detector(find(name).unwrap(), given, frame)
}

const SCENES: [&str; 6] = [
    "room:seed=2,sensor=tof_white,size=320x240",
    "random:seed=301,sensor=kinect_white,size=320x240",
    "random:seed=302,sensor=tof_white,size=320x240",
    "curved:sensor=kinect_white,size=320x240",
    "boxes:seed=4,sensor=clean_mm,size=320x240",
    "room:seed=7,sensor=disparity,size=320x240",
];

/// The methods that explain themselves.
const EXPLAINING: [&str; 2] = ["planar", "ngaf"];

/// Pixels of a scene, most of them without a plane, since those are what explanations are for.
fn pixels(found: &Detection, random: &mut Random, count: usize) -> Vec<[usize; 2]> {
    let mut pixels = Vec::new();
    while pixels.len() < count {
        let at = (random.uniform() * found.labels.len() as f64) as usize;
        if found.labels[at] == 0 || pixels.len() % 8 == 0 {
            pixels.push([at % found.width, at / found.width]);
        }
    }
    pixels
}

#[test]
fn every_suggestion_works_and_every_label_is_that_of_the_detection() {
    for method in METHODS {
        let (mut random, mut asked, mut helped, mut suggestions) = (Random::new(11), 0, 0, 0);
        let mut kinds: Vec<(&str, usize)> = Vec::new();
        for spec in SCENES {
            let frame = scene(spec);
            let mut asked_of = detector(method, &[], &frame);
            let found = asked_of.detect(frame.view()).unwrap().clone();
            // One that explains nothing looks for planes all the same.
            let count = if EXPLAINING.contains(&method.name) { 40 } else { 1 };
            for at in pixels(&found, &mut random, count) {
                let why = asked_of.explain(frame.view(), at).unwrap();
                let label = found.labels[at[1] * found.width + at[0]];
                if let Verdict::Off { off, most, .. } = why.verdict {
                    assert!(off > most, "{spec} {at:?}: {why:?}");
                }
                match why.verdict {
                    Verdict::Plane { label: told, pixels, .. } => {
                        assert_eq!((told, pixels), (label, found.planes[usize::from(label) - 1].pixel_count));
                        assert!(why.suggestions.is_empty());
                    }
                    Verdict::Unexplained { label: told } => assert_eq!(told, label),
                    _ => {
                        assert_eq!(label, 0, "{spec} {at:?}: {}", why.verdict);
                        asked += 1;
                        helped += usize::from(!why.suggestions.is_empty());
                    }
                }
                match kinds.iter_mut().find(|(kind, _)| *kind == why.verdict.kind()) {
                    Some((_, count)) => *count += 1,
                    None => kinds.push((why.verdict.kind(), 1)),
                }
                for suggestion in &why.suggestions {
                    let mut changed = detector(method, &suggestion.parameters, &frame);
                    let after = changed.detect(frame.view()).unwrap();
                    let label = after.labels[at[1] * after.width + at[0]];
                    assert!(label > 0, "{spec} {at:?}: {suggestion:?}");
                    assert_eq!(after.planes[usize::from(label) - 1].pixel_count, suggestion.plane_pixels);
                    assert_eq!(
                        (found.planes.len(), after.planes.len()),
                        (suggestion.planes_before, suggestion.planes_after)
                    );
                    suggestions += 1;
                }
            }
        }
        println!(
            "{}: {suggestions} suggestions for {helped} of {asked} pixels without a plane; {kinds:?}",
            method.name
        );
        let explains = kinds.iter().any(|(kind, _)| *kind != "unexplained");
        assert_eq!(explains, EXPLAINING.contains(&method.name), "{}", method.name);
        assert!(!explains || suggestions > 20, "{}: {suggestions}", method.name);
    }
}

#[test]
fn explaining_changes_nothing_of_the_next_detection() {
    let frame = scene("random:seed=301,sensor=kinect_white,size=320x240");
    for method in METHODS {
        let mut detector = detector(method, &[], &frame);
        let before = detector.detect(frame.view()).unwrap().clone();
        detector.explain(frame.view(), [100, 100]).unwrap();
        assert_eq!(&before, detector.detect(frame.view()).unwrap());
    }
}

#[test]
fn a_pixel_outside_is_refused_with_the_range() {
    let map = [1000u16; 64];
    let mut detector = Detector::new(Planar::default()).unwrap();
    let error = detector.explain(DepthView::new(&map, 8, 8).unwrap(), [8, 0]).unwrap_err();
    assert_eq!(error, Error::Pixel { at: [8, 0], width: 8, height: 8 });
    assert_eq!(error.to_string(), "pixel 8,0 is outside of the map; accepted: columns 0 to 7, rows 0 to 7");
}

#[test]
fn each_reason_is_told() {
    // A wall about 1 m away with a small patch nearer, a hole, and a pixel that flies.
    let (width, height) = (96, 64);
    let mut map: Vec<u16> = (0..width * height).map(|at| (1000 + at % width / 8) as u16).collect();
    for v in 16..24 {
        map[v * width + 16..][..8].fill(700);
    }
    map[40 * width + 70] = 0;
    map[50 * width + 50] = 1030;
    let view = DepthView::new(&map, width, height).unwrap();
    let planar = Planar::default().noise(0.002);
    let mut detector = Detector::new(planar).unwrap();
    let mut kind = |at| detector.explain(view, at).unwrap().verdict.kind();
    assert_eq!(
        [kind([5, 5]), kind([20, 20]), kind([70, 40]), kind([50, 50])],
        ["plane", "small", "not_measured", "off"]
    );

    let frame = scene("boxes:seed=4,sensor=kinect_white,size=320x240");
    let small = detector_of("planar", &[("min-area", 0.1)], &frame).explain(frame.view(), [40, 200]).unwrap();
    let large = detector_of("planar", &[("min-area", 50.0)], &frame).explain(frame.view(), [40, 200]).unwrap();
    assert_eq!((small.verdict.kind(), large.verdict.kind()), ("plane", "dropped"), "{small:?}");
    assert_eq!(large.suggestions[0].parameters[0].0, "min-area");

    let ngaf = find("ngaf").unwrap();
    for (given, at, right) in [
        (("min-pixels", 32.0), [20, 20], "plane"),
        (("min-pixels", 64.0), [20, 20], "small"),
        (("min-fill", 1.0), [5, 5], "dropped"),
        (("margin", 20.0), [20, 20], "dropped"),
        (("theta", 1.0), [70, 40], "not_measured"),
    ] {
        let mut detector = Detector::new(ngaf.with(&[given]).unwrap()).unwrap();
        let why = detector.explain(view, at).unwrap();
        assert_eq!(why.verdict.kind(), right, "{given:?} {at:?}");
        assert!(right == "plane" || !why.suggestions.is_empty(), "{given:?} {at:?}");
    }
}
