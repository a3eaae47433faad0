//! What a map may be: every wrong input is a typed error that says what was given and what is accepted.

mod naive;

use depthplanes::internals::{ConnectedComponents, Connectivity, kernels};
use depthplanes::limits::{MAX_PIXELS, MAX_SIDE};
use depthplanes::{AnyView, DepthView, Detector, Error, Intrinsics, Ngaf, Pixel, ValueKind};
use naive::Random;

/// The error's message, which holds each of the numbers.
#[track_caller]
fn message<T>(result: Result<T, Error>, expected: &Error, numbers: &[&dyn std::fmt::Display]) {
    let error = result.err().expect("a wrong input is an error");
    assert_eq!(&error, expected);
    let text = error.to_string();
    for number in numbers {
        assert!(text.contains(&number.to_string()), "`{text}` does not say {number}");
    }
}

#[test]
fn sides_are_1_to_65535_and_maps_at_most_2_to_the_30_pixels() {
    let long = MAX_SIDE + 1;
    let sides =
        [(0, 4), (4, 0), (0, 0), (long, 1), (1, long), (usize::MAX, 1), (1, usize::MAX), (usize::MAX, usize::MAX)];
    for (width, height) in sides {
        let expected = Error::Size { width, height };
        message(DepthView::new(&[1u8; 4], width, height), &expected, &[&width, &height, &MAX_SIDE, &MAX_PIXELS]);
        message(DepthView::with_stride(&[1u16; 4], width, height, 9), &expected, &[&width, &height, &MAX_SIDE]);
    }
    // Each side would do, the whole would not.
    let (width, height) = (65_535, 16_385);
    message(DepthView::<f32>::new(&[], width, height), &Error::Size { width, height }, &[&width, &height, &MAX_PIXELS]);
    assert!(DepthView::new(&vec![1u8; MAX_SIDE], MAX_SIDE, 1).is_ok());
    assert!(DepthView::new(&vec![1u8; MAX_SIDE], 1, MAX_SIDE).is_ok());
}

#[test]
fn the_slice_holds_exactly_the_map() {
    let pixels = [7u16; 13];
    for given in [0, 1, 11, 13] {
        let expected = Error::Length { given, least: 12, most: 12 };
        message(DepthView::new(&pixels[..given], 4, 3), &expected, &[&given, &12]);
    }
    assert!(DepthView::new(&pixels[..12], 4, 3).is_ok());
}

#[test]
fn the_last_row_may_end_at_the_width_or_at_the_stride_and_nowhere_else() {
    let pixels = [7u8; 40];
    for given in 0..=40 {
        let view = DepthView::with_stride(&pixels[..given], 4, 3, 6);
        if (16..=18).contains(&given) {
            let view = view.unwrap();
            assert_eq!((view.width(), view.height(), view.area()), (4, 3, 12));
            assert!(view.rows().all(|row| row.len() == 4));
        } else {
            message(view, &Error::Length { given, least: 16, most: 18 }, &[&given, &16, &18]);
        }
    }
}

#[test]
fn strides_are_at_least_the_width_and_fit_in_memory() {
    let pixels = [7u8; 12];
    for (width, height, stride) in [(4, 3, 0), (4, 3, 3), (4, 2, usize::MAX), (4, 3, usize::MAX / 2)] {
        let expected = Error::Stride { stride, width };
        message(DepthView::with_stride(&pixels, width, height, stride), &expected, &[&stride, &width]);
    }
    // One row has no next one; its stride is free.
    let view = DepthView::with_stride(&pixels, 4, 1, usize::MAX).unwrap();
    assert_eq!(view.row(0), [7; 4]);
    // The largest product that does not overflow still asks for its pixels.
    let (stride, least) = (usize::MAX / 3, usize::MAX / 3 * 2 + 4);
    let expected = Error::Length { given: 12, least, most: usize::MAX / 3 * 3 };
    message(DepthView::with_stride(&pixels, 4, 3, stride), &expected, &[&12, &least]);
}

#[test]
fn valid_ranges_go_up() {
    let view = DepthView::new(&[1.0f32], 1, 1).unwrap();
    for (low, high) in [(2.0f32, 1.0f32), (1.0, 1.0), (f32::INFINITY, f32::NEG_INFINITY)] {
        let expected = Error::ValidRange { low: low.into(), high: high.into() };
        message(view.valid_range(low, high), &expected, &[&low, &high]);
    }
    for (low, high) in [(f32::NAN, 1.0), (1.0, f32::NAN), (f32::NAN, f32::NAN)] {
        let text = view.valid_range(low, high).unwrap_err().to_string(); // NaN equals no error
        assert!(text.contains("NaN") && text.contains(&high.to_string()), "{text}");
    }
    let view = DepthView::new(&[1u8], 1, 1).unwrap();
    message(view.valid_range(200, 100), &Error::ValidRange { low: 200.0, high: 100.0 }, &[&200, &100]);
}

