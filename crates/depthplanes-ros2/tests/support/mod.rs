//! A domain of its own for each test, the node in it, and a peer that publishes a camera and listens.

#![allow(dead_code, reason = "each test file uses its own part")]

use depthplanes::Intrinsics;
use depthplanes_ros2::messages::*;
use ros2_client::dds::rustdds::DomainParticipantBuilder;
use ros2_client::qos::History;
use ros2_client::{Context, MessageTypeName, Name, NodeName, NodeOptions, Publisher, QosProfile, Subscription};
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::BTreeMap;
use std::hash::{BuildHasher, RandomState};
use std::io::Read;
use std::net::Ipv4Addr;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Whatever happens a test ends after so long.
const LIMIT: Duration = Duration::from_secs(90);
/// From image to image.
const STEP: Duration = Duration::from_millis(100);
/// The program that is tested, as this machine runs it.
const PROGRAM: &str = env!("CARGO_BIN_EXE_depthplanes-ros2");

/// A domain and a namespace that nobody else has, so that tests which run at the same time do not meet.
pub struct Domain {
    id: u16,
    namespace: String,
}

impl Domain {
    pub fn new() -> Self {
        let random = RandomState::new().hash_one(std::process::id());
        // Ports of further domains may be taken for other connections.
        Domain { id: 1 + (random % 100) as u16, namespace: format!("/test{}", random >> 32) }
    }

    /// Where the peer has its camera.
    pub fn folder(&self) -> String {
        format!("{}/camera", self.namespace)
    }

    /// Starts the node, which listens to the peer unless the flags name another topic.
    pub fn node(&self, flags: &[&str]) -> Running {
        let depth = format!("{}/image", self.folder());
        let own = if flags.contains(&"--depth") { vec![] } else { vec!["--depth", &depth] };
        self.node_alone(&[&["--namespace", &self.namespace][..], &own, flags].concat())
    }

    /// Starts the node with these flags; what they do not say of the domain is in the environment.
    pub fn node_alone(&self, flags: &[&str]) -> Running {
        let mut command = Command::new(PROGRAM);
        command.env("ROS_LOCALHOST_ONLY", "1").env("ROS_DOMAIN_ID", self.id.to_string());
        let mut child = command.args(flags).stderr(Stdio::piped()).spawn().unwrap();
        let (mut stderr, said) = (child.stderr.take().unwrap(), Arc::new(Mutex::new(String::new())));
        let heard = Arc::clone(&said);
        std::thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(count @ 1..) = stderr.read(&mut bytes) {
                heard.lock().unwrap().push_str(&String::from_utf8_lossy(&bytes[..count]));
            }
        });
        Running { child, said }
    }
}

/// The node while it runs.
pub struct Running {
    child: Child,
    said: Arc<Mutex<String>>,
}

impl Running {
    pub fn said(&self) -> String {
        self.said.lock().unwrap().clone()
    }

    fn check(&mut self) {
        if let Some(status) = self.child.try_wait().unwrap() {
            panic!("the node ended with {status}:\n{}", self.said());
        }
    }

