//! Curved surfaces as regions of their own, only where they are asked for.
//!
//! In: the regions of tiles, of which some are facets of curved surfaces. Out: connected regions of facets, pixel by
//! pixel. Neighbouring facets are one surface unless there is a step between them; a pixel that a plane takes is not
//! theirs. As with planes, a region has more than `min` pixels.

use super::curved::are_apart;
use super::merge::Edge;
use super::region::Region;
use crate::components::Connectivity;
use crate::detection::{Curved, CurvedRegion};
use crate::error::Result;
use crate::map::{DepthView, Pixel};
use crate::methods::extraction::Extraction;
use crate::methods::method::Job;
use crate::noise::NoiseModel;
use crate::util::memory::reserve_to;
use crate::util::union_find::{find, unite};

/// Gives the facets of one surface one number in a region image. `parents`: memory to work in.
pub(super) fn join_facets(
    all: &[Region],
    edges: &[Edge],
    noise: &NoiseModel,
    parents: &mut Vec<u16>,
    image: &mut [u16],
    most_regions: usize,
) {
    reserve_to(parents, most_regions);
    parents.extend((0..all.len()).map(|id| id as u16));
    for edge in edges {
        if edge.ids.iter().all(|&id| all[id as usize].is_curved) && !are_apart(all, noise, edge) {
            let [a, b] = edge.ids.map(|id| id as u16);
            unite(parents, a, b);
        }
    }
    image.iter_mut().filter(|id| **id > 0).for_each(|id| *id = find(parents, *id - 1) + 1);
}

/// The curved regions of an image of labels. `old`: memory to reuse.
///
/// # Errors
/// [`crate::Error::TooManyPlanes`] if they are more than labels can name.
pub(super) fn curved_of<T: Pixel>(
    extraction: &mut Extraction,
    map: &DepthView<'_, T>,
    ids: &DepthView<'_, u16>,
    min: u32,
    job: &Job<'_>,
    old: Option<Curved>,
) -> Result<Curved> {
    let Extraction { grouper, selection, describer } = extraction;
    let groups = grouper.group(ids, &Connectivity::new(ids.validity(), 0.0)?, job.threads);
    selection.select(groups, min)?;
    describer.tally(map, selection.runs(groups), 0, &job.sensor, job.threads);
    let Curved { mut labels, mut regions } = old.unwrap_or_default();
    selection.paint(groups, &mut labels);
    regions.clear();
    regions.extend((1..).zip(describer.tallies()).map(|(label, tally)| CurvedRegion {
        label,
        pixel_count: tally.pixel_count,
        bounding_box: tally.bounding_box,
        centroid: tally.centroid,
    }));
    Ok(Curved { labels, regions })
}
