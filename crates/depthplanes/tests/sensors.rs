//! Do synthetic cameras err as real ones do? Residuals of large planes about their own least-squares
//! plane, single pixels and means over blocks, against those of recorded frames.
//!
//! `cargo test -p depthplanes --test sensors -- --nocapture` prints the table.

use depthplanes::scene::{Camera, Pose, Scene, SceneFrame, SensorError, SensorModel, Spec, render};
use nalgebra::{Matrix3, Vector3};

const BLOCKS: [usize; 5] = [1, 4, 8, 16, 32];
/// Least pixels of a plane, as of the recorded ones.
const LEAST_PIXELS: usize = 3000;
/// Units per 1/m of the Kinect's rows: f b in pixels of disparity.
const KINECT_PX_M: f64 = 580.0 * 0.075;

/// Standard deviations of single pixels and of means over 4, 8, 16 and 32 pixels square, median over
/// 119 labelled planes of recorded frames (measured 2026-11-28): pixels of disparity for Kinect v1,
/// else 1/m.
const RECORDED: [(SensorModel, f64, [f64; 5]); 5] = [
    (SensorModel::KinectV1, KINECT_PX_M, [0.092, 0.075, 0.066, 0.059, 0.053]),
    (SensorModel::KinectV2, 1.0, [0.0030, 0.0025, 0.0022, 0.0023, 0.0022]),
    (SensorModel::RealSense, 1.0, [0.0030, 0.0024, 0.0023, 0.0020, 0.0015]),
    (SensorModel::AzureKinect, 1.0, [0.0013, 0.0013, 0.0012, 0.0011, 0.0013]),
    (SensorModel::Stereo, 1.0, [0.0039, 0.0037, 0.0033, 0.0027, 0.0019]),
];

/// A value of the map as inverse depth, 1/m.
fn inverse_depth(frame: &SceneFrame, at: usize) -> f64 {
    frame.sensor.value_kind.inverse_depth(frame.value(at)).expect("the pixel is measured")
}

/// One plane's residuals in inverse depth, 1/m.
struct Residuals {
    width: usize,
    /// Pixel and residual, in raster order.
    pixels: Vec<(usize, f64)>,
    /// Mean depth, metres.
    depth_m: f64,
}

fn fitted(width: usize, pixels: &[(usize, f64)]) -> Vec<(usize, f64)> {
    let place = |at: usize| Vector3::new(1.0, (at % width) as f64 / 320.0 - 1.0, (at / width) as f64 / 320.0 - 0.75);
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for &(at, q) in pixels {
        normal += place(at) * place(at).transpose();
        right += place(at) * q;
    }
    let plane = normal.lu().solve(&right).expect("a large plane spans an area");
    pixels.iter().map(|&(at, q)| (at, q - plane.dot(&place(at)))).collect()
}

/// Measured pixels of a plane, two pixels and more from its border, as far as they are within four
/// robust deviations of their plane: so were the recorded ones labelled.
fn residuals(frame: &SceneFrame, label: u16) -> Option<Residuals> {
    let (width, labels) = (frame.width, &frame.truth.labels);
    let inside = |&at: &usize| {
        let (u, v) = (at % width, at / width);
        let same = |(row, column): (usize, usize)| labels[row * width + column] == label;
        let within = (2..width - 2).contains(&u) && (2..frame.height - 2).contains(&v);
        within && (v - 2..=v + 2).flat_map(|row| (u - 2..=u + 2).map(move |column| (row, column))).all(same)
    };
    let measured = (0..labels.len()).filter(|&at| labels[at] == label && frame.value(at) > 0.0).filter(inside);
    let all: Vec<_> = measured.map(|at| (at, inverse_depth(frame, at))).collect();
    if all.len() < LEAST_PIXELS {
        return None;
    }
    let off = fitted(width, &all);
    let limit = 4.0 * 1.4826 * median(off.iter().map(|(_, r)| r.abs()).collect());
    let kept: Vec<_> = all.iter().zip(&off).filter(|(_, off)| off.1.abs() <= limit).map(|(pixel, _)| *pixel).collect();
    let depth_m = kept.len() as f64 / kept.iter().map(|(_, q)| q).sum::<f64>();
    Some(Residuals { width, pixels: fitted(width, &kept), depth_m })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn deviation(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / values.len() as f64).sqrt()
}

