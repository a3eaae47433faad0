//! Which topic of a recording is the depth map's, which one has its camera, and which one says what is up.
//!
//! What a topic has in it is known from its first message alone: the beginning of the file is looked through for that.

use crate::error::{Error, Result, short};
use crate::gravity::{Frames, Gravity};
use crate::mcap::Reader;
use crate::messages::{Content, Kind, depth_form, type_of};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Bytes of a file that are looked through where its summary does not tell which topics it has.
const MOST_LOOKED: u64 = 1 << 26;
/// Topics of our own, whose label images are no depth.
const OURS: &str = "/depthplanes/";
/// What the topic of transforms that never change is called, in whatever namespace.
const STATIC: &str = "/tf_static";
/// Topics in a message.
const MOST_SAID: usize = 12;

/// The topics that are read.
#[derive(Clone, Debug)]
pub(super) struct Choice {
    pub(super) topic: String,
    camera: Option<String>,
    /// The topic of the inertial sensor, or why there is none to choose.
    imu: std::result::Result<Option<String>, String>,
}

impl Choice {
    pub(super) fn topics(&self) -> BTreeSet<String> {
        let imu = self.imu.iter().flatten();
        [&self.topic].into_iter().chain(&self.camera).chain(imu).cloned().collect()
    }
}

/// What the beginning of a recording has.
#[derive(Default)]
pub(super) struct Looked {
    /// Topics with pictures; what is in them if it may be depth, and the frame of coordinates.
    pictures: BTreeMap<String, (Option<String>, String)>,
    /// Topics with cameras, with the frame of coordinates, and the camera.
    cameras: BTreeMap<String, (String, String)>,
    /// Topics with inertial sensors; whether they have an accelerometer, and the frame of coordinates.
    imus: BTreeMap<String, (bool, String)>,
    /// All topics, with the type of each.
    all: BTreeMap<String, String>,
    fault: Option<Error>,
}

/// Looks at the first message of each topic.
pub(super) fn look(reader: &mut Reader) -> Looked {
    let mut looked = Looked::default();
    while reader.bytes_read < MOST_LOOKED && looked.misses(reader) {
        let message = match reader.next() {
            Some(Ok(message)) => message,
            Some(Err(error)) => {
                looked.fault = Some(error);
                break;
            }
            None => break,
        };
        let Some(channel) = reader.channel(message.channel) else { continue };
        let Some(row) = type_of(&channel.schema, &channel.encoding) else { continue };
        let topic = channel.topic.clone();
        if row.kind == Kind::Transforms || looked.knows(&topic) {
            continue;
        }
        match ((row.read)(message.data()), row.kind) {
            (Ok(read), _) => match read.content {
                Content::Camera(text) => _ = looked.cameras.insert(topic, (read.frame_id, text)),
                Content::Imu(imu) => _ = looked.imus.insert(topic, (imu.acceleration.is_some(), read.frame_id)),
                content => _ = looked.pictures.insert(topic, (depth_form(&content), read.frame_id)),
            },
            (Err(_), Kind::Imu) => _ = looked.imus.insert(topic, (false, String::new())),
            (Err(_), _) => _ = looked.pictures.insert(topic, (None, String::new())),
        }
    }
    let of_channel = |(_, channel): (u16, &crate::mcap::Channel)| {
        (channel.topic.clone(), format!("{} in {}", channel.schema, channel.encoding))
    };
    looked.all = reader.channels().map(of_channel).collect();
    looked
}

/// All transforms that never change, of as much of the file as is looked through.
fn frames(reader: &mut Reader) -> Frames {
    let is_static = |channel: &&crate::mcap::Channel| {
        let row = type_of(&channel.schema, &channel.encoding);
        channel.topic.ends_with(STATIC) && row.is_some_and(|row| row.kind == Kind::Transforms)
    };
    let topics: BTreeSet<String> =
        reader.channels().map(|(_, channel)| channel).filter(is_static).map(|channel| channel.topic.clone()).collect();
    let mut frames = Frames::default();
    if topics.is_empty() {
        return frames;
    }
    let most = reader.bytes_read + MOST_LOOKED;
    reader.rewind(topics);
    while let Some(Ok(message)) = reader.next().filter(|_| reader.bytes_read <= most) {
        let Some(channel) = reader.channel(message.channel) else { continue };
        let Some(row) = type_of(&channel.schema, &channel.encoding) else { continue };
        if let Ok(Content::Transforms(transforms)) = (row.read)(message.data()).map(|read| read.content) {
            frames.add(transforms);
        }
    }
    frames
}

impl Looked {
    fn knows(&self, topic: &str) -> bool {
        self.pictures.contains_key(topic) || self.cameras.contains_key(topic) || self.imus.contains_key(topic)
    }

    /// Whether there may be a topic of which nothing was seen yet.
    fn misses(&self, reader: &Reader) -> bool {
        let may = |(_, channel): (u16, &crate::mcap::Channel)| {
            let row = type_of(&channel.schema, &channel.encoding);
            let is_looked_at = row.is_some_and(|row| row.kind != Kind::Transforms);
            is_looked_at && !self.knows(&channel.topic) && reader.count(&channel.topic) != Some(0)
        };
        !reader.has_summary() || reader.channels().any(may)
    }

