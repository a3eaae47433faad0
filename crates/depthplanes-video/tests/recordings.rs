//! Recordings in MCAP, whole and broken, made on the spot. Those of other programs are in `tests/oracles/test_mcap.py`.

use depthplanes_io::Pixels;
use depthplanes_video::mcap::{Topic, Writer};
use depthplanes_video::{Error, SourceOptions, VideoFrame, open};
use proptest::prelude::*;
use ruzstd::encoding::{CompressionLevel, compress_to_vec};
use std::path::{Path, PathBuf};

const SIZE: [u32; 2] = [8, 6];
const TOPIC: &str = "/camera/depth/image_raw";

/// An empty folder that belongs to one test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// A message in CDR, little-endian.
struct Cdr(Vec<u8>);

impl Cdr {
    /// With its header.
    fn new(second: u32, frame_id: &str) -> Self {
        Cdr(vec![0, 1, 0, 0]).header(second, frame_id)
    }

    fn header(self, second: u32, frame_id: &str) -> Self {
        self.number(second).number(500_000_000).text(frame_id)
    }

    /// Zeros up to a multiple of so many bytes, counted from behind the encoding.
    fn aligned(mut self, to: usize) -> Self {
        self.0.resize((self.0.len() - 4).next_multiple_of(to) + 4, 0);
        self
    }

    fn number(self, number: u32) -> Self {
        self.aligned(4).bytes(&number.to_le_bytes())
    }

    fn text(self, text: &str) -> Self {
        self.number(text.len() as u32 + 1).bytes(text.as_bytes()).bytes(&[0])
    }

    fn floats(self, numbers: &[f64]) -> Self {
        numbers.iter().fold(self.aligned(8), |cdr, number| cdr.bytes(&number.to_le_bytes()))
    }

    fn bytes(mut self, bytes: &[u8]) -> Self {
        self.0.extend(bytes);
        self
    }
}

/// `sensor_msgs/msg/Image`: a map with that value everywhere.
fn image(value: u16, encoding: &str, second: u32) -> Vec<u8> {
    let cdr = Cdr::new(second, "optical").number(SIZE[1]).number(SIZE[0]).text(encoding).bytes(&[0]);
    // Different pixels, so that a chunk is not a few bytes.
    let pixels: Vec<u8> = (0..SIZE[0] * SIZE[1]).flat_map(|at| (value + (at * at % 97) as u16).to_le_bytes()).collect();
    cdr.number(2 * SIZE[0]).number(2 * SIZE[0] * SIZE[1]).bytes(&pixels).0
}

