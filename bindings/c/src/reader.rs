//! Maps of one camera, read as files are: what is stated of them, and what is settled since the first.

use crate::error::Result;
use crate::map::Pixels;
use depthplanes::{AnyView, Sensor};
use depthplanes_io::{Frame, ReadOptions, Settled, SettledMaps, frame_of_samples};
use std::sync::Arc;

/// Reads the maps of one camera.
pub(crate) struct Reader {
    options: ReadOptions,
    maps: SettledMaps,
}

/// A map that was read.
pub(crate) enum Read<'m> {
    /// Where it lies.
    InPlace(AnyView<'m>, Arc<Settled>),
    /// A copy.
    Copied(Box<Frame>),
}

impl Reader {
    pub(crate) fn new(options: ReadOptions) -> Self {
        Reader { options, maps: SettledMaps::default() }
    }

    /// Reads a map: as files are until one of its size and type is remembered, then where it lies.
    ///
    /// # Errors
    /// Those of the readers of files.
    pub(crate) fn read<'m>(&self, map: &Pixels<'m>) -> Result<Read<'m>> {
        if let Some(view) = map.in_place().transpose()?
            && let Some(settled) = self.maps.of(&view)
        {
            return Ok(Read::InPlace(view, settled));
        }
        let sample = if cfg!(target_endian = "big") { format!("{}-be", map.sample) } else { map.sample.to_string() };
        Ok(Read::Copied(Box::new(frame_of_samples(&map.bytes(), &sample, map.size(), &self.options)?)))
    }

    /// Remembers what is settled of a map that was read as a copy. Whether it is the first of its size and type.
    ///
    /// # Errors
    /// A map that is none.
    pub(crate) fn remember(&mut self, map: &Pixels<'_>, frame: &Frame) -> Result<bool> {
        Ok(self.maps.add(frame, map.in_place().transpose()?.as_ref(), &self.options))
    }
}

impl Read<'_> {
    /// The map, with the rule for which of its pixels are valid.
    ///
    /// # Errors
    /// [`depthplanes::Error::ValidRange`].
    pub(crate) fn view(&self) -> depthplanes::Result<AnyView<'_>> {
        match self {
            Read::InPlace(view, settled) => settled.view(*view),
            Read::Copied(frame) => frame.view(),
        }
    }

    /// What its numbers mean, and the camera.
    pub(crate) fn sensor(&self) -> Sensor {
        match self {
            Read::InPlace(_, settled) => settled.sensor(),
            Read::Copied(frame) => frame.sensor,
        }
    }
}
