//! Label images in which pixels have the id of their plane.

use crate::commands::track::follow::Followed;
use crate::failure::{Failure, Outcome};

/// The id of each pixel, row by row.
///
/// # Errors
/// For an id that 16 bits do not hold.
pub(super) fn by_id(frame: &Followed) -> Outcome<Vec<u16>> {
    let ids = frame.tracks.ids.iter().map(|&id| u16::try_from(id)).collect::<Result<Vec<u16>, _>>();
    let ids = ids.map_err(|_| {
        Failure::request("an id is above 65535, which 16-bit label images do not hold; --out FILE.jsonl has all ids")
    })?;
    let id = |&label: &u16| usize::from(label).checked_sub(1).map_or(0, |at| ids[at]);
    Ok(frame.detection.labels.iter().map(id).collect())
}
