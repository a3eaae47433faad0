//! Which topic of a recording is the depth map's, and which one has its camera.
//!
//! What a topic has in it is known from its first message alone: the beginning of the file is looked through for that.

use crate::error::{Error, Result, short};
use crate::mcap::Reader;
use crate::messages::{Content, depth_form, type_of};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Bytes of a file that are looked through where its summary does not tell which topics it has.
const MOST_LOOKED: u64 = 1 << 26;
/// Topics of our own, whose label images are no depth.
const OURS: &str = "/depthplanes/";
/// Topics in a message.
const MOST_SAID: usize = 12;

/// The topics that are read.
#[derive(Clone, Debug)]
pub(super) struct Choice {
    pub(super) topic: String,
    camera: Option<String>,
}

impl Choice {
    pub(super) fn topics(&self) -> BTreeSet<String> {
        [&self.topic].into_iter().chain(&self.camera).cloned().collect()
    }
}

/// What the beginning of a recording has.
#[derive(Default)]
pub(super) struct Looked {
    /// Topics with pictures; what is in them if it may be depth, and the frame of coordinates.
    pictures: BTreeMap<String, (Option<String>, String)>,
    /// Topics with cameras, with the frame of coordinates, and the camera.
    cameras: BTreeMap<String, (String, String)>,
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
        if looked.knows(&topic) {
            continue;
        }
        match (row.read)(message.data()) {
            Ok(read) => match read.content {
                Content::Camera(text) => _ = looked.cameras.insert(topic, (read.frame_id, text)),
                content => _ = looked.pictures.insert(topic, (depth_form(&content), read.frame_id)),
            },
            Err(_) => _ = looked.pictures.insert(topic, (None, String::new())),
        }
    }
    let of_channel = |(_, channel): (u16, &crate::mcap::Channel)| {
        (channel.topic.clone(), format!("{} in {}", channel.schema, channel.encoding))
    };
    looked.all = reader.channels().map(of_channel).collect();
    looked
}

impl Looked {
    fn knows(&self, topic: &str) -> bool {
        self.pictures.contains_key(topic) || self.cameras.contains_key(topic)
    }

    /// Whether there may be a topic of which nothing was seen yet.
    fn misses(&self, reader: &Reader) -> bool {
        let may = |(_, channel): (u16, &crate::mcap::Channel)| {
            let is_read = type_of(&channel.schema, &channel.encoding).is_some();
            is_read && !self.knows(&channel.topic) && reader.count(&channel.topic) != Some(0)
        };
        !reader.has_summary() || reader.channels().any(may)
    }

    /// The topic that is stated, or else the one with depth; and the one with its camera.
    ///
    /// # Errors
    /// [`Error::Source`] with the topics there are, or what is wrong with the file.
    pub(super) fn choose(&mut self, stated: Option<&str>, path: &Path) -> Result<Choice> {
        let depth: Vec<String> = self.depth().into_iter().map(|(topic, _)| topic.clone()).collect();
        let wrong = match (stated, &depth[..]) {
            (Some(topic), _) if self.pictures.contains_key(topic) => return Ok(self.with_camera(topic)),
            (None, [topic]) => return Ok(self.with_camera(topic)),
            (None, [_, _, ..]) => format!("{} topics have depth", depth.len()),
            (Some(topic), _) => format!("no pictures in a topic {topic}"),
            (None, []) => "no depth in it".to_string(),
        };
        // What is missing may stand behind what is wrong.
        match self.fault.take().filter(|_| depth.len() < 2) {
            Some(fault) => Err(fault),
            None => Err(Error::source(path.display(), wrong, self.accepted(path))),
        }
    }

    fn with_camera(&self, topic: &str) -> Choice {
        Choice { topic: topic.into(), camera: self.camera_beside(topic) }
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
