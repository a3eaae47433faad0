//! Detection behind a lens: the pinhole picture is made, a method finds planes in it, and what it found is carried back to
//! the pixels of the map.
//!
//! Labels, pixel counts, boxes, centroids, shares and the fit in map units are those of the map's own pixels. What is in
//! metres is from the pinhole picture, where planes are affine in inverse depth.

use super::rectify::{NONE, Rectifier};
use crate::components::selection::LabelledRun;
use crate::coplanar::Joiner;
use crate::detection::{Curved, CurvedRegion, Detection, Part, Plane};
use crate::error::Result;
use crate::limits::MAX_PLANES;
use crate::map::{AnyView, DepthView, Pixel, with_view};
use crate::noise::RoundingFinder;
use crate::sensor::Sensor;
use crate::statistics::{PlaneStatistics, Seen};
use crate::util::memory::reserve_to;

/// The memory for maps of one size; it is filled anew where size, camera or lens change.
#[derive(Default)]
pub(crate) struct Lens {
    rectifier: Option<Rectifier>,
    finder: RoundingFinder,
    pictures: (Vec<u8>, Vec<u16>, Vec<f32>),
    found: Detection,
    carrier: Carrier,
    pieces: Vec<u16>,
}

/// Whether a sensor has a lens to be straightened out.
fn is_bent(sensor: &Sensor) -> bool {
    sensor.intrinsics.is_some() && sensor.distortion.is_some_and(|distortion| !distortion.is_none())
}

impl Lens {
    /// Whether maps of that sensor have to go through here.
    pub(crate) fn is_needed(sensor: &Sensor) -> bool {
        is_bent(sensor)
    }

    /// Runs `detect` on the pinhole picture of a map, with the sensor of that picture, and carries what it finds back.
    ///
    /// # Errors
    /// Those of `detect`.
    pub(crate) fn through(
        &mut self,
        map: &AnyView<'_>,
        sensor: &Sensor,
        mut joiner: Option<&mut Joiner>,
        detect: impl FnOnce(AnyView<'_>, Sensor, Option<&mut Joiner>, &mut Detection) -> Result<()>,
        out: &mut Detection,
    ) -> Result<()> {
        let Lens { found, carrier, pieces, .. } = self;
        let mut found = std::mem::take(found);
        found.parts.clear();
        let (mut carrier, mut pieces) = (std::mem::take(carrier), std::mem::take(pieces));
        let result = self
            .with_picture(map, sensor, |picture, sensor| detect(picture, sensor, joiner.as_deref_mut(), &mut found));
        if result.is_ok() {
            let rectifier = self.rectifier.as_ref().expect("made for the picture");
            let plain = Sensor { intrinsics: None, distortion: None, ..*sensor };
            with_view!(map, map => carrier.carry(map, rectifier, &plain, &found, out));
            if let Some(joiner) = joiner.filter(|_| !found.parts.is_empty()) {
                joiner.paint_pieces(found.width * found.height, found.width, &mut pieces);
                with_view!(map, map => carrier.carry_parts(map, rectifier, &plain, &pieces, &found.parts, out));
            }
        }
        (self.found, self.carrier, self.pieces) = (found, carrier, pieces);
        result
    }

    /// Runs something on the pinhole picture of a map, with the sensor of that picture.
    fn with_picture<R>(
        &mut self,
        map: &AnyView<'_>,
        sensor: &Sensor,
        run: impl FnOnce(AnyView<'_>, Sensor) -> Result<R>,
    ) -> Result<R> {
        let (camera, distortion) = sensor.intrinsics.zip(sensor.distortion).expect("asked for");
        let size = [map.width(), map.height()];
        if !self.rectifier.as_ref().is_some_and(|made| made.is_for(size, &camera, &distortion)) {
            self.rectifier = Some(Rectifier::new(size, &camera, &distortion));
        }
        let rectifier = self.rectifier.as_ref().expect("made above");
        let straight = Sensor { intrinsics: Some(rectifier.pinhole), distortion: None, ..*sensor };
        fn picture<'a, T: Pixel>(
            rectifier: &Rectifier,
            map: &DepthView<'_, T>,
            sensor: &Sensor,
            finder: &mut RoundingFinder,
            pixels: &'a mut Vec<T>,
        ) -> Result<AnyView<'a>> {
            rectifier.resample(map, &sensor.value_kind, finder, pixels);
            Ok(rectifier.view(map, pixels)?.into())
        }
        let finder = &mut self.finder;
        let (of_u8, of_u16, of_f32) = &mut self.pictures;
        let view = match map {
            AnyView::U8(map) => picture(rectifier, map, sensor, finder, of_u8)?,
            AnyView::U16(map) => picture(rectifier, map, sensor, finder, of_u16)?,
            AnyView::F32(map) => picture(rectifier, map, sensor, finder, of_f32)?,
        };
        run(view, straight)
    }

