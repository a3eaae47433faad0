//! The node: images come, the newest is searched, and what was found is published.

use crate::camera::Camera;
use crate::messages::{CameraInfo, Header, Image, Time};
use crate::options::Options;
use crate::outputs::Outputs;
use crate::patience::Patience;
use crate::say::{Error, Once, note};
use crate::search::Search;
use crate::topics::{node_name, subscribe};
use depthplanes_io::Frame;
use depthplanes_video::{VideoFrame, ros};
use ros2_client::dds::rustdds::DomainParticipantBuilder;
use ros2_client::dds::rustdds::mio1::{Events, Interest, Poll, Token};
use ros2_client::{Context, Gid, MessageInfo, NodeOptions, Subscription};
use std::io::ErrorKind;
use std::net::Ipv4Addr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The largest domain: the ports of further ones are above 65535.
const LAST_DOMAIN: u16 = 232;
/// How often it is looked whether the node is to end.
const TICK: Duration = Duration::from_millis(100);

/// A node of ROS 2.
pub struct Node {
    options: Options,
    depth: Subscription<Image>,
    camera_info: Subscription<CameraInfo>,
    outputs: Outputs,
    search: Search,
    camera: Camera,
    counts: Counts,
    patience: Patience,
    once: Once,
    /// Ends last: what is above belongs to it.
    node: ros2_client::Node,
    context: Context,
}

/// How many images there were.
#[derive(Default)]
struct Counts {
    taken: u64,
    searched: u64,
    dropped: u64,
    last: Option<(Gid, i64)>,
}

impl Counts {
    /// Counts an image, and those before it that never came here or were older than it.
    fn add(&mut self, info: &MessageInfo) {
        let (publisher, number) = (info.publisher_gid(), info.sequence_number());
        let last = self.last.replace((publisher, number)).filter(|(before, _)| *before == publisher);
        let missing = last.map_or(0, |(_, last)| number.saturating_sub(last).saturating_sub(1));
        self.dropped += u64::try_from(missing).unwrap_or(0);
    }
}

impl Node {
    /// Joins the domain and makes all topics.
    ///
    /// # Errors
    /// What is wrong with the options, and what the machine refuses.
    pub fn new(options: Options) -> Result<Self, Error> {
        if options.domain_id > LAST_DOMAIN {
            let wrong = format!("--domain-id: {} is no domain; accepted: 0 to {LAST_DOMAIN}", options.domain_id);
            return Err(Error::new(wrong));
        }
        let search = Search::new(&options).map_err(|error| Error::new(error.to_string()))?;
        let context = context(&options)?;
        let name = node_name(&options.namespace, &options.name)?;
        let node = context.new_node(name, NodeOptions::new().enable_rosout(false));
        let mut node = node.map_err(|error| Error::new(format!("the node cannot be made: {error:?}")))?;
        let depth = subscribe(&mut node, &options.depth, ["sensor_msgs", "Image"])?;
        let camera_info = subscribe(&mut node, &options.camera_info(), ["sensor_msgs", "CameraInfo"])?;
        let outputs = Outputs::new(&mut node, &options.floor_frame)?;
        Ok(Node {
            options,
            depth,
            camera_info,
            outputs,
            search,
            camera: Camera::default(),
            counts: Counts::default(),
            patience: Patience::default(),
            once: Once::default(),
            node,
            context,
        })
    }

    /// Searches images until `stop` is set; then it says how many there were.
    ///
    /// # Errors
    /// What the machine refuses.
    pub fn run(mut self, stop: &AtomicBool) -> Result<(), Error> {
        note(&format!(
            "{} waits for images on {} and their camera on {}",
            self.node.fully_qualified_name(),
            self.options.depth,
            self.options.camera_info()
        ));
        let machine = |error: std::io::Error| Error::new(format!("messages cannot be waited for: {error}"));
        let (mut poll, mut events) = (Poll::new().map_err(machine)?, Events::with_capacity(8));
        poll.registry().register(&mut self.depth, Token(0), Interest::READABLE).map_err(machine)?;
        poll.registry().register(&mut self.camera_info, Token(1), Interest::READABLE).map_err(machine)?;
        while !stop.load(Ordering::Relaxed) {
            match poll.poll(&mut events, Some(TICK)) {
                Err(error) if error.kind() != ErrorKind::Interrupted => return Err(machine(error)),
                _ => self.turn(),
            }
        }
        let Counts { searched, dropped, .. } = self.counts;
        note(&format!("{searched} images were searched, {dropped} were dropped"));
        Ok(())
    }

