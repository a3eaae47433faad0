//! Maps with more pixels than measurements, at the size at which they were measured.
//!
//! In: a map. Out: what the stages are to see instead of it ([`Reduced`]), and what was found in that on the pixels of the
//! map. Of a map that was enlarged by repeating pixels ([`EnlargementFinder`]) it is the source, one value a pixel. Of a
//! map that was measured at few of its pixels ([`SparseFinder`]) it is one measured pixel for each bin.

use crate::components::{ConnectedComponents, Run};
use crate::error::Result;
use crate::explanation::Finding;
use crate::map::{DepthView, Pixel, Validity};
use crate::noise::{Enlargement, EnlargementFinder, Sparse, SparseFinder};
use crate::util::memory::reserve_to;

/// What the stages see instead of a map.
pub(crate) enum Reduced<'a> {
    /// Each pixel of the source once.
    Repeated(Enlargement<'a>),
    /// One measured pixel of each bin.
    Sparse(Sparse<'a>),
}

impl Reduced<'_> {
    /// Columns and rows of the map for one of the source.
    pub(crate) fn factor(&self) -> [f64; 2] {
        match self {
            Reduced::Repeated(enlargement) => enlargement.factor,
            Reduced::Sparse(sparse) => sparse.side.map(|side| side as f64),
        }
    }

    /// Where a source pixel lies among those that it stands for, columns and rows from the first.
    pub(crate) fn centre(&self) -> [f64; 2] {
        match self {
            Reduced::Repeated(enlargement) => enlargement.factor.map(|factor| (factor - 1.0) / 2.0),
            Reduced::Sparse(sparse) => sparse.centre,
        }
    }

    /// How far off that it is, source pixels, one standard deviation.
    pub(crate) fn jitter(&self) -> f64 {
        match self {
            Reduced::Repeated(_) => 0.0,
            Reduced::Sparse(sparse) => sparse.jitter,
        }
    }

    /// The source pixel of a pixel.
    pub(crate) fn place(&self, at: [usize; 2]) -> [usize; 2] {
        match self {
            Reduced::Repeated(enlargement) => [0, 1].map(|axis| {
                let firsts = [enlargement.columns, enlargement.rows][axis];
                firsts.partition_point(|&first| first as usize <= at[axis]) - 1
            }),
            Reduced::Sparse(sparse) => [0, 1].map(|axis| at[axis] / sparse.side[axis]),
        }
    }

    /// What `explain` says of it.
    pub(crate) fn finding(&self, [column, row]: [usize; 2]) -> Finding {
        let subject = format!("the pixel's source, column {column}, row {row}: what follows is of the source");
        let what = match self {
            Reduced::Repeated(_) => "the map was enlarged by repeating pixels",
            Reduced::Sparse(_) => "the map was measured at few of its pixels; one stands for each bin",
        };
        let [x, y] = self.factor();
        Finding::new("map", subject, what).with("columns", x, "").with("rows", y, "")
    }

    /// The source of a map.
    pub(crate) fn source<'a, T: Pixel>(
        &self,
        map: &DepthView<'_, T>,
        pixels: &'a mut Vec<f32>,
    ) -> Result<DepthView<'a, f32>> {
        match self {
            Reduced::Repeated(enlargement) => shrunk(map, enlargement, pixels),
            Reduced::Sparse(sparse) => chosen(map, sparse, pixels),
        }
    }
}

/// Finds out whether the stages are to see something else than the map itself; reuses its memory.
#[derive(Default)]
pub(crate) struct ReducedFinder {
    enlargement: EnlargementFinder,
    sparse: SparseFinder,
}