    /// Runs `explain` on the pinhole picture at the pixel that shows `at`; none if none does. The labels that it names are
    /// turned into those of the map by the function that it is given.
    ///
    /// # Errors
    /// Those of `explain`.
    pub(crate) fn explain<R>(
        &mut self,
        map: &AnyView<'_>,
        sensor: &Sensor,
        at: [usize; 2],
        explain: impl FnOnce(AnyView<'_>, Sensor, [usize; 2]) -> Result<R>,
    ) -> Result<Option<R>> {
        let pixel = at[1] * map.width() + at[0];
        self.with_picture(map, sensor, |_, _| Ok(()))?; // the table
        let rectifier = self.rectifier.as_ref().expect("made above");
        let (there, width) = (rectifier.back[pixel], rectifier.size[0]);
        if there == NONE {
            return Ok(None);
        }
        let there = there as usize;
        self.with_picture(map, sensor, |view, sensor| explain(view, sensor, [there % width, there / width])).map(Some)
    }

    /// The label in the map of each label of the picture, from 1, after [`Lens::through`]; 0 for one that is not in the map.
    pub(crate) fn names(&self) -> &[u16] {
        &self.carrier.names
    }

    /// A label image of the map as one of its pinhole picture.
    pub(crate) fn labels_of_picture(&mut self, map: &AnyView<'_>, sensor: &Sensor, labels: &[u16]) -> Result<Vec<u16>> {
        self.with_picture(map, sensor, |_, _| Ok(()))?;
        let rectifier = self.rectifier.as_ref().expect("made above");
        let view = DepthView::new(labels, map.width(), map.height())?;
        Ok(rectifier.nearest(&view))
    }
}

/// Carries labels back; reuses its memory.
#[derive(Default)]
struct Carrier {
    labels: Vec<u16>,
    counts: Vec<u32>,
    order: Vec<u16>,
    /// For each label of the picture from 1 that of the map, or 0.
    names: Vec<u16>,
    runs: Vec<LabelledRun>,
    statistics: PlaneStatistics,
    planes: Vec<Plane>,
}

impl Carrier {
    /// Labels of the picture in `labels`, as labels of the map's valid pixels, largest first.
    fn carry_labels<T: Pixel>(&mut self, map: &DepthView<'_, T>, rectifier: &Rectifier, labels: &[u16], most: usize) {
        let validity = map.validity();
        reserve_to(&mut self.labels, map.area());
        let pixels = map.rows().flatten().zip(&rectifier.back);
        self.labels.extend(pixels.map(|(&value, &at)| match at {
            NONE => 0,
            at if validity.holds(value) => labels[at as usize],
            _ => 0,
        }));
        reserve_to(&mut self.counts, MAX_PLANES + 1);
        self.counts.resize(most + 1, 0);
        self.labels.iter().for_each(|&label| self.counts[usize::from(label)] += 1);
        reserve_to(&mut self.order, MAX_PLANES);
        self.order.extend((1..=most as u16).filter(|&label| self.counts[usize::from(label)] > 0));
        let counts = &self.counts;
        self.order.sort_unstable_by_key(|&label| (std::cmp::Reverse(counts[usize::from(label)]), label));
        reserve_to(&mut self.names, MAX_PLANES);
        self.names.resize(most, 0);
        self.order.iter().zip(1..).for_each(|(&label, name)| self.names[usize::from(label) - 1] = name);
        let names = &self.names;
        self.labels.iter_mut().filter(|label| **label > 0).for_each(|label| *label = names[usize::from(*label) - 1]);
        self.find_runs(map.width(), map.area());
    }

