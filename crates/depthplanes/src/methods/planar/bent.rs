//! Surfaces that bend, as regions of their own; only where they are asked for.
//!
//! In: the regions of tiles, of which some are facets of curved surfaces. Out: connected regions of facets, pixel by
//! pixel. Facets side by side are one surface unless there is a step between them; a pixel that a plane takes is
//! not theirs. As of planes, a region has more than `min` pixels.

use super::Runner;
use super::curved::are_apart;
use super::planes::of_image;
use crate::detection::{Curved, CurvedRegion};
use crate::error::Result;
use crate::group::{LinkRule, reserve_to};
use crate::map::{DepthView, Pixel};
use crate::methods::Job;
use crate::methods::finish::Finisher;
use crate::noise::NoiseModel;

/// Memory of this stage.
#[derive(Debug, Default)]
pub(super) struct Bent {
    /// For each region of tiles one that it is joined to, or itself.
    parents: Vec<u16>,
}

impl Bent {
    fn root(&self, mut id: u16) -> u16 {
        while self.parents[usize::from(id)] != id {
            id = self.parents[usize::from(id)];
        }
        id
    }

    fn join(&mut self, [a, b]: [u16; 2]) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[usize::from(a.max(b))] = a.min(b);
    }
}

impl Runner {
    /// Finds the curved regions of the map that was just run; overwrites the region image. `old`: memory to reuse.
    ///
    /// # Errors
    /// [`crate::Error::TooManyPlanes`] if they are more than labels can name.
    pub(super) fn find_bent<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        job: &Job<'_>,
        noise: &NoiseModel,
        old: Option<Curved>,
    ) -> Result<Curved> {
        self.assign(noise, true, job.threads);
        self.join_facets(noise);
        let Runner { params, field, image, finisher, .. } = self;
        curved_of(finisher, map, &of_image(image, field)?, params.min, job, old)
    }

    /// Gives the facets of one surface one number in the region image.
    fn join_facets(&mut self, noise: &NoiseModel) {
        let Runner { regions, merger, bent, image, pyramid, .. } = self;
        let all = &regions.all;
        reserve_to(&mut bent.parents, pyramid.grids[0].len());
        bent.parents.extend((0..all.len()).map(|id| id as u16));
        for pair in &merger.pairs {
            if pair.ids.iter().all(|&id| all[id as usize].is_curved) && !are_apart(all, noise, pair) {
                bent.join(pair.ids.map(|id| id as u16));
            }
        }
        image.iter_mut().filter(|id| **id > 0).for_each(|id| *id = bent.root(*id - 1) + 1);
    }
}

/// The curved regions of an image of labels. `old`: memory to reuse.
///
/// # Errors
/// [`crate::Error::TooManyPlanes`] if they are more than labels can name.
pub(super) fn curved_of<T: Pixel>(
    finisher: &mut Finisher,
    map: &DepthView<'_, T>,
    ids: &DepthView<'_, u16>,
    min: u32,
    job: &Job<'_>,
    old: Option<Curved>,
) -> Result<Curved> {
    let Finisher { grouper, selection, describer } = finisher;
    let groups = grouper.group(ids, &LinkRule::new(ids.validity(), 0.0)?, job.threads);
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
