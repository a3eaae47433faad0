//! What the page shows, and to how many.

use depthplanes::methods::{self, MethodInfo};
use depthplanes_io::ReadOptions;
use depthplanes_video::StatedUp;

/// What is wanted of the page. The default takes the default method and estimates what is not known.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Config {
    /// What the source is called on the page.
    pub name: String,
    /// The method.
    pub method: &'static MethodInfo,
    /// A value for each of its parameters, in order.
    pub values: Vec<f64>,
    /// How files that are dragged in are read.
    pub read: ReadOptions,
    /// What is stated of up.
    pub up: StatedUp,
    /// Height of the camera above the floor, metres, if it is known.
    pub camera_height_m: Option<f64>,
    /// Frames for which a plane that is not seen keeps its id.
    pub kept_frames: u32,
    /// Whether the camera's motion is estimated even where the source says it.
    pub ignore_poses: bool,
    /// Names of this machine by which the page may be asked for, beside `localhost` and addresses.
    pub hosts: Vec<String>,
    /// How much is accepted.
    pub limits: Limits,
}

/// How much is accepted.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Limits {
    /// Pages that are open at once.
    pub clients: usize,
    /// Connections that are open at once, those of pages included.
    pub connections: usize,
    /// Bytes of a file that is dragged in.
    pub upload_bytes: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Limits { clients: 32, connections: 96, upload_bytes: 1 << 26 }
    }
}

impl Default for Config {
    fn default() -> Self {
        let method = methods::default();
        Config {
            name: String::new(),
            method,
            values: method.defaults(),
            read: ReadOptions::default(),
            up: StatedUp::Nothing,
            camera_height_m: None,
            kept_frames: depthplanes::track::KEPT_FRAMES,
            ignore_poses: false,
            hosts: Vec::new(),
            limits: Limits::default(),
        }
    }
}