    fn find_runs(&mut self, width: usize, area: usize) {
        reserve_to(&mut self.runs, area);
        for (v, row) in (0..).zip(self.labels.chunks(width)) {
            let mut u_first = 0;
            for stretch in row.chunk_by(|a, b| a == b) {
                let end = u_first + stretch.len() as u32;
                if stretch[0] > 0 {
                    self.runs.push(LabelledRun { v, u_first, u_last: end - 1, label: stretch[0] });
                }
                u_first = end;
            }
        }
    }

    /// The records of the runs in the map's own units.
    fn describe<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        plain: &Sensor,
        valid_pixels: usize,
        planes: &mut Vec<Plane>,
    ) {
        self.statistics.tally(map, &self.runs, 0, plain, 1);
        let seen = Seen { sensor: plain, noise: None, valid_pixels };
        self.statistics.describe(map, &self.runs, &seen, 1, planes);
    }

    fn carry<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        rectifier: &Rectifier,
        plain: &Sensor,
        found: &Detection,
        out: &mut Detection,
    ) {
        (out.width, out.height) = (map.width(), map.height());
        (out.valid_pixels, out.filled_pixels) = (map.valid_pixels(), 0);
        out.noise = found.noise;
        let old = out.curved.take();
        out.curved = found.curved.as_ref().map(|curved| {
            self.carry_labels(map, rectifier, &curved.labels, curved.regions.len());
            self.statistics.tally(map, &self.runs, 0, plain, 1);
            let Curved { mut labels, mut regions } = old.unwrap_or_default();
            labels.clone_from(&self.labels);
            regions.clear();
            regions.extend((1..).zip(self.statistics.tallies()).map(|(label, tally)| CurvedRegion {
                label,
                pixel_count: tally.pixel_count,
                bounding_box: tally.bounding_box,
                centroid: tally.centroid,
            }));
            Curved { labels, regions }
        });
        self.carry_labels(map, rectifier, &found.labels, found.planes.len());
        self.describe(map, plain, out.valid_pixels, &mut out.planes);
        for (plane, &old) in out.planes.iter_mut().zip(&self.order) {
            plane.metric = found.planes[usize::from(old) - 1].metric;
        }
        out.labels.clone_from(&self.labels);
        out.parts.clear();
    }

    /// The parts of planes that were joined, whose labels before are in `pieces`.
    fn carry_parts<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        rectifier: &Rectifier,
        plain: &Sensor,
        pieces: &[u16],
        parts: &[Part],
        out: &mut Detection,
    ) {
        let unions = std::mem::take(&mut self.names);
        let most = usize::from(pieces.iter().max().copied().unwrap_or(0));
        self.carry_labels(map, rectifier, pieces, most);
        let mut planes = std::mem::take(&mut self.planes);
        self.describe(map, plain, out.valid_pixels, &mut planes);
        for (plane, &old) in planes.iter_mut().zip(&self.order) {
            let Some(part) = parts.iter().find(|part| part.plane.label == old) else { continue };
            let of = unions.get(usize::from(part.of) - 1).copied().unwrap_or(0);
            plane.metric = part.plane.metric;
            if of > 0 {
                out.parts.push(Part { of, plane: plane.clone() });
            }
        }
        out.parts.sort_by_key(|part| (part.of, part.plane.label));
        (self.names, self.planes) = (unions, planes);
    }
}
