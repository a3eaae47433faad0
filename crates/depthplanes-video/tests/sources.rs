//! Every source, from files made on the spot.

use depthplanes_io::ReadOptions;
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::outputs::grey16_png;
use depthplanes_video::{Error, SOURCES, Source, SourceOptions, VideoFrame, open};
use std::path::{Path, PathBuf};

/// An empty folder that belongs to one test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap();
        Folder(folder)
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        let path = self.0.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }

    /// A map of 64 x 48 pixels with that value everywhere.
    fn map(&self, name: &str, value: u16) {
        self.write(name, &grey16_png(64, 48, &[value; 64 * 48]));
    }

    fn word(&self) -> &str {
        self.0.to_str().unwrap()
    }

    fn open(&self) -> Box<dyn Source> {
        open(self.word(), &SourceOptions::default()).unwrap()
    }
}

fn all(source: &mut dyn Source) -> Vec<Result<VideoFrame, Error>> {
    std::iter::from_fn(|| source.next_frame()).collect()
}

/// The middle pixel, metres, to a micrometre.
fn metres(frame: &VideoFrame) -> f64 {
    let depth = depthplanes::with_view!(frame.frame.view().unwrap(), view => f64::from(view.row(24)[32]));
    (frame.frame.sensor.value_kind.depth_m(depth).unwrap() * 1e6).round() / 1e6
}

#[test]
fn a_folder_comes_in_natural_order_with_the_times_of_its_names_and_goes_on_behind_what_is_broken() {
    let folder = Folder::new("folder");
    for (name, value) in [("2_1580908150233.png", 1002), ("10_1580908150266.png", 1010), ("1_1580908150200.png", 1001)]
    {
        folder.map(name, value);
    }
    folder.write("3_1580908150240.png", b"\x89PNG\r\n\x1a\nbroken");
    folder.write("notes.txt", b"no map");
    folder.map("1_1580908150200.labels.png", 7); // a result of this program
    let mut source = folder.open();
    assert_eq!(source.frames(), Some(4));
    let frames = all(source.as_mut());
    let seen: Vec<_> = frames.iter().flatten().map(|frame| (frame.index, metres(frame))).collect();
    assert_eq!(seen, [(0, 1.001), (1, 1.002), (3, 1.010)]);
    assert!(frames[2].as_ref().unwrap_err().to_string().contains("3_1580908150240.png"), "{:?}", frames[2]);
    assert_eq!(frames[1].as_ref().unwrap().time_s, Some(1_580_908_150.233));
    assert!(source.seek(1));
    assert_eq!(source.next_frame().unwrap().unwrap().index, 1);
}

#[test]
fn tum_has_times_poses_and_its_own_unit() {
    let folder = Folder::new("tum");
    folder.write("depth.txt", b"# depth maps\n1.00 depth/a.png\n1.03 depth/b.png\n1.06 depth/c.png\n");
    for (name, value) in [("a", 5000), ("b", 10_000), ("c", 15_000)] {
        folder.map(&format!("depth/{name}.png"), value);
    }
    folder.write("groundtruth.txt", b"# time tx ty tz qx qy qz qw\n1.001 0.5 0 0 0 0 0 1\n1.2 9 9 9 0 0 0 1\n");
    let frames: Vec<VideoFrame> = all(folder.open().as_mut()).into_iter().map(Result::unwrap).collect();
    assert_eq!(frames.iter().map(metres).collect::<Vec<_>>(), [1.0, 2.0, 3.0]);
    assert_eq!(frames[0].pose.unwrap().translation_m(), [0.5, 0.0, 0.0]);
    assert!(frames[1].pose.is_none(), "a pose that is 29 ms away is none of this frame");
    assert_eq!(frames[2].time_s, Some(1.06));
    folder.write("depth.txt", b"1.00 depth/a.png\nnonsense\n");
    let error = open(folder.word(), &SourceOptions::default()).unwrap_err().to_string();
    assert!(error.contains("depth.txt:2: `nonsense`"), "{error}");
    folder.write("depth.txt", b"1.00 depth/gone.png\n");
    let error = open(folder.word(), &SourceOptions::default()).unwrap_err().to_string();
    assert!(error.contains("there is no file depth/gone.png"), "{error}");
}

