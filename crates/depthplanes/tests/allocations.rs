//! After the first frame of a size and type, detecting allocates nothing.
//!
//! A binary of its own, since it replaces the allocator.

mod naive;

use depthplanes::ground::{GridMapper, GroundFinder};
use depthplanes::methods::Parameters;
use depthplanes::noise::{EnlargementFinder, RoundingFinder, Space};
use depthplanes::outline::Outliner;
use depthplanes::scene::{ScenePixels, Spec, Walk};
use depthplanes::track::Tracker;
use depthplanes::{
    Coplanar, DepthView, Detection, Detector, Distortion, DistortionModel, Intrinsics, Ngaf, Pixel, Planar, Sensor,
    ValueKind,
};
use naive::Random;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// The system's allocator, counting what the current thread asks of it.
struct Counting;

thread_local! {
    static CALLS: Cell<usize> = const { Cell::new(0) };
    static BYTES: Cell<usize> = const { Cell::new(0) };
}

fn count(bytes: usize) {
    CALLS.set(CALLS.get() + 1);
    BYTES.set(BYTES.get() + bytes);
}

// SAFETY: every call is handed to the system's allocator unchanged; counting touches only
// thread-local cells that need neither memory nor destructors.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: the caller's promises are passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: the caller's promises are passed on.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size);
        // SAFETY: the caller's promises are passed on.
        unsafe { System.realloc(memory, layout, size) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: the caller's promises are passed on.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations and bytes of one call on this thread.
fn allocated(call: impl FnOnce()) -> (usize, usize) {
    let before = (CALLS.get(), BYTES.get());
    call();
    (CALLS.get() - before.0, BYTES.get() - before.1)
}

/// A frame unlike the one before: constant, all missing, quantised slopes, noise from none to all,
/// few holes to many, of 100 pixels so many in turn.
fn frame<T: Pixel>(random: &mut Random, number: u64, width: usize, height: usize, holes: [u64; 6]) -> Vec<T> {
    let most_levels = 1 << random.below(9);
    let (levels, step) = (1 + random.below(most_levels), 1 + random.below(20));
    let holes = holes[(number % 6) as usize];
    let slope = random.below(4) as usize;
    let pixel = |at: usize, random: &mut Random| {
        let (u, v) = (at % width, at / width);
        let value = 1 + (slope * (u + v) / 40) as u64 % 100 * step + random.below(levels) * step;
        if random.below(100) < holes { T::ZERO } else { T::from_f64(value as f64) }
    };
    (0..width * height).map(|at| pixel(at, random)).collect()
}

/// Holes of frames of any kind, and of those that `planar` works on at a smaller size.
const ANY: [u64; 6] = [0, 2, 30, 60, 95, 100];
const SPARSE: [u64; 6] = [80; 6];

fn everything() -> Ngaf {
    Ngaf::default().theta(3.0).min_pixels(2).window(5).passes(2).max_rms(50.0).min_fill(0.1).margin(1)
}

fn sensors() -> [Sensor; 3] {
    let intrinsics = Intrinsics::new(300.0, 300.0, 80.0, 60.0).ok();
    let stereo = ValueKind::stereo(1.0, 300.0, 0.1, 0.0).unwrap();
    [
        Sensor::default(),
        Sensor::default().intrinsics(intrinsics),
        Sensor::default().value_kind(stereo).intrinsics(intrinsics),
    ]
}

/// `first` is the number of the first frame, so that it is in turn an empty, a simple and a noisy one.
fn check<T: Pixel, M>(params: M, sensor: Sensor, (width, height): (usize, usize), first: u64, holes: [u64; 6])
where
    M: Parameters + Copy + std::fmt::Debug,
{
    let mut random = Random(first);
    let mut detector = Detector::new(params).unwrap().sensor(sensor);
    let frames: Vec<Vec<T>> = (0..25).map(|k| frame(&mut random, first + k, width, height, holes)).collect();
    let mut planes = 0;
    for (number, frame) in frames.iter().enumerate() {
        let view = DepthView::new(frame, width, height).unwrap().missing_value(T::from_f64(77.0));
        let (calls, bytes) = allocated(|| planes += detector.detect(view).unwrap().planes.len());
        if number > 0 {
            let kind = std::any::type_name::<T>();
            let what = format!("frame {number} of {width}x{height} {kind}, {params:?}, {sensor:?}");
            assert_eq!((calls, bytes), (0, 0), "{what}");
        }
    }
    assert!(planes > 0, "no plane in any frame");
}

#[test]
fn the_counter_counts() {
    let (calls, bytes) = allocated(|| drop(std::hint::black_box(vec![0u8; 1000])));
    assert_eq!((calls, bytes), (1, 1000));
    let (calls, _) = allocated(|| drop(std::hint::black_box(Box::new(1u64))));
    assert_eq!(calls, 1);
}

#[test]
fn later_frames_behind_a_lens_allocate_nothing() {
    let lens = Distortion::new(DistortionModel::BrownConrady, &[-0.2, 0.05]).unwrap();
    let [_, depth, stereo] = sensors().map(|sensor| sensor.distortion(lens));
    for sensor in [depth, stereo] {
        check::<u16, _>(Ngaf::default().theta(3.0).min_pixels(2), sensor, (120, 90), 2, ANY);
        check::<f32, _>(Ngaf::default().theta(3.0).min_pixels(2), sensor, (97, 33), 1, ANY);
        check::<u16, _>(Planar::default().min_pixels(20), sensor, (160, 120), 2, ANY);
    }
}

#[test]
fn later_frames_allocate_nothing() {
    let plain = Ngaf::default().theta(3.0);
    for sensor in sensors() {
        for params in [plain, everything()] {
            // The last is cut into several strips; more than 32 pixels keep its noise within 65535 planes.
            for (size, firsts, min) in [((120, 90), 6, 2), ((97, 33), 6, 2), ((900, 600), 1, 32)] {
                let params = params.min_pixels(min);
                for first in 0..firsts {
                    check::<u8, _>(params, sensor, size, first, ANY);
                    check::<u16, _>(params, sensor, size, first, ANY);
                    check::<f32, _>(params, sensor, size, first, ANY);
                }
            }
        }
    }
}

#[test]
fn later_frames_of_planar_allocate_nothing() {
    for sensor in sensors() {
        for params in [Planar::default(), Planar::default().min_pixels(0).noise(2.0).inlier_threshold(1.0)] {
            for (size, first) in [((120, 90), 0), ((97, 33), 1), ((400, 300), 2)] {
                for holes in [ANY, SPARSE] {
                    check::<u8, _>(params, sensor, size, first, holes);
                    check::<u16, _>(params, sensor, size, first, holes);
                    check::<f32, _>(params, sensor, size, first, holes);
                }
            }
        }
    }
}

/// As a caller that looks back at the frame before: it gives a detection back when it has the next but one.
#[test]
fn detections_that_come_back_allocate_nothing() {
    let frames: Vec<_> = (1..6)
        .map(|seed| format!("room:seed={seed},sensor=kinect,size=320x240").parse::<Spec>().unwrap().frame().unwrap())
        .collect();
    let (mut detector, mut alone) =
        (Detector::default().sensor(frames[0].sensor), Detector::default().sensor(frames[0].sensor));
    let mut kept = [Detection::default(), Detection::default()];
    for number in 0..20 {
        let frame = &frames[number % frames.len()];
        let expected = alone.detect(frame.view()).unwrap().clone();
        let (calls, bytes) = allocated(|| {
            detector.detect(frame.view()).unwrap();
            kept[number % 2] = detector.exchange(std::mem::take(&mut kept[number % 2]));
        });
        assert_eq!(kept[number % 2], expected, "frame {number}");
        assert!(number < 3 || (calls, bytes) == (0, 0), "frame {number}: {calls} calls, {bytes} bytes");
    }
}

#[test]
fn later_grounds_allocate_nothing() {
    let frames: Vec<_> = ["stairs", "boxes", "corridor", "random:seed=2", "room", "planes3", "random:seed=3"]
        .map(|scene| format!("{scene}{}sensor=kinect,size=320x240", if scene.contains(':') { "," } else { ":" }))
        .map(|spec| spec.parse::<Spec>().unwrap().frame().unwrap())
        .into();
    let mut detector = Detector::default().sensor(frames[0].sensor);
    let (mut finder, mut mapper) = (GroundFinder::default(), GridMapper::default());
    for (number, frame) in frames.iter().enumerate() {
        let found = detector.detect(frame.view()).unwrap();
        let (calls, bytes) = allocated(|| {
            let ground = finder.find(frame.view(), found, &frame.sensor).unwrap();
            assert!(mapper.grid(frame.view(), &frame.sensor, ground).is_ok());
        });
        assert!(number == 0 || (calls, bytes) == (0, 0), "frame {number}: {calls} calls, {bytes} bytes");
    }
}

/// In steady state: planes that come and go need room for as many as there have been at once.
#[test]
fn later_tracks_allocate_nothing() {
    let walk = Walk::new("boxes:sensor=kinect,size=320x240".parse().unwrap(), 5.0);
    let frames: Vec<_> = (0..12).map(|index| (walk.frame(index).unwrap(), walk.pose(index).unwrap())).collect();
    let mut detector = Detector::default().sensor(frames[0].0.sensor);
    let (mut known, mut estimated) = (Tracker::default(), Tracker::default());
    let mut ids = 0;
    for number in 0..96 {
        let (frame, pose) = &frames[number % frames.len()];
        let found = detector.detect(frame.view()).unwrap();
        let (calls, bytes) = allocated(|| {
            ids += known.track_with_map(frame.view(), found, &frame.sensor, Some(pose)).unwrap().ids.len();
            ids += estimated.track(found, &frame.sensor, None).unwrap().ids.len();
        });
        assert!(number < 60 || (calls, bytes) == (0, 0), "frame {number}: {calls} calls, {bytes} bytes");
    }
    assert!(ids > 1000, "{ids}");
}

#[test]
fn later_frames_with_coplanar_planes_joined_allocate_nothing() {
    let (width, height) = (120, 90);
    let mut random = Random(5);
    let clutter: Vec<Vec<u16>> = (0..12).map(|k| frame(&mut random, k, width, height, ANY)).collect();
    // The legs of a table cut the floor.
    let rooms = (1..=12).map(|seed| {
        let room = format!("room:sensor=kinect_white,size={width}x{height},seed={seed}").parse::<Spec>().unwrap();
        let ScenePixels::U16(pixels) = room.frame().unwrap().pixels else { panic!("millimetres") };
        pixels
    });
    let rooms: Vec<Vec<u16>> = rooms.collect();
    let mut parts = [0; 2];
    for sensor in &sensors()[1..] {
        let ngaf = Detector::new(Ngaf::default().theta(3.0).min_pixels(2)).unwrap();
        let planar = Detector::new(Planar::default().min_pixels(0).min_area(1e-4)).unwrap();
        for ((detector, frames), parts) in [(ngaf, &clutter), (planar, &rooms)].into_iter().zip(&mut parts) {
            let within = Coplanar::new(10.0, 0.1).unwrap();
            let mut detector = detector.sensor(*sensor).merge_coplanar(within).unwrap();
            for (number, frame) in frames.iter().enumerate() {
                let view = DepthView::new(frame, width, height).unwrap();
                let (calls, bytes) = allocated(|| *parts += detector.detect(view).unwrap().parts.len());
                assert!(number == 0 || (calls, bytes) == (0, 0), "frame {number}: {calls} calls, {bytes} bytes");
            }
        }
    }
    assert!(parts.iter().all(|&parts| parts > 0), "nothing was joined: {parts:?}");
}

/// An outliner's memory grows with what outlines need: frames that need no more than some before
/// allocate nothing.
#[test]
fn outlines_of_frames_no_more_intricate_than_before_allocate_nothing() {
    let (width, height) = (120, 90);
    for sensor in sensors() {
        for tolerance in [0.0, 1.0, 3.0] {
            let mut random = Random(4);
            let mut detector = Detector::new(Ngaf::default().theta(3.0).min_pixels(2)).unwrap().sensor(sensor);
            let mut outliner = Outliner::new(tolerance).unwrap();
            let frames: Vec<Vec<u16>> = (0..12).map(|k| frame(&mut random, k, width, height, ANY)).collect();
            for (number, frame) in frames.iter().chain(&frames).enumerate() {
                let found = detector.detect(DepthView::new(frame, width, height).unwrap()).unwrap();
                let camera = sensor.intrinsics.as_ref();
                let (calls, bytes) = allocated(|| assert!(outliner.outline(found, camera).is_ok()));
                assert!(
                    number < frames.len() || (calls, bytes) == (0, 0),
                    "frame {number}: {calls} calls, {bytes} bytes"
                );
            }
        }
    }
}

#[test]
fn smaller_frames_allocate_nothing_either() {
    let mut random = Random(9);
    let mut detector = Detector::new(everything()).unwrap().sensor(sensors()[1]);
    for (number, (width, height)) in [(160, 120), (100, 120), (1, 1), (160, 119), (160, 120)].into_iter().enumerate() {
        let frame: Vec<u16> = frame(&mut random, 1, width, height, ANY);
        let view = DepthView::new(&frame, width, height).unwrap();
        let (calls, bytes) = allocated(|| assert!(detector.detect(view).is_ok()));
        assert!(number == 0 || (calls, bytes) == (0, 0), "{width}x{height}: {calls} calls, {bytes} bytes");
    }
}

#[test]
fn what_later_maps_are_rounded_to_and_enlarged_by_is_found_without_allocating() {
    let (mut random, mut finder) = (Random(6), RoundingFinder::default());
    let mut enlargement = EnlargementFinder::default();
    for number in 0..25 {
        let frame: Vec<f32> = frame(&mut random, number, 160, 120, ANY);
        let view = DepthView::new(&frame, 160, 120).unwrap();
        let doubled: Vec<f32> = (0..160 * 120).map(|at| frame[at / 320 * 80 + at % 160 / 2]).collect();
        let doubled = DepthView::new(&doubled, 160, 120).unwrap();
        let (calls, bytes) = allocated(|| {
            assert!(finder.find(&view, Space::Value).step(1.0) >= 0.0);
            std::hint::black_box((enlargement.find(&view).is_some(), enlargement.find(&doubled).is_some()));
        });
        assert!(number == 0 || (calls, bytes) == (0, 0), "frame {number}: {calls} calls, {bytes} bytes");
    }
}

#[test]
fn later_frames_that_were_enlarged_allocate_nothing() {
    let (width, height) = (240, 180);
    let mut detector = Detector::default().sensor(sensors()[1]);
    let mut planes = 0;
    for number in 0..8 {
        let inverse_depth = |at: usize| {
            let [u, v] = [at % width / 3, at / width / 3].map(|place| place as f64);
            0.4 + 0.002 * u + (0.001 + 0.0002 * f64::from(number)) * v + if u < 40.0 { 0.1 } else { 0.0 }
        };
        let frame: Vec<u16> = (0..width * height).map(|at| (1e3 / inverse_depth(at)) as u16).collect();
        let view = DepthView::new(&frame, width, height).unwrap();
        let (calls, bytes) = allocated(|| planes += detector.detect(view).unwrap().planes.len());
        assert!(number == 0 || (calls, bytes) == (0, 0), "frame {number}: {calls} calls, {bytes} bytes");
    }
    assert!(planes > 0, "no plane in any frame");
}
