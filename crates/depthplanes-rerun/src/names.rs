//! What numbers in images mean: ids of planes with their colours, and what pixels are by their height above the floor.

use depthplanes::ground::marks;
use depthplanes_io::outputs::{id_colour, mark_colour};
use re_sdk_types::archetypes::AnnotationContext;
use re_sdk_types::datatypes::Rgba32;

/// The names of ids that are written first. When a larger id comes twice as many are written, so that all times together they are
/// no more than four times the largest id.
const FIRST: u32 = 64;

/// What is neither floor nor in the way.
const GREY: [u8; 3] = [150; 3];

/// What is named so far: ids below this one.
#[derive(Debug, Default)]
pub(crate) struct Names(u32);

impl Names {
    /// The names of all ids up to a power of two, if that one has none yet. Label images end at 65535.
    pub(crate) fn up_to(&mut self, id: u32) -> Option<AnnotationContext> {
        if id < self.0 {
            return None;
        }
        self.0 = (id + 1).next_power_of_two().max(FIRST);
        let ids = 1..=(self.0 - 1).min(u16::MAX.into()) as u16;
        let text = |id: u16| (id, id.to_string(), Rgba32::from(id_colour(id.into())));
        let names: Vec<_> = ids.map(text).collect();
        Some(AnnotationContext::new(names.iter().map(|(id, text, colour)| (*id, text.as_str(), *colour))))
    }
}

/// The names of the marks of the ground, in the colours of the picture of it.
pub(crate) fn of_marks() -> AnnotationContext {
    let names =
        [(marks::FLOOR, "floor"), (marks::OBSTACLE, "obstacle"), (marks::DROP, "drop"), (marks::OVERHEAD, "overhead")];
    let coloured = |(mark, name)| (u16::from(mark), name, Rgba32::from(mark_colour(mark).unwrap_or(GREY)));
    AnnotationContext::new(names.map(coloured))
}

#[cfg(test)]
mod tests {
    use super::Names;

    #[test]
    fn names_are_written_ahead_and_seldom() {
        let mut names = Names::default();
        let written: Vec<u32> = (1..=300).filter(|id| names.up_to(*id).is_some()).collect();
        assert_eq!(written, [1, 64, 128, 256]);
        assert!(names.up_to(100_000).is_some() && names.up_to(65_535).is_none());
    }
}