/// `sensor_msgs/msg/Imu` with that specific force; without an orientation and a gyroscope.
fn imu(force: [f64; 3], frame_id: &str) -> Vec<u8> {
    let unknown = [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let cdr = Cdr::new(0, frame_id).floats(&[0.0; 4]).floats(&unknown);
    cdr.floats(&[0.0; 3]).floats(&unknown).floats(&force).floats(&[0.0; 9]).0
}

/// `tf2_msgs/msg/TFMessage`: frames of coordinates in their parents, as quaternions.
fn transforms(frames: &[(&str, &str, [f64; 4])]) -> Vec<u8> {
    let begun = Cdr(vec![0, 1, 0, 0]).number(frames.len() as u32);
    let add = |cdr: Cdr, (parent, child, turn): &(&str, &str, [f64; 4])| {
        cdr.header(0, parent).text(child).floats(&[0.1, 0.2, 0.3]).floats(turn)
    };
    frames.iter().fold(begun, add).0
}

fn topic(name: &'static str) -> Topic<'static> {
    let schema = "sensor_msgs/msg/Image";
    Topic { name, encoding: "cdr", schema, schema_encoding: "ros2msg", description: b"" }
}

const FRAMES: u16 = 6;

/// Where records begin.
fn heads(bytes: &[u8]) -> Vec<usize> {
    let next = |at: &usize| {
        let length = u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap());
        Some(at + 9 + length as usize).filter(|at| *at < bytes.len() - 8)
    };
    std::iter::successors(Some(8), next).collect()
}

/// A recording of some frames, a second apart, a chunk for each; the bytes, and where each chunk ends.
fn recording() -> (Vec<u8>, Vec<usize>) {
    let mut bytes = Vec::new();
    let mut ends = Vec::new();
    let mut writer = Writer::new(&mut bytes, &[topic(TOPIC)]).unwrap();
    let mut chunks = Vec::new();
    for index in 0..FRAMES {
        let time = u64::from(index) * 1_000_000_000 + 7;
        writer.chunk(&[(0, time, &image(1000 + index, "16UC1", index.into()))]).unwrap();
        chunks.push(time);
    }
    writer.finish().unwrap();
    let heads = heads(&bytes);
    // A chunk is record 6.
    ends.extend(heads.windows(2).filter(|pair| bytes[pair[0]] == 6).map(|pair| pair[1]));
    assert_eq!(ends.len(), chunks.len());
    (bytes, ends)
}

/// The same messages as records one after the other, without a summary: by themselves, or each in a chunk of that
/// compression; and where each ends.
fn records(compression: Option<&str>) -> (Vec<u8>, Vec<usize>) {
    let (whole, _) = recording();
    let mut bytes = whole[..8].to_vec();
    let record = |bytes: &mut Vec<u8>, op: u8, content: &[u8]| {
        bytes.push(op);
        bytes.extend((content.len() as u64).to_le_bytes());
        bytes.extend(content);
    };
    let text = |text: &str| [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat();
    record(&mut bytes, 1, &[text("ros2"), text("test")].concat());
    let schema = [&1u16.to_le_bytes()[..], &text("sensor_msgs/msg/Image"), &text("ros2msg"), &text("")].concat();
    record(&mut bytes, 3, &schema);
    let channel = [&0u16.to_le_bytes()[..], &1u16.to_le_bytes(), &text(TOPIC), &text("cdr"), &[0; 4]].concat();
    record(&mut bytes, 4, &channel);
    let mut ends = Vec::new();
    for index in 0..FRAMES {
        let time = (u64::from(index) * 1_000_000_000 + 7).to_le_bytes();
        let head = [&0u16.to_le_bytes()[..], &u32::from(index).to_le_bytes(), &time, &time].concat();
        let message = [head, image(1000 + index, "16UC1", index.into())].concat();
        if let Some(name) = compression {
            let mut inner = Vec::new();
            record(&mut inner, 5, &message);
            let packed = match name {
                "zstd" => compress_to_vec(&inner[..], CompressionLevel::Fastest),
                _ => inner.clone(),
            };
            let sizes = [&(inner.len() as u64).to_le_bytes()[..], &crc32fast::hash(&inner).to_le_bytes()].concat();
            let packed = [&text(name)[..], &(packed.len() as u64).to_le_bytes(), &packed].concat();
            record(&mut bytes, 6, &[&time[..], &time, &sizes, &packed].concat());
        } else {
            record(&mut bytes, 5, &message);
        }
        ends.push(bytes.len());
    }
    record(&mut bytes, 15, &[0; 4]);
    record(&mut bytes, 2, &[0; 20]);
    bytes.extend(&whole[..8]);
    (bytes, ends)
}

const IMU: &str = "/imu/data";
/// The axes of a camera's optical frame in the camera's (REP 103).
const OPTICAL: (&str, &str, [f64; 4]) = ("camera", "optical", [-0.5, 0.5, -0.5, 0.5]);

/// A topic, when in nanoseconds, and a message.
type Said = (u16, u64, Vec<u8>);

/// A recording with an inertial sensor and transforms beside the maps, a chunk for each frame with what `more` says beside it;
/// and where each chunk ends.
fn beside(more: impl Fn(u64) -> Vec<Said>) -> (Vec<u8>, Vec<usize>) {
    let other = |name, schema| Topic { name, schema, ..topic("") };
    let topics = [
        topic(TOPIC),
        other(IMU, "sensor_msgs/msg/Imu"),
        other("/tf_static", "tf2_msgs/msg/TFMessage"),
        other("/base/imu", "sensor_msgs/msg/Imu"),
    ];
    let mut bytes = Vec::new();
    let mut writer = Writer::new(&mut bytes, &topics).unwrap();
    for index in 0..FRAMES {
        let time = u64::from(index) * 1_000_000_000 + 7;
        let mut said = more(time);
        said.push((0, time, image(1000 + index, "16UC1", index.into())));
        let said: Vec<_> = said.iter().map(|(topic, time, data)| (*topic, *time, &data[..])).collect();
        writer.chunk(&said).unwrap();
    }
    writer.finish().unwrap();
    let heads = heads(&bytes);
    let ends = heads.windows(2).filter(|pair| bytes[pair[0]] == 6).map(|pair| pair[1]).collect();
    (bytes, ends)
}

/// One whose sensor, level under a camera, rests.
fn with_gravity() -> (Vec<u8>, Vec<usize>) {
    beside(|time| {
        let frames = transforms(&[OPTICAL, ("camera", "imu", [0.0, 0.0, 0.0, 1.0])]);
        vec![(2, time, frames), (1, time, imu([0.0, 0.0, 9.8], "imu"))]
    })
}

/// All forms.
fn recordings() -> [(Vec<u8>, Vec<usize>); 5] {
    [recording(), with_gravity(), records(None), records(Some("")), records(Some("zstd"))]
}

fn frames(word: &str) -> Result<Vec<Result<VideoFrame, Error>>, Error> {
    let mut source = open(word, &SourceOptions::default())?;
    Ok(std::iter::from_fn(|| source.next_frame()).take(1000).collect())
}

/// Frames of these bytes as a file.
fn frames_of(path: &Path, bytes: &[u8]) -> Result<Vec<Result<VideoFrame, Error>>, Error> {
    // A file that is written over is flushed to the disk each time; a new one is not.
    let _ = std::fs::remove_file(path);
    std::fs::write(path, bytes).unwrap();
    frames(path.to_str().unwrap())
}

fn first(frame: &VideoFrame) -> u16 {
    match &frame.frame.pixels {
        Pixels::U16(pixels) => pixels[0],
        other => panic!("{other:?}"),
    }
}

#[test]
fn frames_have_their_stamps_and_can_be_sought() {
    let folder = folder("mcap_whole");
    let (bytes, _) = recording();
    let path = folder.join("walk.mcap");
    let found: Vec<VideoFrame> = frames_of(&path, &bytes).unwrap().into_iter().map(Result::unwrap).collect();
    let expected: Vec<(u64, u16, Option<f64>)> =
        (0..FRAMES).map(|at| (at.into(), 1000 + at, Some(f64::from(at) + 0.5))).collect();
    let seen = |frame: &VideoFrame| (frame.index, first(frame), frame.time_s);
    assert_eq!(found.iter().map(seen).collect::<Vec<_>>(), expected);
    assert_eq!(found[3].name, format!("{TOPIC}#3"));
    assert_eq!((found[0].frame.encoding, found[0].frame.format), ("millimetre", "raw"));
    let mut source = open(&format!("{}:{TOPIC}", path.display()), &SourceOptions::default()).unwrap();
    assert_eq!(source.frames(), Some(FRAMES.into()));
    for index in [4, 1, 5] {
        assert!(source.seek(index));
        assert_eq!(seen(&source.next_frame().unwrap().unwrap()), expected[index as usize]);
    }
    assert!(source.next_frame().is_none() && source.next_frame().is_none());
    assert!(source.seek(100) && source.next_frame().is_none());
    assert!(source.seek(2) && source.next_frame().is_some());
    // Without a summary nobody knows how many there are, nor where: it is read from its beginning.
    for (bytes, _) in &recordings()[1..] {
        let found = frames_of(&path, bytes).unwrap();
        assert_eq!(found.iter().map(|frame| seen(frame.as_ref().unwrap())).collect::<Vec<_>>(), expected);
    }
    let mut source = open(path.to_str().unwrap(), &SourceOptions::default()).unwrap();
    assert_eq!(source.frames(), None);
    for index in [4, 1, 5] {
        assert!(source.seek(index));
        assert_eq!(seen(&source.next_frame().unwrap().unwrap()), expected[index as usize]);
    }
    assert!(source.next_frame().is_none());
    assert!(source.seek(100) && source.next_frame().is_none());
    assert!(source.seek(0) && source.next_frame().is_some());
}

#[test]
fn a_file_that_is_cut_off_anywhere_gives_every_whole_message_and_one_error() {
    let folder = folder("mcap_cut");
    let path = folder.join("walk.mcap");
    for (bytes, ends) in recordings() {
        let data_end = *ends.last().unwrap();
        for cut in 0..bytes.len() {
            let whole = ends.iter().filter(|end| **end <= cut).count();
            let found = match frames_of(&path, &bytes[..cut]) {
                Ok(found) => found,
                Err(error) => {
                    let error = error.to_string();
                    assert!(whole == 0 && error.contains("walk.mcap"), "cut at {cut}: {error}");
                    continue;
                }
            };
            let good: Vec<u16> = found.iter().flatten().map(first).collect();
            assert!(
                good.iter().copied().eq((1000..).take(good.len())) && good.len() >= whole,
                "cut at {cut}: {good:?}"
            );
            // A chunk may give what is in it without its last bytes.
            assert!(good.len() <= whole + 1, "cut at {cut}");
            if cut < data_end {
                let error = found.last().unwrap().as_ref().unwrap_err().to_string();
                assert!(error.contains("killed") || error.contains("the file ends"), "cut at {cut}: {error}");
            }
            assert!(found.iter().filter(|frame| frame.is_err()).count() <= 1, "cut at {cut}");
        }
    }
}

#[test]
fn a_byte_that_is_flipped_leaves_what_stands_before_it() {
    let folder = folder("mcap_flipped");
    let path = folder.join("walk.mcap");
    for (bytes, ends) in [recording(), with_gravity(), records(Some("zstd"))] {
        let heads = heads(&bytes);
        for (at, mask) in (8..bytes.len()).step_by(11).flat_map(|at| [(at, 0x01), (at, 0x80), (at, 0xff)]) {
            let mut other = bytes.clone();
            other[at] ^= mask;
            let Ok(found) = frames_of(&path, &other) else { continue };
            let before = ends.iter().filter(|end| **end <= at).count();
            let good: Vec<u16> = found.iter().flatten().map(first).collect();
            // What a record is has no checksum: others are skipped, as the format wants it.
            if at >= ends[0] && at < *ends.last().unwrap() && !heads.contains(&at) {
                assert!(good.iter().copied().take(before).eq((1000..).take(before)), "{at}: {good:?}");
                // No frame is missing without a word.
                let is_said = found.last().is_some_and(Result::is_err);
                assert!(is_said || good.iter().copied().eq((1000..).take(FRAMES.into())), "{at}: {good:?}");
            }
            assert!(good.len() <= FRAMES.into() && found.iter().filter(|frame| frame.is_err()).count() <= 1, "{at}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn bytes_that_are_changed_never_make_it_panic(
        changes in prop::collection::vec((0usize..10_000, any::<u8>()), 1..20),
        cut in 0usize..10_000,
        form in 0usize..5,
    ) {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mcap_random");
        std::fs::create_dir_all(&folder).unwrap();
        let (mut bytes, _) = recordings()[form].clone();
        let length = bytes.len();
        for (at, value) in changes {
            bytes[at % length] = value;
        }
        bytes.truncate(length.saturating_sub(cut / 10));
        if let Ok(found) = frames_of(&folder.join("walk.mcap"), &bytes) {
            prop_assert!(found.len() <= 2 * usize::from(FRAMES) + 1);
        }
    }
}

#[test]
fn what_a_message_says_wrongly_is_of_that_frame_alone() {
    let folder = folder("mcap_messages");
    let path = folder.join("walk.mcap");
    let write = |messages: &[Vec<u8>]| {
        let mut bytes = Vec::new();
        let mut writer = Writer::new(&mut bytes, &[topic(TOPIC)]).unwrap();
        for (at, message) in (0..).zip(messages) {
            writer.chunk(&[(0, at, message)]).unwrap();
        }
        writer.finish().unwrap();
        bytes
    };
    let good = image(1000, "16UC1", 1);
    let cut = good[..good.len() - 1].to_vec();
    let colour = image(1000, "rgb8", 2);
    let found = frames_of(&path, &write(&[good.clone(), cut, colour, good.clone()])).unwrap();
    let errors: Vec<String> = found.iter().flat_map(|frame| frame.as_ref().err()).map(Error::to_string).collect();
    assert_eq!((found.len(), errors.len()), (4, 2), "{errors:?}");
    assert!(errors[0].contains("#1") && errors[0].contains("bytes are needed"), "{}", errors[0]);
    assert!(errors[1].contains("a picture in `rgb8`; accepted: 16UC1, mono16, 32FC1"), "{}", errors[1]);
    let error = frames_of(&path, &write(&[image(1000, "rgb8", 1)])).unwrap_err().to_string();
    assert!(error.contains("no depth in it") && error.contains(TOPIC), "{error}");
    let error = frames_of(&path, &write(&[])).unwrap_err().to_string();
    assert!(error.contains("no depth in it"), "{error}");
    let error = frames_of(&path, b"\x28\xb5\x2f\xfdmore").unwrap_err().to_string();
    assert!(error.contains("zstd -d"), "{error}");
}

#[test]
fn a_chunk_that_claims_more_than_the_limit_is_refused_before_it_is_unpacked() {
    let folder = folder("mcap_limit");
    let path = folder.join("walk.mcap");
    let (bytes, _) = recording();
    std::fs::write(&path, &bytes).unwrap();
    let mut options = SourceOptions::default();
    options.read.decode.limits.max_bytes = 100;
    let error = open(path.to_str().unwrap(), &options).unwrap_err().to_string();
    assert!(error.contains("the limit is 100"), "{error}");
}

#[test]
fn a_bag_without_metadata_is_its_files_in_natural_order() {
    let folder = folder("rosbag2_killed");
    let (bytes, ends) = recording();
    std::fs::write(folder.join("walk_10.mcap"), &bytes[..ends[2]]).unwrap();
    std::fs::write(folder.join("walk_9.mcap"), &bytes).unwrap();
    let found = frames(folder.to_str().unwrap()).unwrap();
    let good: Vec<u64> = found.iter().flatten().map(|frame| frame.index).collect();
    assert_eq!(good, (0..9).collect::<Vec<u64>>());
    assert!(found[9].as_ref().unwrap_err().to_string().contains("walk_10.mcap"), "{:?}", found[9]);
    assert_eq!(found.len(), 10);
    // One that is cut off is sought from the beginning of the first.
    let mut source = open(folder.to_str().unwrap(), &SourceOptions::default()).unwrap();
    for index in [8, 2, 7] {
        assert!(source.seek(index));
        let frame = source.next_frame().unwrap().unwrap();
        assert_eq!((frame.index, first(&frame)), (index, 1000 + index as u16 % FRAMES));
    }
    // Of whole files it is known beforehand how many frames there are, and where.
    std::fs::write(folder.join("walk_10.mcap"), &bytes).unwrap();
    let mut source = open(folder.to_str().unwrap(), &SourceOptions::default()).unwrap();
    assert_eq!(source.frames(), Some(12));
    for index in [7, 0, 6, 11, 5] {
        assert!(source.seek(index));
        let frame = source.next_frame().unwrap().unwrap();
        assert_eq!((frame.index, first(&frame)), (index, 1000 + index as u16 % FRAMES));
    }
    assert_eq!(source.next_frame().unwrap().unwrap().index, 6);
    std::fs::write(folder.join("walk_11.db3"), b"SQLite format 3\0").unwrap();
    let error = frames(folder.to_str().unwrap()).unwrap_err().to_string();
    assert!(error.contains("a bag in SQLite") && error.contains("ros2 bag convert"), "{error}");
}

/// Up of each frame of these bytes, and the notes of the last.
fn ups(path: &Path, bytes: &[u8], topics: &str) -> (Vec<Option<[f64; 3]>>, Vec<String>) {
    std::fs::write(path, bytes).unwrap();
    let found = frames(&format!("{}{topics}", path.display())).unwrap();
    let found: Vec<VideoFrame> = found.into_iter().map(Result::unwrap).collect();
    (found.iter().map(|frame| frame.up).collect(), found[found.len() - 1].frame.warnings.clone())
}

/// Whether every frame has that direction.
fn assert_all(ups: &[Option<[f64; 3]>], direction: [f64; 3]) {
    for up in ups {
        let up = up.unwrap();
        let length = up.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!(up.iter().zip(direction).all(|(a, b)| (a / length - b).abs() < 1e-6), "{up:?} {direction:?}");
    }
}

#[test]
fn what_an_accelerometer_says_is_turned_into_the_cameras_axes() {
    let path = folder("gravity").join("walk.mcap");
    // Level, x ahead and z up: y of the optical frame points down.
    let (up, notes) = ups(&path, &with_gravity().0, "");
    assert_all(&up, [0.0, -1.0, 0.0]);
    assert!(notes.iter().all(|note| !note.contains("up is")), "{notes:?}");
    // The same by an axis of its own, and at any frame that is gone to.
    let (bytes, _) = beside(|time| vec![(1, time, imu([0.0, -9.0, -4.0], "optical"))]);
    let (sine, cosine) = (-4.0 / 97f64.sqrt(), -9.0 / 97f64.sqrt());
    assert_all(&ups(&path, &bytes, "").0, [0.0, cosine, sine]);
    let mut source = open(path.to_str().unwrap(), &SourceOptions::default()).unwrap();
    for index in [4, 1] {
        assert!(source.seek(index));
        let frame = source.next_frame().unwrap().unwrap();
        assert_eq!((frame.index, first(&frame)), (index, 1000 + index as u16));
        assert_all(&[frame.up], [0.0, cosine, sine]);
    }
    assert!(source.seek(100) && source.next_frame().is_none());
    // What was said half a second before a frame without a gyroscope is no longer so.
    let (bytes, _) = beside(|time| vec![(1, time.saturating_sub(500_000_000), imu([0.0, -9.8, 0.0], "optical"))]);
    let (late, _) = ups(&path, &bytes, "");
    assert!(late[0].is_some() && late[1..].iter().all(Option::is_none), "{late:?}");
}

#[test]
fn why_up_is_not_known_is_said() {
    let path = folder("gravity_notes").join("walk.mcap");
    let rest = [0.0, 0.0, 9.8];
    let note = |bytes: &[u8], topics: &str| {
        let (up, notes) = ups(&path, bytes, topics);
        assert!(up.iter().all(Option::is_none), "{up:?}");
        notes.into_iter().find(|note| note.starts_with("up is not taken from ")).unwrap_or_default()
    };
    let (bytes, _) = beside(|time| vec![(1, time, imu(rest, "imu")), (2, time, transforms(&[OPTICAL]))]);
    let said = note(&bytes, "");
    assert!(said.contains("from its frame_id `imu` to that of the maps, `optical`") && said.contains(IMU), "{said}");
    // In units of gravity; and a driver that takes gravity out.
    for force in [[0.0, -1.0, 0.0], [0.1, 0.0, 0.0]] {
        let (bytes, _) = beside(|time| vec![(1, time, imu(force, "optical"))]);
        let said = note(&bytes, "");
        assert!(said.contains(IMU) && said.contains("gravity's 9.81"), "{said}");
    }
    // Two sensors, until one is stated; one of them alone measures accelerations.
    let two = |other| move |time| vec![(1, time, imu(rest, "optical")), (3, time, imu(other, "optical"))];
    let (bytes, _) = beside(two([9.8, 0.0, 0.0]));
    let said = note(&bytes, "");
    assert!(said.contains("from /base/imu nor /imu/data") && said.contains(":/base/imu"), "{said}");
    assert_all(&ups(&path, &bytes, &format!(":{TOPIC}:{IMU}")).0, [0.0, 0.0, 1.0]);
    assert_all(&ups(&path, &bytes, ":/base/imu").0, [1.0, 0.0, 0.0]);
    let (bytes, _) = beside(two([0.0; 3]));
    assert_all(&ups(&path, &bytes, "").0, [0.0, 0.0, 1.0]);
    let said = note(&bytes, ":/base/imu");
    assert!(said.contains("/base/imu, which measures no acceleration"), "{said}");
    // No sensor, nothing said.
    assert_eq!(note(&recording().0, ""), "");
}

#[test]
#[ignore = "writes into fuzz/corpus"]
fn seeds_are_written() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus/source");
    std::fs::create_dir_all(&corpus).unwrap();
    let [chunks, gravity, single, plain, zstd] = recordings().map(|(bytes, _)| bytes);
    let bag = b"rosbag2_bagfile_information:\n  relative_file_paths:\n    - 0.mcap\n  storage_identifier: mcap\n";
    // The first byte picks the source, as the target says.
    for (name, first, bytes) in [
        ("chunks", 0, &chunks[..]),
        ("gravity", 0, &gravity),
        ("records", 0, &single),
        ("plain", 0, &plain),
        ("zstd", 0, &zstd),
        ("bag", 1, bag),
        ("tum", 2, b"# depth\n1.0 0.png\n1.5 0.png\n"),
        ("poses", 3, b"0.0 1 2 3 0 0 0 1\n1.0 1 2 3 0 0 0.7 0.7\n"),
        ("seven", 4, b"1 0 0 0.5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"),
        ("folder", 5, b"P2 2 2 65535\n1000 1000\n2000 0\n"),
    ] {
        std::fs::write(corpus.join(format!("valid-{name}")), [&[first], bytes].concat()).unwrap();
    }
}
