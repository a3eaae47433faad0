//! The contract of every row of METHODS.

mod naive;

use depthplanes::methods::{Configured, METHODS, MethodInfo, Param, ParamKind, find};
use depthplanes::{AnyView, DepthView, Detection, Detector, Error, Intrinsics, Sensor, ValueKind};
use naive::Random;
use std::collections::HashSet;
use std::panic::catch_unwind;

fn each_parameter() -> impl Iterator<Item = (&'static MethodInfo, &'static Param)> {
    METHODS.iter().flat_map(|&method| method.params.iter().map(move |param| (method, param)))
}

fn is_kebab_case(name: &str) -> bool {
    let word = |word: &str| !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit());
    name.starts_with(|c: char| c.is_ascii_lowercase()) && name.split('-').all(word)
}

/// The method with one parameter changed, by name and by place; both must agree.
#[track_caller]
fn with(method: &MethodInfo, param: &Param, value: f64) -> Result<Configured, Error> {
    let at = method.params.iter().position(|other| other.name == param.name).unwrap();
    let mut values = method.defaults();
    values[at] = value;
    let (named, placed) = (method.with(&[(param.name, value)]), method.of_values(&values));
    let text = |result: &Result<Configured, Error>| result.as_ref().err().map(Error::to_string);
    assert_eq!(text(&named), text(&placed), "{} {} = {value}", method.name, param.name);
    named
}

#[test]
fn names_are_unique_and_kebab_case() {
    let names: Vec<_> = METHODS.iter().map(|method| method.name).collect();
    assert_eq!((names[0], depthplanes::methods::default().name), ("planar", "planar"), "the default stands first");
    assert_eq!(names.iter().collect::<HashSet<_>>().len(), names.len(), "{names:?}");
    for method in METHODS {
        assert!(is_kebab_case(method.name), "{}", method.name);
        assert!(method.about.ends_with('.') && method.about.len() > 20, "{}", method.about);
        assert!(!method.stages.is_empty());
        let names: Vec<_> = method.params.iter().map(|param| param.name).collect();
        assert_eq!(names.iter().collect::<HashSet<_>>().len(), names.len(), "{names:?}");
    }
    for (method, param) in each_parameter() {
        let what = format!("{} {}", method.name, param.name);
        assert!(is_kebab_case(param.name), "{what}");
        assert!(param.meaning.ends_with('.') && !param.unit.is_empty(), "{what}");
    }
}

#[test]
fn methods_are_found_by_name() {
    for &method in METHODS {
        assert_eq!(find(method.name).unwrap().name, method.name);
        assert_eq!(method.with(&[]).unwrap().info().name, method.name);
    }
    for given in ["", "NGAF", "ngaf ", "sonar"] {
        let error = find(given).unwrap_err();
        let text = error.to_string();
        assert!(matches!(error, Error::Unknown { what: "method", .. }));
        assert!(text.contains(&format!("`{given}`")), "{text}");
        METHODS.iter().for_each(|method| assert!(text.contains(method.name), "{text}"));
    }
}

#[test]
fn an_unknown_parameter_is_an_error_that_lists_the_known_ones() {
    for method in METHODS {
        for given in ["", "Theta", "no-such-parameter"] {
            let error = method.with(&[(given, 1.0)]).expect_err("no such parameter");
            let text = error.to_string();
            assert!(matches!(error, Error::Unknown { what: "parameter", .. }));
            assert!(text.contains(&format!("`{given}`")), "{text}");
            method.params.iter().for_each(|param| assert!(text.contains(param.name), "{text}"));
        }
    }
}

#[test]
fn an_alias_is_the_parameter_and_errors_have_its_name() {
    let mut aliases = 0;
    for (method, param) in each_parameter() {
        let Some(alias) = param.alias else { continue };
        assert_eq!(method.position(alias), method.position(param.name));
        assert!(method.params.iter().all(|other| other.name != alias), "{alias} is another parameter's name");
        assert!(method.with(&[(alias, param.default)]).is_ok());
        let error = method.with(&[(alias, param.min - 1.0)]).expect_err("below the least");
        assert!(matches!(error, Error::Parameter { name, .. } if name == param.name), "{error}");
        aliases += 1;
    }
    assert_eq!(aliases, METHODS.len(), "`min` of every method");
}

#[test]
fn defaults_and_the_ends_of_ranges_are_accepted() {
    for (method, param) in each_parameter() {
        for value in [param.default, param.min, param.max] {
            let result = with(method, param, value);
            assert!(result.is_ok(), "{} {} = {value}: {:?}", method.name, param.name, result.err());
        }
        if param.kind == ParamKind::OddOrOff {
            assert!(with(method, param, 0.0).is_ok());
        }
    }
}

#[test]
fn other_values_are_refused_with_name_value_and_range() {
    for (method, param) in each_parameter() {
        let mut wrong = vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY, param.min - 1.0, -1e300];
        if param.max < f64::MAX {
            wrong.extend([param.max + 1.0, 1e300]);
        }
        match param.kind {
            ParamKind::Real => {}
            ParamKind::Whole => wrong.extend([param.min + 0.5, param.max - 0.5]),
            ParamKind::OddOrOff => wrong.extend([param.min + 0.5, param.min + 1.0, param.max - 1.0, 0.5, 1.0, 2.0]),
            kind => panic!("what is wrong for {kind:?}?"),
        }
        for value in wrong {
            if param.kind == ParamKind::OddOrOff && value == 0.0 {
                continue;
            }
            let error = with(method, param, value).err().unwrap_or_else(|| panic!("{} = {value}", param.name));
            let text = error.to_string();
            assert!(matches!(error, Error::Parameter { name, .. } if name == param.name), "{text}");
            assert!(text.contains(&format!("`{}` is {value}", param.name)), "{text}");
            assert!(text.ends_with(&param.accepted()) && text.contains(&format!("from {}", param.min)), "{text}");
        }
    }
}

