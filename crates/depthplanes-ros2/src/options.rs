//! What is wanted of the node.

use depthplanes::methods::{self, MethodInfo};
use depthplanes_io::ReadOptions;

/// What the node listens to, how it searches, and what it is called. The default is that of the program.
#[derive(Clone, Debug)]
pub struct Options {
    /// The topic with the depth images.
    pub depth: String,
    /// The topic with their camera; by default `camera_info` beside `depth`.
    pub camera_info: Option<String>,
    /// The node's name.
    pub name: String,
    /// Its namespace.
    pub namespace: String,
    /// The DDS domain, 0 to 232.
    pub domain_id: u16,
    /// Whether it talks to programs on this machine only.
    pub is_local: bool,
    /// The name of the floor's frame of coordinates.
    pub floor_frame: String,
    /// What the numbers of the images mean, where their encoding is not to be believed.
    pub read: ReadOptions,
    /// The method, and those of its parameters that are stated.
    pub method: &'static MethodInfo,
    /// Name and value of each.
    pub parameters: Vec<(&'static str, f64)>,
    /// Threads of a frame; 0 for as many as there are cores.
    pub threads: usize,
    /// Up in the camera's coordinates; without it it is estimated.
    pub up: Option<[f64; 3]>,
    /// The camera's height, if it is known, metres.
    pub camera_height_m: Option<f64>,
    /// Frames for which a plane that is not seen keeps its id.
    pub kept_frames: u32,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            depth: "/camera/depth/image_rect_raw".into(),
            camera_info: None,
            name: "depthplanes".into(),
            namespace: "/".into(),
            domain_id: 0,
            is_local: false,
            floor_frame: "floor".into(),
            read: ReadOptions::default(),
            method: methods::default(),
            parameters: Vec::new(),
            threads: 1,
            up: None,
            camera_height_m: None,
            kept_frames: depthplanes::track::KEPT_FRAMES,
        }
    }
}

impl Options {
    /// The topic with the camera: the one that is stated, or `camera_info` beside the images.
    pub fn camera_info(&self) -> String {
        let beside = || match self.depth.rsplit_once('/') {
            Some((folder, _)) => format!("{folder}/camera_info"),
            None => "camera_info".into(),
        };
        self.camera_info.clone().unwrap_or_else(beside)
    }
}

#[cfg(test)]
mod tests {
    use super::Options;

    #[test]
    fn the_camera_is_beside_the_images_unless_stated() {
        let of = |depth: &str, camera_info: Option<&str>| {
            Options { depth: depth.into(), camera_info: camera_info.map(Into::into), ..Options::default() }
                .camera_info()
        };
        assert_eq!(of("/camera/depth/image_raw", None), "/camera/depth/camera_info");
        assert_eq!(of("/depth", None), "/camera_info");
        assert_eq!(of("depth", None), "camera_info");
        assert_eq!(of("/depth", Some("/rgb/camera_info")), "/rgb/camera_info");
    }
}
