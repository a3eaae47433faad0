//! What the node publishes of a frame, with the stamp and the frame of coordinates of its image.

use crate::floor;
use crate::markers::markers;
use crate::messages::{Header, Image, MarkerArray, Text, TfMessage};
use crate::pictures;
use crate::say::{Error, Once};
use crate::search::Found;
use crate::topics::{SENSOR_DATA, publish, reliable};
use depthplanes::outline::Outliner;
use depthplanes_io::outputs::ground_record;
use depthplanes_video::{Tracked, VideoFrame, failed_record};
use ros2_client::{Node, Publisher, WriteError};
use serde::Serialize;

/// Messages that are kept for listeners which missed them.
const KEPT: usize = 5;
/// Those of `/tf`, as all nodes of ROS 2 keep them.
const KEPT_TRANSFORMS: usize = 100;

/// The publishers.
pub(crate) struct Outputs {
    labels: Publisher<Image>,
    obstacles: Publisher<Image>,
    planes: Publisher<Text>,
    markers: Publisher<MarkerArray>,
    transforms: Publisher<TfMessage>,
    outliner: Outliner,
    floor_frame: String,
}

impl Outputs {
    pub(crate) fn new(node: &mut Node, floor_frame: &str) -> Result<Self, Error> {
        let image = ["sensor_msgs", "Image"];
        Ok(Outputs {
            labels: publish(node, "~/labels", image, &SENSOR_DATA)?,
            obstacles: publish(node, "~/obstacles", image, &SENSOR_DATA)?,
            planes: publish(node, "~/planes", ["std_msgs", "String"], &reliable(KEPT))?,
            markers: publish(node, "~/markers", ["visualization_msgs", "MarkerArray"], &reliable(KEPT))?,
            transforms: publish(node, "/tf", ["tf2_msgs", "TFMessage"], &reliable(KEPT_TRANSFORMS))?,
            outliner: Outliner::default(),
            floor_frame: floor_frame.into(),
        })
    }

    /// Publishes all that was found in a frame; what cannot be made is said.
    pub(crate) fn send(
        &mut self,
        found: &Found<'_>,
        video: &VideoFrame,
        header: &Header,
        dropped: u64,
        once: &mut Once,
    ) {
        let Found { detection, tracks, ground, up, .. } = *found;
        let size = [detection.width, detection.height];
        let record = ground.map(|ground| ground_record(&video.name, ground, up));
        let tracked = Tracked { video, detection, tracks, ground: record.as_ref(), dropped };
        match tracked.labels() {
            Ok(labels) => send(&self.labels, pictures::labels(&labels, size, header), once),
            Err(error) => once.note(&error.to_string()),
        }
        if let Some(ground) = ground {
            send(&self.obstacles, pictures::marks(&ground.marks, size, header), once);
        }
        send(&self.planes, Text { data: tracked.record().to_string() }, once);
        match markers(&mut self.outliner, detection, tracks, &video.frame.sensor, header) {
            Ok(markers) => send(&self.markers, markers, once),
            Err(error) => once.note(&error.to_string()),
        }
        let floor = ground.and_then(|ground| ground.floor.as_ref());
        if let Some(transform) = floor.and_then(|floor| floor::transform(floor, header, &self.floor_frame)) {
            send(&self.transforms, transform, once);
        }
    }

    /// Publishes that an image could not be searched, and why.
    pub(crate) fn send_failed(&self, index: u64, error: &str, once: &mut Once) {
        send(&self.planes, Text { data: failed_record(index, error).to_string() }, once);
    }
}

fn send<M: Serialize>(publisher: &Publisher<M>, message: M, once: &mut Once) {
    match publisher.publish(message) {
        // A listener that does not keep up misses some.
        Ok(()) | Err(WriteError::WouldBlock { .. }) => (),
        Err(error) => once.note(&format!("a message was not sent: {error}")),
    }
}
