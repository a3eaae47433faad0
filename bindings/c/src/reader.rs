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
    /// A copy, and whether it is the first of its size and type.
    Copied { frame: Box<Frame>, is_first: bool },
}

impl Reader {
    pub(crate) fn new(options: ReadOptions) -> Self {
        Reader { options, maps: SettledMaps::default() }
    }

    /// Reads a map: the first of its size and type as files are, later ones where they lie.
    ///
    /// # Errors
    /// Those of the readers of files.
    pub(crate) fn read<'m>(&mut self, map: &Pixels<'m>) -> Result<Read<'m>> {
        let view = map.in_place().transpose()?;
        if let Some(view) = view
            && let Some(settled) = self.maps.of(&view)
        {
            return Ok(Read::InPlace(view, settled));
        }
        let sample = if cfg!(target_endian = "big") { format!("{}-be", map.sample) } else { map.sample.to_string() };
        let frame = Box::new(frame_of_samples(&map.bytes(), &sample, map.size(), &self.options)?);
        let is_first = self.maps.add(&frame, view.as_ref(), &self.options);
        Ok(Read::Copied { frame, is_first })
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
            Read::Copied { frame, .. } => frame.view(),
        }
    }

    /// What its numbers mean, and the camera.
    pub(crate) fn sensor(&self) -> Sensor {
        match self {
            Read::InPlace(_, settled) => settled.sensor(),
            Read::Copied { frame, .. } => frame.sensor,
        }
    }
}
