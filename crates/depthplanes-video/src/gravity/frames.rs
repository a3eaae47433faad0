//! How frames of coordinates lie to each other, as `/tf_static` says it.
//!
//! In: transforms, each of a child in its parent. Out: the axes of one frame in another, by the parents that both have.

use super::filter::dot;
use crate::messages::Transform;
use depthplanes::track::CameraPose;
use std::collections::BTreeMap;

/// The x, y and z axis of a frame of coordinates, in another's coordinates.
pub(super) type Axes = [[f64; 3]; 3];

/// The x, y and z axis of a frame in its own coordinates.
const OWN: Axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The parent of each frame, and its pose there.
#[derive(Debug, Default)]
pub(crate) struct Frames {
    parents: BTreeMap<String, (String, CameraPose)>,
}

impl Frames {
    /// Adds transforms; of one child the latest counts, as in tf2.
    pub(crate) fn add(&mut self, transforms: Vec<Transform>) {
        for Transform { parent, child, pose } in transforms {
            self.parents.insert(name(&child).into(), (name(&parent).into(), pose));
        }
    }

    /// The axes of `from` in the coordinates of `to`; none where no chain leads from one to the other.
    pub(super) fn axes(&self, from: &str, to: &str) -> Option<Axes> {
        let (of_from, of_to) = (self.above(name(from)), self.above(name(to)));
        let common = |(frame, axes): (&str, Axes)| {
            let (_, others) = of_to.iter().find(|(other, _)| *other == frame)?;
            Some(axes.map(|axis| others.map(|other| dot(other, axis))))
        };
        of_from.into_iter().filter(|(frame, _)| !frame.is_empty()).find_map(common)
    }

    /// A frame, its parent, the parent's parent and so on, with its axes in each.
    fn above<'a>(&'a self, frame: &'a str) -> Vec<(&'a str, Axes)> {
        let mut all = vec![(frame, OWN)];
        // Not round and round in a circle.
        while let Some((parent, pose)) =
            self.parents.get(all[all.len() - 1].0).filter(|_| all.len() <= self.parents.len())
        {
            let axes = all[all.len() - 1].1;
            all.push((parent, axes.map(|axis| pose.rotation().map(|row| dot(row, axis)))));
        }
        all
    }
}

/// A frame's name, which old programs begin with `/`.
fn name(frame: &str) -> &str {
    frame.strip_prefix('/').unwrap_or(frame)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn transform(parent: &str, child: &str, quaternion: [f64; 4]) -> Transform {
        let [x, y, z, w] = quaternion;
        let pose = crate::pose_text::quaternion([1.0, 2.0, 3.0, x, y, z, w]).unwrap();
        Transform { parent: parent.into(), child: child.into(), pose }
    }

    #[test]
    fn chains_are_gone_along_both_ways() {
        // The optical frame as REP 103 has it, under the camera's; the sensor lies on its side under the base.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let mut frames = Frames::default();
        frames.add(vec![
            transform("camera", "optical", [-0.5, 0.5, -0.5, 0.5]),
            transform("/base", "camera", [0.0, 0.0, 0.0, 1.0]),
            transform("base", "imu", [half, 0.0, 0.0, half]),
        ]);
        // A quarter turn about x brings the sensor's y to the base's z, up, which is -y of the optical frame.
        let axes = frames.axes("imu", "optical").unwrap();
        for (axis, expected) in axes.iter().zip([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]]) {
            assert!(axis.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{axes:?}");
        }
        // The other way round it is the transpose; a frame has its own axes.
        let back = frames.axes("optical", "imu").unwrap();
        assert!((0..9).all(|at| (back[at / 3][at % 3] - axes[at % 3][at / 3]).abs() < 1e-12));
        assert_eq!(frames.axes("/imu", "imu"), Some(OWN));
        assert_eq!(frames.axes("imu", "elsewhere"), None);
        assert_eq!(frames.axes("", ""), None);
    }

    #[test]
    fn a_circle_ends() {
        let mut frames = Frames::default();
        frames.add(vec![transform("a", "b", [0.0, 0.0, 0.0, 1.0]), transform("b", "a", [0.0, 0.0, 0.0, 1.0])]);
        assert_eq!(frames.axes("a", "c"), None);
        assert!(frames.axes("a", "b").is_some());
    }
}