    /// Interrupts it as Ctrl-C does; what it said.
    pub fn end(mut self) -> String {
        let interrupted = Command::new("kill").args(["-INT", &self.child.id().to_string()]).status().unwrap();
        assert!(interrupted.success());
        let start = Instant::now();
        let status = loop {
            match self.child.try_wait().unwrap() {
                Some(status) => break status,
                None => assert!(start.elapsed() < LIMIT, "Ctrl-C does not end the node:\n{}", self.said()),
            }
            std::thread::sleep(STEP);
        };
        std::thread::sleep(STEP); // its last words
        assert!(status.success(), "{status}:\n{}", self.said());
        self.said()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What the node said once it says certain words; `between` is done again and again.
pub fn said_within(node: &mut Running, time: Duration, words: &str, mut between: impl FnMut()) -> String {
    let start = Instant::now();
    while !node.said().contains(words) {
        node.check();
        assert!(start.elapsed() < time, "the node does not say `{words}`:\n{}", node.said());
        between();
        std::thread::sleep(STEP);
    }
    node.said()
}

/// All that the node publishes of an image.
#[derive(Clone)]
pub struct Frame {
    pub labels: Image,
    pub obstacles: Image,
    pub planes: Text,
    pub markers: MarkerArray,
    pub transform: TransformStamped,
}

/// Publishes a camera and listens to the node.
pub struct Peer {
    pub depth: Publisher<Image>,
    camera: Publisher<CameraInfo>,
    labels: Subscription<Image>,
    obstacles: Subscription<Image>,
    planes: Subscription<Text>,
    markers: Subscription<MarkerArray>,
    transforms: Subscription<TfMessage>,
    _node: ros2_client::Node,
}

impl Peer {
    pub fn new(domain: &Domain) -> Self {
        let participant = DomainParticipantBuilder::new(domain.id).with_only_networks([Ipv4Addr::LOCALHOST]);
        let context = Context::from_domain_participant(participant.build().unwrap()).unwrap();
        let name = NodeName::new(&domain.namespace, "peer").unwrap();
        let mut node = context.new_node(name, NodeOptions::new().enable_rosout(false)).unwrap();
        let sensor_data = QosProfile::subscription_default().history(History::KeepLast { depth: 50 });
        let reliable = QosProfile::publisher_default().history(History::KeepLast { depth: 50 });
        let topic = |node: &ros2_client::Node, name: &str, [package, kind]: [&str; 2], qos: &QosProfile| {
            node.create_topic(&Name::parse(name).unwrap(), MessageTypeName::new(package, kind), qos).unwrap()
        };
        let (folder, own) = (domain.folder(), format!("{}/depthplanes", domain.namespace));
        let image = ["sensor_msgs", "Image"];
        let depth = topic(&node, &format!("{folder}/image"), image, &sensor_data);
        let camera = topic(&node, &format!("{folder}/camera_info"), ["sensor_msgs", "CameraInfo"], &sensor_data);
        let labels = topic(&node, &format!("{own}/labels"), image, &sensor_data);
        let obstacles = topic(&node, &format!("{own}/obstacles"), image, &sensor_data);
        let planes = topic(&node, &format!("{own}/planes"), ["std_msgs", "String"], &reliable);
        let markers = topic(&node, &format!("{own}/markers"), ["visualization_msgs", "MarkerArray"], &reliable);
        let transforms = topic(&node, "/tf", ["tf2_msgs", "TFMessage"], &reliable);
        Peer {
            depth: node.create_publisher(&depth, None).unwrap(),
            camera: node.create_publisher(&camera, None).unwrap(),
            labels: node.create_subscription(&labels, None).unwrap(),
            obstacles: node.create_subscription(&obstacles, None).unwrap(),
            planes: node.create_subscription(&planes, None).unwrap(),
            markers: node.create_subscription(&markers, None).unwrap(),
            transforms: node.create_subscription(&transforms, None).unwrap(),
            _node: node,
        }
    }

    /// Publishes images and their camera until everything of so many came back.
    pub fn frames(
        &mut self,
        node: &mut Running,
        camera: Intrinsics,
        [width, height]: [usize; 2],
        wanted: usize,
        image: impl Fn(usize, Header) -> Image,
    ) -> Vec<Frame> {
        let (mut came, start) = (Came::default(), Instant::now());
        for turn in 0.. {
            let stamp = Time { sec: 1_700_000_000 + turn as i32, nanosec: 500_000_000 };
            let header = Header { stamp, frame_id: "depth_optical".into() };
            let k = [camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0];
            let (height, width) = (height as u32, width as u32);
            let info = CameraInfo {
                header: header.clone(),
                height,
                width,
                k,
                distortion_model: "plumb_bob".into(),
                ..Default::default()
            };
            self.camera.publish(info).unwrap();
            self.depth.publish(image(turn, header)).unwrap();
            let next = start + STEP * (turn as u32 + 1);
            while Instant::now() < next {
                self.listen(&mut came);
                std::thread::sleep(Duration::from_millis(2));
            }
            let whole = came.whole();
            if whole.len() >= wanted {
                return whole;
            }
            node.check();
            assert!(
                start.elapsed() < LIMIT,
                "of {} images {came:?} came back in {LIMIT:?}; the two processes meet over UDP on 127.0.0.1, which this machine \
                 has to allow:\n{}",
                turn + 1,
                node.said()
            );
        }
        unreachable!("turns have no end")
    }

    /// Publishes an image that cannot be searched until that is said; the record of it.
    pub fn failed(&self, node: &mut Running, image: &Image) -> Value {
        let start = Instant::now();
        loop {
            self.depth.publish(image.clone()).unwrap();
            std::thread::sleep(STEP);
            for text in all(&self.planes) {
                let record: Value = serde_json::from_str(&text.data).unwrap();
                if !record["error"].is_null() {
                    return record;
                }
            }
            node.check();
            assert!(start.elapsed() < LIMIT, "no record of an image that cannot be searched:\n{}", node.said());
        }
    }

    fn listen(&self, came: &mut Came) {
        came.labels.extend(all(&self.labels).into_iter().map(|image| (image.header.stamp.sec, image)));
        came.obstacles.extend(all(&self.obstacles).into_iter().map(|image| (image.header.stamp.sec, image)));
        came.planes.extend(all(&self.planes).into_iter().map(|text| {
            let record: Value = serde_json::from_str(&text.data).unwrap();
            (record["time_s"].as_f64().unwrap() as i32, text)
        }));
        came.markers.extend(all(&self.markers).into_iter().map(|array| (array.markers[0].header.stamp.sec, array)));
        for transform in all(&self.transforms).into_iter().flat_map(|message| message.transforms) {
            came.transforms.insert(transform.header.stamp.sec, transform);
        }
    }
}

/// What came back, by the seconds of its stamp.
#[derive(Default)]
struct Came {
    labels: BTreeMap<i32, Image>,
    obstacles: BTreeMap<i32, Image>,
    planes: BTreeMap<i32, Text>,
    markers: BTreeMap<i32, MarkerArray>,
    transforms: BTreeMap<i32, TransformStamped>,
}

impl Came {
    fn whole(&self) -> Vec<Frame> {
        let frame = |(stamp, labels): (&i32, &Image)| {
            Some(Frame {
                labels: labels.clone(),
                obstacles: self.obstacles.get(stamp)?.clone(),
                planes: self.planes.get(stamp)?.clone(),
                markers: self.markers.get(stamp)?.clone(),
                transform: self.transforms.get(stamp)?.clone(),
            })
        };
        self.labels.iter().filter_map(frame).collect()
    }
}

impl std::fmt::Debug for Came {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [labels, obstacles] = [self.labels.len(), self.obstacles.len()];
        let [planes, markers, transforms] = [self.planes.len(), self.markers.len(), self.transforms.len()];
        write!(
            f,
            "{labels} labels, {obstacles} obstacles, {planes} planes, {markers} markers and {transforms} transforms"
        )
    }
}

fn all<M: DeserializeOwned + 'static>(subscription: &Subscription<M>) -> Vec<M> {
    std::iter::from_fn(|| subscription.take().unwrap()).map(|(message, _)| message).collect()
}
