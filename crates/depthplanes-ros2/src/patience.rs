//! What keeps the node waiting, and what to type about it.

use crate::options::Options;
use crate::say::note;
use ros2_client::Context;
use std::time::{Duration, Instant};

/// Waiting is worth a word after so long.
const LONG: Duration = Duration::from_secs(5);
/// Topics that are named.
const MOST_NAMED: usize = 12;

/// Since when the node waits for an image, and for a camera.
pub(crate) struct Patience {
    image: Wait,
    camera: Option<Wait>,
}

struct Wait {
    since: Instant,
    is_said: bool,
}

impl Wait {
    fn new() -> Self {
        Wait { since: Instant::now(), is_said: false }
    }

    /// Whether it is time to say it, which is so once.
    fn is_long(&mut self) -> bool {
        let is_long = !self.is_said && self.since.elapsed() >= LONG;
        self.is_said |= is_long;
        is_long
    }
}

impl Default for Patience {
    fn default() -> Self {
        Patience { image: Wait::new(), camera: None }
    }
}

impl Patience {
    /// An image came.
    pub(crate) fn came(&mut self) {
        self.image = Wait::new();
    }

    /// Its camera is not known.
    pub(crate) fn lacks_camera(&mut self) {
        self.camera.get_or_insert_with(Wait::new);
    }

    /// Its camera is known.
    pub(crate) fn has_camera(&mut self) {
        self.camera = None;
    }

    /// Says once of each wait that it is long.
    pub(crate) fn look(&mut self, options: &Options, context: &Context) {
        let (seconds, domain) = (LONG.as_secs(), options.domain_id);
        if self.image.is_long() {
            let there = published(context, "sensor_msgs::msg::dds_::Image_");
            note(&format!(
                "no image has come on {} for {seconds} s (domain {domain}); images are on: {there}; --depth TOPIC names \
                 another; still waiting (Ctrl-C ends)",
                options.depth
            ));
        }
        if self.camera.as_mut().is_some_and(Wait::is_long) {
            let there = published(context, "sensor_msgs::msg::dds_::CameraInfo_");
            note(&format!(
                "images come, but no camera that can be used on {} for {seconds} s; cameras are on: {there}; --camera-info TOPIC \
                 names another, --intrinsics FX,FY,CX,CY states the camera; still waiting (Ctrl-C ends)",
                options.camera_info()
            ));
        }
    }
}

/// The topics with messages of a type that others publish, as they are typed.
fn published(context: &Context, kind: &str) -> String {
    let writers = context.domain_participant().discovered_writers();
    let topics = writers.iter().map(|writer| &writer.publication_topic_data);
    let of_kind = topics.filter(|topic| topic.type_name == kind);
    let mut names: Vec<String> =
        of_kind.filter_map(|topic| topic.topic_name.strip_prefix("rt").map(str::to_string)).collect();
    names.sort();
    names.dedup();
    names.truncate(MOST_NAMED);
    if names.is_empty() { "no topic".into() } else { names.join(", ") }
}