    /// Takes what came, and searches the newest image.
    fn turn(&mut self) {
        for (message, _) in all(&self.camera_info, &mut self.once) {
            self.camera.take(&message);
        }
        let images = all(&self.depth, &mut self.once);
        images.iter().for_each(|(_, info)| self.counts.add(info));
        self.counts.dropped += images.len().saturating_sub(1) as u64;
        if let Some((image, _)) = images.into_iter().next_back() {
            self.patience.came();
            self.image(&image);
        }
        self.patience.look(&self.options, &self.context);
    }

    fn image(&mut self, image: &Image) {
        let index = self.counts.taken + self.counts.dropped;
        self.counts.taken += 1;
        let frame = match self.frame(image) {
            Ok(Some(frame)) => frame,
            Ok(None) => return self.patience.lacks_camera(),
            Err(error) => return self.failed(index, &error),
        };
        self.patience.has_camera();
        frame.warnings.iter().for_each(|warning| self.once.note(warning));
        let Time { sec, nanosec } = image.header.stamp;
        let time_s = f64::from(sec) + 1e-9 * f64::from(nanosec);
        let time_s = (time_s != 0.0).then_some(time_s); // one that is all 0 was set by nobody
        let name = self.options.depth.clone();
        let video = VideoFrame { index, name, time_s, pose: None, up: None, frame };
        match self.search.search(&video) {
            Ok(found) => {
                self.counts.searched += 1;
                if found.is_renumbered {
                    note("ids begin at 1 again, since label images hold none above 65535");
                }
                let header: &Header = &image.header;
                self.outputs.send(&found, &video, header, self.counts.dropped, &mut self.once);
            }
            Err(error) => self.failed(index, &error.to_string()),
        }
    }

    /// The image with its camera; none as long as that is not known.
    fn frame(&mut self, image: &Image) -> Result<Option<Frame>, String> {
        let mut read = self.options.read.clone();
        if read.intrinsics.is_none() {
            match self.camera.known() {
                Some(Ok(camera)) => read = read.camera(camera),
                Some(Err(wrong)) => self.once.note(&format!("the camera is not used: {wrong}")),
                None => (),
            }
        }
        let Image { width, height, step, ref encoding, is_bigendian, ref data, .. } = *image;
        let rows = ros::Image { width, height, step, encoding, is_big_endian: is_bigendian != 0, data };
        let frame = rows.frame(&self.options.depth, &read).map_err(|error| error.to_string())?;
        Ok(Some(frame).filter(|frame| frame.sensor.intrinsics.is_some()))
    }

    fn failed(&mut self, index: u64, error: &str) {
        self.once.note(error);
        self.outputs.send_failed(index, error, &mut self.once);
    }
}

/// The domain.
fn context(options: &Options) -> Result<Context, Error> {
    let mut participant = DomainParticipantBuilder::new(options.domain_id);
    if options.is_local {
        participant = participant.with_only_networks([Ipv4Addr::LOCALHOST]);
    }
    let cannot =
        |error: &dyn std::fmt::Display| Error::new(format!("domain {} cannot be joined: {error}", options.domain_id));
    let participant = participant.build().map_err(|error| cannot(&error))?;
    Context::from_domain_participant(participant).map_err(|error| cannot(&error))
}

/// All messages that came.
fn all<M: serde::de::DeserializeOwned + 'static>(
    subscription: &Subscription<M>,
    once: &mut Once,
) -> Vec<(M, MessageInfo)> {
    let mut messages = Vec::new();
    loop {
        match subscription.take() {
            Ok(Some(message)) => messages.push(message),
            Ok(None) => return messages,
            Err(error) => once.note(&format!("a message cannot be read: {error}")),
        }
    }
}
