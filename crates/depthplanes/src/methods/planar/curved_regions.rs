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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::planar::grid::NONE;
    use crate::methods::planar::testing::{Made, SENSOR, SIGMA, Stages, noise};

    /// The number of each of some facets, four tiles wide each, of which some are curved, with steps of so many deviations
    /// between them.
    fn numbers(curved: &[bool], steps: &[f64], gap_after: Option<usize>) -> Vec<u16> {
        let level = |u: f64| steps.iter().take(u as usize / 16).sum::<f64>() * SIGMA;
        let made = Made::exact([16 * curved.len(), 32], |u, v| 40.0 + 0.01 * v as f64 + level(u as f64));
        let mut stages = Stages::tiles(&made, noise(0.0));
        // A gap of two tiles is none's.
        stages.divide(|column, _| {
            let is_gap = gap_after.is_some_and(|facet| [4 * facet + 3, 4 * facet + 2].contains(&column));
            if is_gap { NONE } else { column as u32 / 4 }
        });
        stages.list_edges();
        stages.run.regions.all.iter_mut().zip(curved).for_each(|(region, &is_curved)| region.is_curved = is_curved);
        let mut image: Vec<u16> = (0..=curved.len() as u16).collect();
        let mut parents = Vec::new();
        join_facets(stages.all(), &stages.run.merger.edges, &stages.noise, &mut parents, &mut image, 100);
        assert_eq!(image[0], 0, "no region stays none");
        image[1..].to_vec()
    }

    #[test]
    fn facets_side_by_side_get_one_number_unless_there_is_a_step_between_them() {
        assert_eq!(numbers(&[true; 4], &[0.0; 3], None), [1, 1, 1, 1]);
        assert_eq!(numbers(&[true; 4], &[3.0, -3.0, 3.0], None), [1, 1, 1, 1]);
        assert_eq!(numbers(&[true; 4], &[0.0, 10.0, 0.0], None), [1, 1, 3, 3]);
        assert_eq!(numbers(&[true; 4], &[-10.0, 0.0, 10.0], None), [1, 2, 2, 4]);
    }

    #[test]
    fn facets_that_a_plane_or_nothing_parts_are_two_surfaces() {
        assert_eq!(numbers(&[true, true, false, true], &[0.0; 3], None), [1, 1, 3, 4]);
        assert_eq!(numbers(&[true; 4], &[0.0; 3], Some(1)), [1, 1, 3, 3]);
    }

    #[test]
    fn curved_regions_are_the_connected_pieces_of_more_than_min_pixels() {
        // Number 2 in two pieces, of 12 pixels and of 4; number 1 of 6.
        let ids: Vec<u16> =
            [[0, 2, 2, 2, 2, 0, 2, 2], [0, 2, 2, 2, 2, 0, 2, 2], [0, 2, 2, 2, 2, 0, 0, 0], [1, 1, 1, 1, 1, 1, 0, 0]]
                .concat();
        let made = Made::exact([8, 4], |_, _| 40.0);
        let view = DepthView::new(&ids, 8, 4).unwrap().valid_range(1, u16::MAX).unwrap();
        let job = Job { sensor: SENSOR, threads: 1, curved: true, joiner: None, observer: &mut |_| () };
        let mut old = None;
        for (min, expected) in [(0, &[12, 6, 4][..]), (4, &[12, 6]), (5, &[12, 6]), (6, &[12]), (12, &[])] {
            let found = curved_of(&mut Extraction::default(), &made.view(), &view, min, &job, old).unwrap();
            assert_eq!(
                found.regions.iter().map(|region| region.pixel_count).collect::<Vec<_>>(),
                expected,
                "min {min}"
            );
            for region in &found.regions {
                assert_eq!(found.labels.iter().filter(|&&label| label == region.label).count(), region.pixel_count);
            }
            if let Some(first) = found.regions.first() {
                assert_eq!((first.centroid, first.bounding_box.u_max), ([2.5, 1.0], 4));
            }
            old = Some(found);
        }
    }
}
