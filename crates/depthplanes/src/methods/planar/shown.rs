//! Stage "merge", second part: what large regions show of the smooth part of the error.
//!
//! In: merged regions and how they bow. Out: how many times the smooth part is that was estimated. Second differences over
//! a few tiles see little of an error that is smooth over hundreds of pixels; a wall that was merged bit by bit shows it.

use super::bows::Bows;
use super::grow::Region;
use super::thresholds::{SHOWN, SHOWN_MOST, SHOWN_PIXELS, TURN};
use crate::group::reserve_to;
use crate::methods::rays::Rays;

/// Looks at regions; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Shown {
    /// Of each large region the smooth part's variance as a multiple of the estimated one, and its pixels.
    ratios: Vec<(f64, f64)>,
}

impl Shown {
    /// The deviation of the smooth part as a multiple of the estimated one, 1 or more: a share of the median of what large
    /// regions show, each counted by its pixels. Those that turn as curved surfaces do show nothing.
    pub(super) fn times(&mut self, all: &[Region], bows: &Bows, rays: &Rays, most_regions: usize) -> f64 {
        let ratios = &mut self.ratios;
        reserve_to(ratios, most_regions);
        for (id, region) in (0..).zip(all).filter(|(_, region)| region.sums.n >= SHOWN_PIXELS) {
            let is_curved = bows.is_bowed(id, region, rays, TURN);
            let ratio = if is_curved { 0.0 } else { (region.squares - region.variance) / region.smooth };
            ratios.push((ratio, region.sums.n));
        }
        ratios.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let half = ratios.iter().map(|(_, pixels)| pixels).sum::<f64>() / 2.0;
        let mut pixels_so_far = 0.0;
        let median = ratios.iter().find(|(_, pixels)| {
            pixels_so_far += pixels;
            pixels_so_far >= half
        });
        median.map_or(0.0, |(ratio, _)| SHOWN * ratio.max(0.0).sqrt()).clamp(1.0, SHOWN_MOST)
    }
}