impl Residuals {
    /// Standard deviation of means over blocks of `side` x `side` of which half or more is there;
    /// `None` for fewer than three.
    fn of_blocks(&self, side: usize) -> Option<f64> {
        let across = self.width.div_ceil(side);
        let mut sums = vec![(0.0, 0); across * (self.pixels.last()?.0 / self.width / side + 1)];
        for &(at, r) in &self.pixels {
            let (sum, count) = &mut sums[at / self.width / side * across + at % self.width / side];
            (*sum, *count) = (*sum + r, *count + 1);
        }
        let full = sums.iter().filter(|(_, count)| 2 * count >= side * side);
        let means: Vec<f64> = full.map(|&(sum, count)| sum / count as f64).collect();
        (means.len() >= 3).then(|| deviation(&means))
    }

    /// Standard deviation of what a pixel does not share with its neighbour to the right.
    fn of_neighbours(&self) -> f64 {
        let pairs = self.pixels.windows(2).filter(|pair| pair[1].0 == pair[0].0 + 1);
        deviation(&pairs.map(|pair| pair[1].1 - pair[0].1).collect::<Vec<_>>()) / 2f64.sqrt()
    }
}

/// The large planes of synthetic rooms as that sensor sees them.
fn planes(sensor: SensorModel) -> Vec<Residuals> {
    let mut found = Vec::new();
    for scene in ["room", "random"] {
        for seed in 1..=4 {
            let spec = Spec { seed, sensor, ..Spec::new(scene).unwrap() };
            let frame = spec.frame().unwrap();
            found.extend(frame.truth.planes.iter().filter_map(|plane| residuals(&frame, plane.label)));
        }
    }
    found
}