#[test]
fn seven_scenes_has_poses_its_camera_and_its_missing_value() {
    let folder = Folder::new("seven");
    folder.map("frame-000000.depth.png", 2000);
    folder.map("frame-000001.depth.png", 65_535);
    folder.write("frame-000000.pose.txt", b"1 0 0 0.25\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    let frames = all(folder.open().as_mut());
    let frame = frames[0].as_ref().unwrap();
    assert_eq!((frame.pose.unwrap().translation_m(), metres(frame)), ([0.25, 0.0, 0.0], 2.0));
    let nominal = |frame: &VideoFrame| frame.frame.warnings.iter().any(|note| note.contains("that of 7-Scenes, 585"));
    assert!(nominal(frame), "{:?}", frame.frame.warnings);
    folder.write("camera-intrinsics.txt", b"50 0 32\n0 50 24\n0 0 1\n");
    let stated = all(folder.open().as_mut());
    let stated = stated[0].as_ref().unwrap();
    assert_eq!((stated.frame.sensor.intrinsics.unwrap().fx, nominal(stated)), (50.0, false));
    // The same names without a pose are any folder, whose camera nobody knows.
    let other = Folder::new("seven_without_poses");
    other.map("a.depth.png", 2000);
    let unknown = all(other.open().as_mut());
    assert_eq!(unknown[0].as_ref().unwrap().frame.sensor.intrinsics, None);
    let valid = depthplanes::with_view!(frames[1].as_ref().unwrap().frame.view().unwrap(), view => view.valid_pixels());
    assert_eq!((frames[1].as_ref().unwrap().pose, valid), (None, 0));
    folder.write("frame-000000.pose.txt", b"1 0 0 0.25\n0 1 0");
    let frames = all(folder.open().as_mut());
    assert!(frames[0].as_ref().unwrap_err().to_string().contains("7 numbers; accepted: four rows of four numbers"));
    assert!(frames[1].is_ok(), "a broken pose is of that frame alone");
}

#[test]
fn a_synthetic_camera_moves_and_knows_where_it_is() {
    let mut source = open("scene:room:size=64x48,frames=3", &SourceOptions::default()).unwrap();
    let frames: Vec<VideoFrame> = all(source.as_mut()).into_iter().map(Result::unwrap).collect();
    assert_eq!((frames.len(), source.frames()), (3, Some(3)));
    assert_ne!(frames[0].pose, frames[2].pose);
    assert!((frames[2].time_s.unwrap() - 2.0 / 30.0).abs() < 1e-12);
    let mut still = open("scene:room:size=64x48,frames=2,speed=0,pose=none", &SourceOptions::default()).unwrap();
    let frames: Vec<VideoFrame> = all(still.as_mut()).into_iter().map(Result::unwrap).collect();
    assert!(frames[0].pose.is_none() && frames[0].frame.pixels != frames[1].frame.pixels, "the noise differs");
    // Up is that of its world, if it is asked for it.
    assert!(frames[0].up.is_none());
    let mut knowing = open("scene:room:size=64x48,frames=2,up=known,pose=none", &SourceOptions::default()).unwrap();
    let [x, y, z] = all(knowing.as_mut()).remove(1).unwrap().up.unwrap();
    assert!((x * x + y * y + z * z - 1.0).abs() < 1e-12 && y < -0.9, "{x} {y} {z}");
    for word in [
        "scene:room:frames=x",
        "scene:room:speed=inf",
        "scene:room:pose=some",
        "scene:room:up=0",
        "scene:nowhere",
        "scene:room:zoom=2",
    ] {
        assert!(open(word, &SourceOptions::default()).is_err(), "{word}");
    }
}

#[test]
fn what_is_no_source_is_said_with_what_is() {
    let error = open("/nowhere/at/all", &SourceOptions::default()).unwrap_err().to_string();
    assert!(error.starts_with("/nowhere/at/all: there is no such file or folder"), "{error}");
    assert!(SOURCES.iter().all(|source| error.contains(source.about)), "{error}");
    let empty = Folder::new("empty");
    let error = open(empty.word(), &SourceOptions::default()).unwrap_err().to_string();
    assert!(error.ends_with("no map in this folder; accepted: a folder of maps, such as *.png or *.npy"), "{error}");
    let (set, wall) = (Folder::new("a_set"), Folder::new("a_set/depth"));
    wall.map("1.png", 2000);
    let error = open(set.word(), &SourceOptions::default()).unwrap_err().to_string();
    assert!(error.ends_with(&format!("such as {}", wall.word())), "{error}");
    let map = format!("{}/1.png", wall.word());
    let error = open(&map, &SourceOptions::default()).unwrap_err().to_string();
    assert!(error.contains("one map, no video") && error.contains("`depthplanes detect`"), "{error}");
    let error = open(&format!("{map}:camera/depth"), &SourceOptions::default()).unwrap_err().to_string();
    assert!(error.ends_with(&format!("without a slash; accepted: {map}:/camera/depth")), "{error}");
    let decode = DecodeOptions { raw_type: Some("uint17".into()), raw_size: Some((4, 3)), ..DecodeOptions::default() };
    let options = SourceOptions::default().read(ReadOptions { decode, ..ReadOptions::default() });
    assert!(open("-", &options).unwrap_err().to_string().contains("uint17"));
    assert!(open("-", &SourceOptions::default()).unwrap_err().to_string().contains("--raw-size"));
}
