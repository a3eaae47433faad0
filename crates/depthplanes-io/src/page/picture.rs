//! The map as a page gets it: depth as whole numbers between the least and the greatest, and no more pixels than a page
//! shows.

use depthplanes::{AnyView, DepthView, Pixel, ValueKind, with_view};

/// Most pixels that are sent; of larger maps every second, third, .. column and row is.
const MOST_PIXELS: usize = 640 * 480;

/// Depth as a page gets it.
#[derive(Debug, PartialEq)]
pub(super) struct Picture {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Columns and rows of the map from one pixel to the next.
    pub(super) step: usize,
    /// 0 where nothing was measured; else the value is `low + (code - 1) * scale`.
    pub(super) codes: Vec<u16>,
    pub(super) low: f64,
    pub(super) scale: f64,
    /// Whether values are metres of depth; else they are those of the map.
    pub(super) is_metric: bool,
}

impl Picture {
    pub(super) fn new(view: AnyView<'_>, kind: ValueKind) -> Self {
        with_view!(&view, view => Self::typed(view, kind))
    }

    fn typed<T: Pixel>(view: &DepthView<'_, T>, kind: ValueKind) -> Self {
        let step = step(view.width(), view.height());
        let is_metric = kind != ValueKind::Disparity;
        let validity = view.validity();
        let value = |pixel: T| {
            let value = validity.holds(pixel).then(|| pixel.into())?;
            if is_metric { kind.depth_m(value) } else { Some(value) }
        };
        let rows = view.rows().step_by(step);
        let values: Vec<f32> = rows
            .flat_map(|row| row.iter().step_by(step))
            .map(|&pixel| value(pixel).map_or(f32::NAN, |value| value as f32))
            .collect();
        let finite = values.iter().copied().filter(|value| value.is_finite());
        let [low, high] = finite.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        let (low, high) = if low <= high { (f64::from(low), f64::from(high)) } else { (0.0, 0.0) };
        let scale = if high > low { (high - low) / f64::from(u16::MAX - 1) } else { 1.0 };
        let code = |value: &f32| match value.is_finite() {
            true => 1 + ((f64::from(*value) - low) / scale).round().min(f64::from(u16::MAX - 1)) as u16,
            false => 0,
        };
        Picture {
            width: view.width().div_ceil(step),
            height: view.height().div_ceil(step),
            step,
            codes: values.iter().map(code).collect(),
            low,
            scale,
            is_metric,
        }
    }
}

/// Columns and rows from one pixel that is sent to the next.
pub(super) fn step(width: usize, height: usize) -> usize {
    (1..).find(|step| width.div_ceil(*step) * height.div_ceil(*step) <= MOST_PIXELS).expect("some step is enough")
}

/// What is sent of a value for each pixel of the map, row by row.
pub(super) fn thinned<T: Copy>(values: &[T], width: usize, step: usize) -> Vec<T> {
    if step == 1 {
        return values.to_vec();
    }
    values.chunks_exact(width).step_by(step).flat_map(|row| row.iter().step_by(step).copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_give_the_depth_back() {
        let pixels = [0u16, 500, 1500, 4000];
        let picture = Picture::new(DepthView::new(&pixels, 2, 2).unwrap().into(), ValueKind::depth(0.001).unwrap());
        let back = |code: u16| picture.low + f64::from(code - 1) * picture.scale;
        assert_eq!((picture.width, picture.height, picture.step, picture.codes[0]), (2, 2, 1, 0));
        for (code, metres) in picture.codes[1..].iter().zip([0.5, 1.5, 4.0]) {
            assert!((back(*code) - metres).abs() < 1e-4, "{code}: {} {metres}", back(*code));
        }
        let nothing = Picture::new(DepthView::new(&[0u16], 1, 1).unwrap().into(), ValueKind::Disparity);
        assert_eq!((nothing.codes, nothing.is_metric), (vec![0], false));
    }

    #[test]
    fn large_maps_are_thinned_evenly() {
        let pixels: Vec<u16> = (0..1300 * 1000).map(|at| 1 + (at % 1300) as u16).collect();
        let picture = Picture::new(DepthView::new(&pixels, 1300, 1000).unwrap().into(), ValueKind::Disparity);
        assert_eq!((picture.width, picture.height, picture.step), (434, 334, 3));
        assert_eq!(picture.codes.len(), 434 * 334);
        let labels = thinned(&pixels, 1300, 3);
        assert_eq!((labels.len(), labels[1], labels[434]), (434 * 334, 4, 1));
    }
}