#[test]
fn infinities_are_missing_even_within_an_infinite_range() {
    let map = [1.0f32, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 0.0, -0.0, -3.0, f32::MAX];
    let view = DepthView::new(&map, 4, 2).unwrap();
    assert_eq!(view.valid_pixels(), 3);
    assert_eq!(view.valid_range(0.5, f32::INFINITY).unwrap().valid_pixels(), 2);
    assert_eq!(view.valid_range(f32::NEG_INFINITY, f32::INFINITY).unwrap().valid_pixels(), 3);
    assert_eq!(view.valid_range(f32::NEG_INFINITY, 0.5).unwrap().valid_pixels(), 1);
    let mut detector = Detector::new(Ngaf::default().theta(1.0).min_pixels(0).window(3)).unwrap();
    let found = detector.detect(view.valid_range(0.5, f32::INFINITY).unwrap()).unwrap();
    assert_eq!(found.labels[1], 0);
}

#[test]
fn nan_as_the_missing_value_changes_nothing_on_any_kernel() {
    let mut random = Random(51);
    let map: Vec<f32> = (0..90 * 20)
        .map(|_| if random.below(4) == 0 { f32::NAN } else { 1.0 + random.below(9) as f32 / 10.0 })
        .collect();
    let plain = DepthView::new(&map, 90, 20).unwrap();
    let view = plain.missing_value(f32::NAN);
    assert!(view.valid_pixels() > 1000);
    assert_eq!(view.valid_pixels(), plain.valid_pixels());
    for kernel in kernels() {
        let sizes = |view: &DepthView<'_, f32>| {
            let mut grouper = ConnectedComponents::with_kernel(kernel);
            grouper.group(view, &Connectivity::new(view.validity(), 0.15).unwrap(), 1).sizes().to_vec()
        };
        assert_eq!(sizes(&view), sizes(&plain), "{kernel:?}");
    }
}

fn check_valid_pixels<T: Pixel>(view: &DepthView<'_, T>) {
    let rule = view.validity();
    let [low, high, sentinel] = [rule.low, rule.high, rule.sentinel].map(Into::<f64>::into);
    let mut count = 0;
    for v in 0..view.height() {
        for u in 0..view.width() {
            count += usize::from(naive::valid(view.row(v)[u].into(), sentinel, low, high));
        }
    }
    assert_eq!(view.valid_pixels(), count);
    let mut detector = Detector::new(Ngaf::default()).unwrap();
    assert_eq!(detector.detect(*view).unwrap().valid_pixels, count);
}

#[test]
fn valid_pixels_are_counted_as_defined() {
    let mut random = Random(52);
    for case in 0..500 {
        let (width, height) = (1 + random.below(100) as usize, 1 + random.below(40) as usize);
        let stride = width + random.below(3) as usize;
        let bytes = naive::awkward_map(&mut random, stride, height);
        let singles: Vec<f32> = bytes
            .iter()
            .map(|&value| {
                [f32::NAN, f32::INFINITY, -1.5, 0.0].get(value as usize % 40).copied().unwrap_or(value.into())
            })
            .collect();
        let [a, b] = [random.below(120) as u8, 121 + random.below(130) as u8];
        let mut view = DepthView::with_stride(&bytes, width, height, stride).unwrap();
        let mut single = DepthView::with_stride(&singles, width, height, stride).unwrap();
        if case % 2 == 0 {
            (view, single) = (view.missing_value(bytes[0]), single.missing_value(-1.5));
        }
        if case % 3 == 0 {
            (view, single) = (view.valid_range(a, b).unwrap(), single.valid_range(a.into(), b.into()).unwrap());
        }
        check_valid_pixels(&view);
        check_valid_pixels(&single);
    }
}

#[test]
fn views_know_their_size_whatever_their_type() {
    let view = DepthView::with_stride(&[1u16; 11], 3, 3, 4).unwrap();
    let any = AnyView::from(view);
    assert_eq!((any.width(), any.height()), (3, 3));
    assert!(matches!(any, AnyView::U16(_)));
    assert!(matches!(AnyView::from(DepthView::new(&[1u8], 1, 1).unwrap()), AnyView::U8(_)));
    assert!(matches!(AnyView::from(DepthView::new(&[1f32], 1, 1).unwrap()), AnyView::F32(_)));
}