impl ReducedFinder {
    /// What they are to see; `None` for the map itself.
    pub(crate) fn find<T: Pixel>(&mut self, map: &DepthView<'_, T>) -> Option<Reduced<'_>> {
        let ReducedFinder { enlargement, sparse } = self;
        match enlargement.find(map) {
            Some(enlargement) => Some(Reduced::Repeated(enlargement)),
            None => sparse.find(map).map(Reduced::Sparse),
        }
    }
}

/// The source of a map.
fn shrunk<'a, T: Pixel>(
    map: &DepthView<'_, T>,
    Enlargement { columns, rows, .. }: &Enlargement<'_>,
    pixels: &'a mut Vec<f32>,
) -> Result<DepthView<'a, f32>> {
    reserve_to(pixels, map.area());
    for &v in *rows {
        let row = map.row(v as usize);
        pixels.extend(columns.iter().map(|&u| row[u as usize].to_f32()));
    }
    let Validity { low, high, sentinel } = map.validity();
    let view = DepthView::new(&pixels[..], columns.len(), rows.len())?;
    view.missing_value(sentinel.to_f32()).valid_range(low.to_f32(), high.to_f32())
}

/// One measured pixel for each bin of a sparse map; not a number where there is none.
fn chosen<'a, T: Pixel>(
    map: &DepthView<'_, T>,
    sparse: &Sparse<'_>,
    pixels: &'a mut Vec<f32>,
) -> Result<DepthView<'a, f32>> {
    reserve_to(pixels, map.area());
    let value = |at: usize| map.row(at / map.width())[at % map.width()].to_f32();
    pixels.extend(
        sparse.pixels.iter().map(|&pixel| if pixel == Sparse::EMPTY { f32::NAN } else { value(pixel as usize) }),
    );
    DepthView::new(&pixels[..], sparse.size[0], sparse.size[1])
}

/// Labels of the source on the measured pixels that each stands for.
pub(crate) fn paint<'a, T: Pixel>(
    labels: &[u16],
    reduced: &Reduced<'_>,
    map: &DepthView<'_, T>,
    image: &'a mut Vec<u16>,
) -> Result<DepthView<'a, u16>> {
    let sparse = match reduced {
        Reduced::Repeated(enlargement) => return enlarge(labels, enlargement, map, image),
        Reduced::Sparse(sparse) => sparse,
    };
    reserve_to(image, map.area());
    let validity = map.validity();
    for (v, row) in map.rows().enumerate() {
        let labels = &labels[v / sparse.side[1] * sparse.size[0]..][..sparse.size[0]];
        let of_pixel = |(u, &value): (usize, &T)| if validity.holds(value) { labels[u / sparse.side[0]] } else { 0 };
        image.extend(row.iter().enumerate().map(of_pixel));
    }
    DepthView::new(&image[..], map.width(), map.height())?.valid_range(1, u16::MAX)
}

/// Labels of the source as an image of the whole map, in which 0 is missing.
fn enlarge<'a, T: Pixel>(
    labels: &[u16],
    Enlargement { columns, rows, .. }: &Enlargement<'_>,
    map: &DepthView<'_, T>,
    image: &'a mut Vec<u16>,
) -> Result<DepthView<'a, u16>> {
    let (width, height) = (map.width(), map.height());
    reserve_to(image, map.area());
    for (k, labels) in labels.chunks(columns.len()).enumerate() {
        let first = image.len();
        let ends = columns[1..].iter().copied().chain([width as u32]);
        for ((&label, &from), to) in labels.iter().zip(*columns).zip(ends) {
            image.extend(std::iter::repeat_n(label, (to - from) as usize));
        }
        let end = rows.get(k + 1).map_or(height, |&row| row as usize);
        (rows[k] as usize + 1..end).for_each(|_| image.extend_from_within(first..first + width));
    }
    DepthView::new(image, width, height)?.valid_range(1, u16::MAX)
}

/// Joins groups of one label: pieces that were one plane in the source.
#[derive(Default)]
pub(crate) struct Pieces {
    pairs: Vec<[u32; 2]>,
    /// For each label the first group that has it.
    first: Vec<Option<u32>>,
}