#[test]
fn a_method_takes_one_value_for_each_parameter() {
    for method in METHODS {
        let right = method.params.len();
        for count in (0..right).chain([right + 1]) {
            let values: Vec<f64> = method.defaults().into_iter().chain([1.0]).take(count).collect();
            let panic = catch_unwind(move || method.of_values(&values).map(drop)).unwrap_err();
            let text = panic.downcast_ref::<String>().expect("a message");
            assert!(text.contains("one value for each parameter"), "{text}");
        }
    }
}

fn sensors() -> [Sensor; 3] {
    let intrinsics = Intrinsics::new(500.0, 500.0, 20.0, 15.0).ok();
    [
        Sensor::default(),
        Sensor::default().value_kind(ValueKind::Depth { metres: 0.001 }).intrinsics(intrinsics),
        Sensor::default().value_kind(ValueKind::stereo(1.0, 500.0, 0.1, 0.0).unwrap()).intrinsics(intrinsics),
    ]
}

/// Runs each method, by default and with all that it can do, on a map of each type.
fn run_all(map: &[u8], width: usize, check: impl Fn(&Detection, &str)) {
    let height = map.len() / width;
    let wide: Vec<u16> = map.iter().map(|&value| value.into()).collect();
    let single: Vec<f32> = map.iter().map(|&value| if value == 0 { f32::NAN } else { value.into() }).collect();
    let views: [AnyView<'_>; 3] = [
        DepthView::new(map, width, height).unwrap().into(),
        DepthView::new(&wide, width, height).unwrap().into(),
        DepthView::new(&single, width, height).unwrap().into(),
    ];
    for method in METHODS {
        let largest: Vec<f64> = method.params.iter().map(|param| param.max).collect();
        let smallest: Vec<f64> = method.params.iter().map(|param| param.min).collect();
        for values in [method.defaults(), largest, smallest] {
            for sensor in sensors() {
                let mut detector = Detector::new(method.of_values(&values).unwrap()).unwrap().sensor(sensor);
                for view in views {
                    let what = format!("{} {values:?} on {width}x{height}", method.name);
                    let found = match detector.detect(view) {
                        Err(Error::NotMetric { .. }) if sensor.intrinsics.is_none() => continue,
                        found => found.unwrap(),
                    };
                    assert_eq!((found.width, found.height, found.labels.len()), (width, height, map.len()), "{what}");
                    check(found, &what);
                }
            }
        }
    }
}

#[test]
fn the_smallest_map_works() {
    for value in [0, 1, 255] {
        run_all(&[value], 1, |found, what| {
            assert_eq!(found.valid_pixels, usize::from(value > 0), "{what}");
            assert_eq!(found.planes.len(), usize::from(found.labels[0]), "{what}");
            assert!(found.planes.iter().all(|plane| plane.fit.is_none() && plane.metric.is_none()), "{what}");
        });
    }
}

#[test]
fn maps_without_a_measurement_have_no_plane() {
    for (width, height) in [(1, 1), (64, 1), (1, 65), (40, 30)] {
        run_all(&vec![0; width * height], width, |found, what| {
            let counts = (found.planes.len(), found.valid_pixels, found.filled_pixels);
            assert_eq!(counts, (0, 0, 0), "{what}");
            assert!(found.labels.iter().all(|&label| label == 0) && found.labelled_share() == 0.0, "{what}");
        });
    }
}

#[test]
fn constant_maps_are_one_plane_or_none() {
    for (width, height) in [(64, 1), (1, 65), (40, 30), (200, 3)] {
        run_all(&vec![9; width * height], width, |found, what| {
            assert!(found.planes.len() <= 1 && found.valid_pixels == width * height, "{what}");
            for plane in &found.planes {
                assert_eq!(plane.pixel_count, width * height, "{what}");
                assert_eq!(
                    plane.fit.map(|fit| (fit.gradient, fit.offset, fit.rms)).unwrap_or(([0.0; 2], 9.0, 0.0)),
                    ([0.0; 2], 9.0, 0.0),
                    "{what}"
                );
            }
        });
    }
}

#[test]
fn the_default_of_each_method_finds_a_constant_map() {
    for method in METHODS {
        let mut detector = Detector::new(method.with(&[]).unwrap()).unwrap();
        let found = detector.detect(DepthView::new(&[9u8; 1200], 40, 30).unwrap()).unwrap();
        assert_eq!((found.planes.len(), found.labelled_share()), (1, 1.0), "{}", method.name);
    }
}

#[test]
fn the_observer_is_told_the_stages_in_order() {
    let mut random = Random(61);
    for method in METHODS {
        let mut detector = Detector::new(method.with(&[]).unwrap()).unwrap();
        for _ in 0..20 {
            let map = naive::awkward_map(&mut random, 30, 20);
            let mut told = Vec::new();
            detector.detect_observed(DepthView::new(&map, 30, 20).unwrap(), &mut |stage| told.push(stage)).unwrap();
            assert_eq!(told, method.stages, "{}", method.name);
        }
    }
}
