//! A recording in MCAP, as Foxglove opens it: a chunk for each frame, so that whatever ends the program leaves whole ones.
//!
//! Messages are in Protobuf: in JSON the label images would be a third larger and would have to be made text. Their
//! descriptions, `assets/foxglove.binpb`, are those of the Python package foxglove-schemas-protobuf (MIT, by Foxglove);
//! `tests/oracles/test_mcap.py` compares and renews them. The planes' record is JSON, the same as in `.jsonl`.

use super::output::{Output, OutputInfo, machine};
use super::scene::{self, Scene};
use crate::commands::track::follow::Followed;
use crate::failure::Outcome;
use depthplanes_video::failed_record;
use depthplanes_video::mcap::{Topic, Writer};
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

pub(super) const RECORDING: OutputInfo =
    OutputInfo { name: "mcap", file: "planes.mcap", open: |path| Ok(Box::new(Recording::new(path)?)) };

/// Seconds from a frame to the next one, where the source has no times.
const STEP_NS: u64 = 1_000_000_000 / 30;

const FOXGLOVE: Topic<'_> = Topic {
    name: "",
    encoding: "protobuf",
    schema: "",
    schema_encoding: "protobuf",
    description: include_bytes!("../assets/foxglove.binpb"),
};

/// The topics; their places are the numbers of messages.
const TOPICS: [Topic<'_>; 5] = [
    Topic {
        name: "/depthplanes/planes",
        encoding: "json",
        schema: "depthplanes.track",
        schema_encoding: "jsonschema",
        description: include_bytes!("../assets/track.schema.json"),
    },
    Topic { name: "/depthplanes/labels", schema: "foxglove.RawImage", ..FOXGLOVE },
    Topic { name: "/depthplanes/scene", schema: "foxglove.SceneUpdate", ..FOXGLOVE },
    Topic { name: "/depthplanes/camera", schema: "foxglove.CameraCalibration", ..FOXGLOVE },
    Topic { name: "/tf", schema: "foxglove.FrameTransform", ..FOXGLOVE },
];
const PLANES: u16 = 0;
const LABELS: u16 = 1;
const SCENE: u16 = 2;
const CAMERA: u16 = 3;
const TRANSFORM: u16 = 4;

/// A file in MCAP.
struct Recording {
    path: PathBuf,
    /// None once it is finished.
    writer: Option<Writer<File>>,
    scene: Scene,
    /// The time of the last frame, nanoseconds.
    time_ns: Option<u64>,
}

impl Recording {
    fn new(path: &Path) -> Outcome<Self> {
        let writer = File::create(path).and_then(|file| Writer::new(file, &TOPICS));
        let writer = writer.map_err(|error| machine(path, error))?;
        Ok(Recording { path: path.into(), writer: Some(writer), scene: Scene::default(), time_ns: None })
    }

    /// The frame's time, or one behind the last.
    fn time_ns(&mut self, time_s: Option<f64>) -> u64 {
        let next = self.time_ns.map_or(0, |last| last.saturating_add(STEP_NS));
        // Times are seconds since 1970, or since something later.
        let stated = time_s.filter(|time_s| (0.0..1e10).contains(time_s)).map(|time_s| (time_s * 1e9).round() as u64);
        *self.time_ns.insert(stated.unwrap_or(next))
    }

    fn chunk(&mut self, messages: &[(u16, u64, &[u8])]) -> Outcome {
        let Some(writer) = &mut self.writer else { return Ok(()) };
        writer.chunk(messages).map_err(|error| machine(&self.path, error))
    }
}

impl Output for Recording {
    fn write(&mut self, frame: &Followed, _: &mut dyn Write) -> Outcome {
        let time = self.time_ns(frame.video.time_s);
        let (sensor, size) = (&frame.video.frame.sensor, [frame.detection.width, frame.detection.height]);
        let planes = frame.tracked().record().to_string();
        let labels = scene::label_image(&frame.tracked().labels()?, size, time);
        let scene = self.scene.update(frame, time)?;
        let transform = scene::transform(frame.video.pose.as_ref(), time);
        let camera = scene::calibration(sensor, size, time);
        let mut messages: Vec<(u16, u64, &[u8])> =
            vec![(PLANES, time, planes.as_bytes()), (LABELS, time, &labels), (SCENE, time, &scene)];
        messages.push((TRANSFORM, time, &transform));
        messages.extend(camera.as_ref().map(|camera| (CAMERA, time, &camera[..])));
        self.chunk(&messages)
    }

    fn write_failed(&mut self, index: u64, error: &str, _: &mut dyn Write) -> Outcome {
        let time = self.time_ns(None);
        self.chunk(&[(PLANES, time, failed_record(index, error).to_string().as_bytes())])
    }

    fn end(&mut self, _: &mut dyn Write) -> Outcome {
        let Some(writer) = self.writer.take() else { return Ok(()) };
        writer.finish().map(drop).map_err(|error| machine(&self.path, error))
    }
}