impl Pieces {
    /// Makes room for maps of so many pixels.
    pub(crate) fn reserve(&mut self, area: usize) {
        reserve_to(&mut self.pairs, area);
        reserve_to(&mut self.first, usize::from(u16::MAX) + 1);
    }

    /// Joins the groups of the pixels of each label.
    pub(crate) fn join(&mut self, labels: &DepthView<'_, u16>, components: &mut ConnectedComponents) {
        let Pieces { pairs, first } = self;
        reserve_to(pairs, labels.area());
        first.clear();
        first.resize(usize::from(u16::MAX) + 1, None);
        components.groups().each_run(|Run { v, u_first, group, .. }| {
            let label = labels.row(v as usize)[u_first as usize];
            let first = *first[usize::from(label)].get_or_insert(group);
            if first != group && pairs.last() != Some(&[first, group]) {
                pairs.push([first, group]);
            }
        });
        components.unite(pairs);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::components::Connectivity;
    use crate::util::random::Random;

    /// The first places of source pixels that are two or three wide, and how long the whole is.
    fn firsts(random: &mut Random, count: usize) -> (Vec<u32>, usize) {
        let mut next = 0;
        let mut first = |_| {
            let first = next;
            next += random.whole(2, 3) as u32;
            first
        };
        let firsts = (0..count).map(&mut first).collect();
        (firsts, next as usize)
    }

    #[test]
    fn labels_that_are_enlarged_and_shrunk_again_are_the_same_and_each_pixel_has_that_of_its_source() {
        let (mut random, mut image, mut pixels) = (Random::new(2), vec![9; 3], Vec::new());
        for _ in 0..20 {
            let [(columns, width), (rows, height)] = [0; 2].map(|_| {
                let count = random.whole(1, 30);
                firsts(&mut random, count)
            });
            let enlargement = Enlargement { columns: &columns, rows: &rows, factor: [2.5, 2.5] };
            let labels: Vec<u16> = (0..columns.len() * rows.len()).map(|_| random.whole(0, 5) as u16).collect();
            let map = vec![1.0f32; width * height];
            let map = DepthView::new(&map, width, height).unwrap();
            let whole = enlarge(&labels, &enlargement, &map, &mut image).unwrap();
            assert_eq!((whole.width(), whole.height()), (width, height));
            for (u, v) in (0..height).flat_map(|v| (0..width).map(move |u| (u, v))) {
                let [column, row] = [(u, &columns), (v, &rows)]
                    .map(|(at, firsts)| firsts.iter().filter(|&&first| first as usize <= at).count() - 1);
                assert_eq!(whole.row(v)[u], labels[row * columns.len() + column], "at {u}, {v}");
            }
            let source = shrunk(&whole, &enlargement, &mut pixels).unwrap();
            assert_eq!(source.rows().flatten().map(|&label| label as u16).collect::<Vec<_>>(), labels);
            // What is missing of the whole is missing of the source.
            assert_eq!(source.valid_pixels(), labels.iter().filter(|&&label| label > 0).count());
        }
    }

    #[test]
    fn pieces_of_one_label_are_one_group_and_those_of_two_stay_two() {
        let labels: [u16; 24] = [
            1, 1, 0, 1, 0, 2, //
            0, 0, 0, 0, 0, 2, //
            2, 0, 3, 3, 0, 0, //
            2, 0, 0, 0, 1, 1, //
        ];
        let view = DepthView::new(&labels, 6, 4).unwrap().valid_range(1, u16::MAX).unwrap();
        let mut components = ConnectedComponents::default();
        let mut pieces = Pieces::default();
        for _ in 0..2 {
            components.group(&view, &Connectivity::new(view.validity(), 0.0).unwrap(), 1);
            assert_eq!(components.groups().count(), 6);
            pieces.join(&view, &mut components);
            assert_eq!(components.groups().sizes(), [5, 4, 2]);
        }
    }
}