#[test]
fn synthetic_cameras_err_as_recorded_ones() {
    println!("sensor     planes       1       4       8      16      32   pixel  stated  smooth  stated");
    let mut wrong = Vec::new();
    for (sensor, unit, recorded) in RECORDED {
        let (name, planes) = (sensor.info().name, planes(sensor));
        assert!(planes.len() >= 40, "{name}: {} planes", planes.len());
        let found = BLOCKS.map(|side| unit * median(planes.iter().filter_map(|p| p.of_blocks(side)).collect()));
        let stated = |of: fn(SensorError) -> f64| {
            unit * median(planes.iter().map(|plane| of(sensor.error_at(plane.depth_m))).collect())
        };
        // A field with nodes 4 px apart differs by 0.207 deviations from pixel to pixel.
        let beside = stated(|error| (error.pixel().powi(2) + (0.207 * error.short).powi(2)).sqrt());
        let pixel = unit * median(planes.iter().map(Residuals::of_neighbours).collect());
        let rows = [found, recorded].map(|row| row.map(|x| format!("{x:8.5}")).concat());
        println!(
            "{name:10} {:6}{}{pixel:8.5}{beside:8.5}{:8.5}{:8.5}",
            planes.len(),
            rows[0],
            found[3],
            stated(|e| e.smooth)
        );
        println!("  recorded       {}", rows[1]);
        let within_a_quarter = |found: f64, expected: f64| (found / expected - 1.0).abs() <= 0.25;
        for ((side, found), recorded) in BLOCKS.iter().zip(found).zip(recorded) {
            if !within_a_quarter(found, recorded) {
                wrong.push(format!("{name}: {found} for blocks of {side}, recorded {recorded}"));
            }
        }
        for (what, found, stated) in [("pixel", pixel, beside), ("smooth", found[3], stated(|error| error.smooth))] {
            if !within_a_quarter(found, stated) {
                wrong.push(format!("{name}: {what} part {found}, stated {stated}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn white_sensors_state_their_formulas() {
    let kinect = SensorModel::KinectV1White.error_at(3.0);
    assert!((KINECT_PX_M * kinect.white - 1.0 / 16.0).abs() < 1e-12 && kinect.smooth == 0.0);
    assert!((KINECT_PX_M * kinect.step - 0.125).abs() < 2e-4, "steps of 1/8 px, and millimetres");
    let tof = SensorModel::TofWhite.error_at(2.0);
    assert!((tof.white * 4.0 - 0.0062).abs() < 1e-12 && (tof.step * 4.0 - 0.001).abs() < 1e-12);
    assert_eq!(SensorModel::Clean.error_at(2.0), SensorError::NONE);
    assert_eq!(SensorModel::CleanMm.error_at(2.0), SensorError { step: 0.00025, ..SensorError::NONE });
    assert!((SensorModel::Disparity8.error_at(2.0).step * 580.0 * 0.1 - 0.25).abs() < 1e-12);
    assert!((SensorModel::Stereo.error_at(2.0).step * 580.0 * 0.09 - 1.0 / 256.0).abs() < 1e-12);
}

/// A wall three metres ahead that fills the picture.
fn wall(sensor: SensorModel, size: [usize; 2], seed: u64) -> SceneFrame {
    let mut scene = Scene::default();
    scene.facet(&[[-9.0, 3.0, -9.0], [9.0, 3.0, -9.0], [9.0, 3.0, 9.0], [-9.0, 3.0, 9.0]]);
    render(&scene, &Camera::kinect(size[0], size[1], Pose::at_height(1.0, 0.0)).unwrap(), sensor, seed).unwrap()
}

#[test]
fn seams_and_bow_are_the_same_in_every_frame() {
    let (frames, mut columns) = (30, vec![0.0; 640]);
    for seed in 0..frames {
        let frame = wall(SensorModel::KinectV1, [640, 480], seed);
        for at in 0..640 * 480 {
            columns[at % 640] += KINECT_PX_M * (inverse_depth(&frame, at) - 1.0 / 3.0);
        }
    }
    let mean = |range: std::ops::Range<usize>| {
        columns[range.clone()].iter().sum::<f64>() / (range.len() as u64 * frames * 480) as f64
    };
    let step = mean(320..324) - mean(316..320);
    assert!((step + 0.1).abs() < 0.02, "a step of {step} px at column 320");
    let beside = mean(370..374) - mean(366..370);
    assert!(beside.abs() < 0.02, "a step of {beside} px at column 370");
    // 0.51 x^2 px from the middle to the edge, less what the seams are between.
    let bow = 0.5 * (mean(0..20) + mean(620..640)) - mean(300..340);
    assert!((bow - 0.51).abs() < 0.1, "a bow of {bow} px");
}

#[test]
fn a_smaller_picture_has_the_same_error() {
    for (sensor, _, _) in RECORDED {
        let of = |size: [usize; 2]| {
            let deviations = (0..8).map(|seed| {
                let frame = wall(sensor, size, seed);
                let measured = (0..size[0] * size[1]).filter(|&at| frame.value(at) > 0.0);
                deviation(&measured.map(|at| inverse_depth(&frame, at)).collect::<Vec<_>>())
            });
            deviations.sum::<f64>() / 8.0
        };
        let (full, quarter) = (of([640, 480]), of([320, 240]));
        assert!((quarter / full - 1.0).abs() < 0.1, "{}: {quarter} and {full} 1/m", sensor.info().name);
    }
}

#[test]
fn disparities_of_a_pair_are_fine_steps_about_the_truth() {
    let frame = wall(SensorModel::Stereo, [640, 480], 1);
    let exact = 580.0 * 0.09 / 3.0 * 256.0;
    let values: Vec<f64> = (0..640 * 480).map(|at| frame.value(at)).filter(|&value| value > 0.0).collect();
    // The right camera does not see the first f b / z = 17.4 columns.
    assert_eq!(values.len(), (640 - 17) * 480);
    assert!(values.iter().all(|value| (value - exact).abs() < 256.0 * 2.0), "within two pixels");
    assert!(values.iter().filter(|&&value| value as u32 % 2 == 1).count() > values.len() / 3);
}