#[test]
fn maps_of_twelve_million_pixels_run() {
    let (width, height) = (4096, 3000);
    let map: Vec<u16> = (0..width * height).map(|at| (1000 + at % width / 8 + at / width / 8) as u16).collect();
    let mut detector = Detector::new(Ngaf::default()).unwrap().threads(2);
    let found = detector.detect(DepthView::new(&map, width, height).unwrap()).unwrap();
    assert_eq!((found.planes.len(), found.planes[0].pixel_count), (1, width * height));
}

#[test]
fn the_longest_sides_run() {
    let mut detector = Detector::new(Ngaf::default()).unwrap().threads(2);
    for (width, height) in [(65_535, 5), (5, 65_535), (65_535, 1), (1, 65_535), (32_769, 3)] {
        let map = vec![1.5f32; width * height];
        let found = detector.detect(DepthView::new(&map, width, height).unwrap()).unwrap();
        assert_eq!((found.planes.len(), found.planes[0].pixel_count), (1, width * height));
        assert_eq!(found.planes[0].fit.is_some(), width > 1 && height > 1);
    }
}

#[test]
fn cameras_that_describe_no_real_one_are_refused() {
    let nan = f64::NAN;
    let camera = |name, given: f64, accepted| Error::Camera { name, given, accepted };
    for given in [0.0, f64::INFINITY, 1e-9, -1e-4, 2e9] {
        let accepted = "a focal length in pixels, from 0.001 to 1e9 or from -1e9 to -0.001";
        message(Intrinsics::new(given, 1.0, 0.0, 0.0), &camera("fx", given, accepted), &[&"fx", &given, &accepted]);
        message(Intrinsics::new(1.0, given, 0.0, 0.0), &camera("fy", given, accepted), &[&"fy", &given, &accepted]);
    }
    for (name, result) in [
        ("fx", Intrinsics::new(nan, 1.0, 0.0, 0.0).map(drop)),
        ("fy", Intrinsics::new(1.0, nan, 0.0, 0.0).map(drop)),
        ("cx", Intrinsics::new(1.0, 1.0, nan, 0.0).map(drop)),
        ("cy", Intrinsics::new(1.0, 1.0, 0.0, nan).map(drop)),
        ("metres per map unit", ValueKind::depth(nan).map(drop)),
        ("pixels of disparity", ValueKind::stereo(nan, 1.0, 1.0, 0.0).map(drop)),
        ("focal length", ValueKind::stereo(1.0, nan, 1.0, 0.0).map(drop)),
        ("baseline", ValueKind::stereo(1.0, 1.0, nan, 0.0).map(drop)),
        ("doffs", ValueKind::stereo(1.0, 1.0, 1.0, nan).map(drop)),
    ] {
        let text = result.unwrap_err().to_string();
        assert!(text.contains(name) && text.contains("NaN") && text.contains("accepted"), "{text}");
    }
    assert!(ValueKind::depth(-1.0).is_err() && ValueKind::depth(0.0).is_err());
    assert!(ValueKind::depth(1e-30).is_err() && ValueKind::depth(1e30).is_err() && ValueKind::depth(1e-9).is_ok());
    assert!(ValueKind::stereo(1.0, 1e10, 1e10, 0.0).is_err() && Intrinsics::new(500.0, 500.0, 1e10, 0.0).is_err());
    assert!(Intrinsics::new(-500.0, -500.0, -3.0, 1e4).is_ok());
}

#[test]
fn value_kinds_turn_values_into_depth_and_back() {
    let mut random = Random(53);
    for _ in 0..2000 {
        let depth_m = 10f64.powf(random.between(-2.0, 2.0));
        for value_kind in [
            ValueKind::depth(random.between(1e-4, 1.0)).unwrap(),
            ValueKind::stereo(random.between(0.1, 2.0), 500.0, 0.2, random.between(-20.0, 200.0)).unwrap(),
            ValueKind::InverseDepth { slope: -1.0 / 4336.0, offset: 0.2516 },
        ] {
            let value = value_kind.value(depth_m).unwrap();
            let back = value_kind.depth_m(value).unwrap();
            assert!((back / depth_m - 1.0).abs() < 1e-9, "{value_kind:?}: {depth_m} m became {back} m");
        }
    }
    // Eq. 6: z = f T / d.
    let stereo = ValueKind::stereo(1.0, 600.0, 0.1, 0.0).unwrap();
    assert_eq!(stereo.value(2.0), Some(30.0));
    assert_eq!((stereo.depth_m(0.0), stereo.depth_m(-1.0), stereo.value(-2.0)), (None, None, None));
    assert_eq!((ValueKind::Disparity.depth_m(3.0), ValueKind::Disparity.value(3.0)), (None, None));
}
