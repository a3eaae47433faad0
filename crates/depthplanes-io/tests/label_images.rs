//! Label images and masks are named for what they are, whatever their sample type and format; maps of few values are not.

mod common;

use common::{npy, pfm_of};
use depthplanes_io::encoding::Stereo;
use depthplanes_io::{Frame, ReadOptions, decode, read};

const SIZE: [usize; 2] = [120, 90];

/// Regions around places that are scattered, as numbers from 0.
fn regions(count: usize, seed: usize) -> Vec<usize> {
    let place = |region: usize| {
        let hash = (region + 17 * seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        [(hash >> 20) % SIZE[0], (hash >> 40) % SIZE[1]]
    };
    let nearest = |at: usize| {
        let [u, v] = [at % SIZE[0], at / SIZE[0]];
        (0..count).min_by_key(|&region| {
            let [x, y] = place(region);
            x.abs_diff(u).pow(2) + y.abs_diff(v).pow(2)
        })
    };
    (0..SIZE[0] * SIZE[1]).map(|at| nearest(at).unwrap()).collect()
}

/// Labels of as many regions: from 0, from 1, and those of regions with 0 between them.
fn label_images() -> Vec<(String, Vec<u16>)> {
    let mut images = Vec::new();
    for (count, seed) in [(3, 1), (7, 2), (12, 3), (20, 4), (40, 5)] {
        let regions = regions(count, seed);
        let is_border = |at: usize| {
            [1, SIZE[0], SIZE[0] + 1]
                .iter()
                .any(|step| regions.get(at + step).is_some_and(|other| *other != regions[at]))
        };
        let image = |label: &dyn Fn(usize) -> usize| (0..regions.len()).map(|at| label(at) as u16).collect();
        images.push((format!("{count} from 0"), image(&|at| regions[at])));
        images.push((format!("{count} from 1"), image(&|at| regions[at] + 1)));
        images
            .push((format!("{count} with borders of 0"), image(&|at| if is_border(at) { 0 } else { regions[at] + 1 })));
        images.push((format!("{count} in tens"), image(&|at| 10 * regions[at])));
        images.push((format!("a mask, {count}"), image(&|at| regions[at] % 2)));
    }
    images
}

fn shape() -> String {
    format!("({}, {})", SIZE[1], SIZE[0])
}

fn floats(values: impl Iterator<Item = f32>) -> Vec<u8> {
    values.flat_map(f32::to_le_bytes).collect()
}

/// An image as files of all kinds that hold floats, and of integers.
fn files(labels: &[u16]) -> Vec<(&'static str, Vec<u8>)> {
    let as_floats: Vec<f32> = labels.iter().map(|&label| f32::from(label)).collect();
    let doubles = labels.iter().flat_map(|&label| f64::from(label).to_le_bytes()).collect::<Vec<_>>();
    vec![
        ("float32", npy("<f4", false, &shape(), &floats(as_floats.iter().copied()))),
        ("float64", npy("<f8", false, &shape(), &doubles)),
        (
            "uint16",
            npy("<u2", false, &shape(), &labels.iter().flat_map(|label| label.to_le_bytes()).collect::<Vec<_>>()),
        ),
        (
            "int32",
            npy("<i4", false, &shape(), &labels.iter().flat_map(|&x| i32::from(x).to_le_bytes()).collect::<Vec<_>>()),
        ),
        ("pfm", pfm_of(SIZE, &as_floats)),
        #[cfg(feature = "tiff")]
        ("tiff", {
            let mut file = std::io::Cursor::new(Vec::new());
            let mut encoder = tiff::encoder::TiffEncoder::new(&mut file).unwrap();
            let [width, height] = SIZE.map(|side| side as u32);
            encoder.write_image::<tiff::encoder::colortype::Gray32Float>(width, height, &as_floats).unwrap();
            file.into_inner()
        }),
        #[cfg(feature = "exr")]
        ("exr", common::exr_of(SIZE, &as_floats)),
    ]
}

fn is_told(frame: &Frame) -> bool {
    frame.warnings.iter().any(|note| note.contains("is this a label image or a mask"))
}

#[test]
fn label_images_are_named_whatever_their_type() {
    for (name, labels) in label_images() {
        for (kind, file) in files(&labels) {
            for encoding in [None, Some("metre"), Some("millimetre")] {
                let options = ReadOptions { encoding: encoding.map(str::to_string), ..Default::default() };
                let frame = decode(&file, "map", &options).unwrap();
                assert!(is_told(&frame), "{name}, {kind}, {encoding:?}: {:?}", frame.warnings);
                // Nothing else is said of numbers that are names.
                let others = frame.warnings.iter().filter(|note| note.contains("try --"));
                assert_eq!(others.count(), 0, "{name}, {kind}: {:?}", frame.warnings);
            }
        }
    }
}

#[test]
fn stated_disparity_of_few_steps_is_none() {
    for (name, labels) in label_images() {
        let rig = Stereo { focal_px: 100.0, baseline_m: 0.1, doffs_px: 0.0 };
        for (kind, file) in files(&labels) {
            for options in [
                ReadOptions { disparity: true, ..Default::default() },
                ReadOptions { stereo: Some(rig), ..Default::default() },
                ReadOptions { encoding: Some("disparity".into()), ..Default::default() },
                ReadOptions { encoding: Some("inverse-depth".into()), ..Default::default() },
            ] {
                let frame = decode(&file, "map", &options).unwrap();
                assert!(!is_told(&frame), "{name}, {kind}: {:?}", frame.warnings);
            }
        }
    }
}

#[test]
fn surfaces_in_few_steps_are_no_label_images() {
    let slanted = |at: usize, by: f64| {
        let [u, v] = [(at % SIZE[0]) as f64, (at / SIZE[0]) as f64];
        let step = if u > 60.0 && v > 40.0 { 30.0 } else { 12.0 + by * v + 0.5 * by * u };
        step.round()
    };
    for by in [0.1, 0.2, 0.3] {
        for (name, unit) in [("pixels", 1.0), ("whole pixels in 1/8", 8.0), ("decimetres", 100.0)] {
            let values: Vec<u16> = (0..SIZE[0] * SIZE[1]).map(|at| (unit * slanted(at, by)) as u16).collect();
            for (kind, file) in files(&values) {
                let frame = decode(&file, "map", &ReadOptions::default()).unwrap();
                assert!(!is_told(&frame), "{name} {by} {kind}: {:?}", frame.warnings);
            }
        }
    }
    // Floats that are no whole numbers.
    let levels = regions(9, 1);
    let metres = npy("<f4", false, &shape(), &floats(levels.iter().map(|&level| 1.0 + 0.3 * level as f32)));
    assert!(!is_told(&decode(&metres, "map", &ReadOptions::default()).unwrap()));
}

#[test]
fn recorded_disparity_of_few_steps_is_none_or_may_be_stated() {
    let Some(data) = common::data() else { return };
    for name in ["barn2/disp2.pgm", "barn2/disp6.pgm", "map/disp0.pgm", "bull/disp2.pgm"] {
        let frame = read(data.join("middlebury").join(name), &ReadOptions::default()).unwrap();
        assert!(!is_told(&frame), "{name}: {:?}", frame.warnings);
    }
    // Seven surfaces that all face the camera cannot be told from labels.
    let tsukuba = data.join("middlebury/tsukuba/disp3.pgm");
    let frame = read(&tsukuba, &ReadOptions::default()).unwrap();
    assert!(frame.warnings.iter().any(|note| note.contains("state --disparity if it is")), "{:?}", frame.warnings);
    let stated = read(&tsukuba, &ReadOptions { disparity: true, ..Default::default() }).unwrap();
    assert!(!is_told(&stated), "{:?}", stated.warnings);
    for name in ["felix_0", "rspl_1", "lpvo_hall_169", "stereo_002249", "tum_fr3", "mosd_learn33"] {
        let frame = read(data.join(format!("gt_real/{name}.labels.png")), &ReadOptions::default()).unwrap();
        assert!(is_told(&frame), "{name}: {:?}", frame.warnings);
    }
}