    /// The topic that is stated, or else the one with depth; the one with its camera, and that of the inertial sensor which is
    /// stated, or else of the only one.
    ///
    /// # Errors
    /// [`Error::Source`] with the topics there are, or what is wrong with the file.
    pub(super) fn choose(&mut self, stated: &[&str], path: &Path) -> Result<Choice> {
        let depth: Vec<String> = self.depth().into_iter().map(|(topic, _)| topic.clone()).collect();
        let (imus, stated): (Vec<&str>, Vec<&str>) = stated.iter().partition(|topic| self.imus.contains_key(**topic));
        let wrong = match (&stated[..], &depth[..]) {
            ([topic], _) if self.pictures.contains_key(*topic) => return Ok(self.with(topic, &imus, path)),
            ([], [topic]) => return Ok(self.with(topic, &imus, path)),
            ([], [_, _, ..]) => format!("{} topics have depth", depth.len()),
            ([topic], _) => format!("no pictures in a topic {topic}"),
            ([], []) => "no depth in it".to_string(),
            (several, _) => format!("{} topics are stated, {}", several.len(), several.join(" and ")),
        };
        // What is missing may stand behind what is wrong.
        match self.fault.take().filter(|_| depth.len() < 2) {
            Some(fault) => Err(fault),
            None => Err(Error::source(path.display(), wrong, self.accepted(path))),
        }
    }

    fn with(&self, topic: &str, imus: &[&str], path: &Path) -> Choice {
        Choice { topic: topic.into(), camera: self.camera_beside(topic), imu: self.imu(topic, imus, path) }
    }

    /// The topic of the inertial sensor: the one that is stated, or else the only one with an accelerometer.
    fn imu(&self, topic: &str, stated: &[&str], path: &Path) -> std::result::Result<Option<String>, String> {
        let measuring = self.imus.iter().filter(|(_, (measures, _))| *measures).map(|(topic, _)| topic.as_str());
        let all: Vec<&str> = if stated.is_empty() { measuring.collect() } else { stated.to_vec() };
        match all[..] {
            [] => Ok(None),
            [imu] if !self.imus[imu].0 => Err(format!("up is not taken from {imu}, which measures no acceleration")),
            [imu] => Ok(Some(imu.into())),
            _ => Err(format!(
                "up is not taken from {}, of which one is to be stated: {}:{topic}:{}",
                all.join(" nor "),
                path.display(),
                all[0]
            )),
        }
    }

    /// What says where gravity is beside the maps of a choice, if the recording does; or why it does not. Afterwards the reader
    /// has to be rewound.
    ///
    /// # Errors
    /// Why up is not known, and what to do.
    pub(super) fn gravity(&self, choice: &Choice, reader: &mut Reader) -> std::result::Result<Option<Gravity>, String> {
        let Some(imu) = choice.imu.as_ref().map_err(String::clone)? else { return Ok(None) };
        let ((_, frame), (_, camera)) = (&self.imus[imu], &self.pictures[&choice.topic]);
        Gravity::new(imu, frame, camera, &frames(reader)).map(Some)
    }

    /// The topics with depth and what it is in; 16 bits of grey are depth where there is nothing else.
    fn depth(&self) -> Vec<(&String, &String)> {
        let with_form = self.pictures.iter().filter_map(|(topic, (form, _))| Some((topic, form.as_ref()?)));
        let mut depth: Vec<_> = with_form.filter(|(topic, _)| !topic.starts_with(OURS)).collect();
        if depth.iter().any(|(_, form)| *form != "mono16") {
            depth.retain(|(_, form)| *form != "mono16");
        }
        depth
    }

    /// The topics with depth, ready to type, or all topics where there are none.
    fn accepted(&self, path: &Path) -> String {
        let typed = |(topic, form): (&String, &String)| format!("{}:{topic} ({})", path.display(), short(form));
        let depth: Vec<String> = self.depth().into_iter().take(MOST_SAID).map(typed).collect();
        if !depth.is_empty() {
            return depth.join(", ");
        }
        let all: Vec<String> = self
            .all
            .iter()
            .take(MOST_SAID)
            .map(|(topic, kind)| format!("{} ({})", short(topic), short(kind)))
            .collect();
        let all = if all.is_empty() { "none".to_string() } else { all.join(", ") };
        format!(
            "a topic with 16UC1, mono16, 32FC1 or compressedDepth in ROS 2's Image or CompressedImage, or in foxglove.RawImage; its \
             topics are {all}"
        )
    }

    /// The topic with the camera of a topic's pictures: the one beside it, or else the only one in its frame of coordinates.
    fn camera_beside(&self, topic: &str) -> Option<String> {
        let base = ["/compressedDepth", "/compressed"].iter().find_map(|transport| topic.strip_suffix(transport));
        let folder = |topic: &str| topic.rsplit_once('/').map_or(String::new(), |(folder, _)| folder.to_string());
        let beside = folder(base.unwrap_or(topic));
        let mut cameras = self.cameras.keys().filter(|camera| folder(camera) == beside);
        let named = cameras.clone().find(|camera| camera.ends_with("/camera_info"));
        if let Some(camera) = named.or_else(|| cameras.next()) {
            return Some(camera.clone());
        }
        let (_, frame_id) = self.pictures.get(topic)?;
        let mut same = self.cameras.iter().filter(|(_, (camera, _))| !camera.is_empty() && camera == frame_id);
        match (same.next(), same.next()) {
            (Some((camera, _)), None) => Some(camera.clone()),
            _ => None,
        }
    }

    /// The camera of a choice, in JSON.
    pub(super) fn camera_of(&self, choice: &Choice) -> Option<String> {
        Some(self.cameras.get(choice.camera.as_ref()?)?.1.clone())
    }
}
