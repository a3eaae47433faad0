//! A recording of Rerun: a file of messages, each whole as it is written, so that whatever ends the program leaves whole ones.
//!
//! The encoder is that of Rerun's SDK, without the rest of it: the SDK writes in a thread of its own, which says that a disk is
//! full in its log and goes on, and it asks for a hundred more crates, some of them in C.

use crate::failure::{Failure, Outcome};
use re_build_info::CrateVersion;
use re_chunk::Chunk;
use re_log_encoding::{Encoder, EncodingOptions};
use re_log_types::{LogMsg, SetStoreInfo, StoreId, StoreInfo, StoreKind, StoreSource, TimePoint};
use re_sdk_types::AsComponents;
use re_sdk_types::archetypes::RecordingInfo;
use std::fs::File;
use std::path::{Path, PathBuf};

/// What viewers call what these recordings are of; they keep the layout of windows for each such name.
const APPLICATION: &str = "depthplanes";

/// The entity with what is known of a recording as a whole.
const PROPERTIES: &str = "__properties";

/// A file that is written.
pub(crate) struct Recording {
    path: PathBuf,
    encoder: Encoder<File>,
    store: StoreId,
}

impl Recording {
    /// Makes the file of a recording that viewers call by that name.
    ///
    /// # Errors
    /// What the machine says.
    pub(crate) fn new(path: &Path, name: &str) -> Outcome<Self> {
        let wrong = |error: &dyn std::fmt::Display| Failure::machine(format!("{}: {error}", path.display()));
        let file = File::create(path).map_err(|error| wrong(&error))?;
        let encoder = Encoder::new_eager(CrateVersion::LOCAL, EncodingOptions::PROTOBUF_COMPRESSED, file);
        let store = StoreId::random(StoreKind::Recording, APPLICATION);
        let mut recording = Recording { path: path.into(), encoder: encoder.map_err(|error| wrong(&error))?, store };
        let info = StoreInfo::new(recording.store.clone(), StoreSource::Other(APPLICATION.into()));
        recording.append(&LogMsg::SetStoreInfo(SetStoreInfo { row_id: *re_chunk::RowId::new(), info }))?;
        recording.log(PROPERTIES, &TimePoint::default(), &RecordingInfo::new().with_name(name))?;
        Ok(recording)
    }

    /// Writes what an entity is from a time on; for all times where the time is empty.
    ///
    /// # Errors
    /// What the machine says.
    pub(crate) fn log(&mut self, entity: &str, time: &TimePoint, what: &dyn AsComponents) -> Outcome {
        let chunk = Chunk::builder(entity).with_archetype_auto_row(time.clone(), what).build();
        let message = chunk.and_then(|chunk| chunk.to_arrow_msg()).map_err(|error| self.wrong(&error))?;
        self.append(&LogMsg::ArrowMsg(self.store.clone(), message))
    }

    fn append(&mut self, message: &LogMsg) -> Outcome {
        self.encoder.append(message).map(drop).map_err(|error| self.wrong(&error))
    }

    fn wrong(&self, error: &dyn std::fmt::Display) -> Failure {
        Failure::machine(format!("{}: {error}", self.path.display()))
    }

    /// Writes the table of all messages, by which viewers go to a time at once.
    ///
    /// # Errors
    /// What the machine says.
    pub(crate) fn finish(mut self) -> Outcome {
        self.encoder.finish().map_err(|error| self.wrong(&error))
    }
}
