//! Whether the channels of a picture are the bytes of one value.
//!
//! In: interleaved samples. Out: what to say of them, with the encodings to try, the likeliest first.
//!
//! Where the high byte of a value steps by one between neighbours, the low byte wraps round: the value itself changes
//! little. In colours of a picture nothing wraps round, so that such a step would change the value by 256. Random bytes
//! would wrap in one step of eight.

use crate::frame::Pixels;

/// Fewer steps of a high byte say nothing.
const FEWEST_STEPS: usize = 8;
/// A channel of as few levels is a mask, or labels.
const MASK_LEVELS: usize = 8;
/// What neighbours differ by less than, a quarter of which random bytes would keep.
const SMALL: i32 = 128;
/// A distance that a scene is likely to have, metres: the guess whose median is nearest to it, by ratio, comes first.
const LIKELY_M: f64 = 2.5;
/// Units a metre of CARLA's 24 bits, which count parts of 1000 m.
const CARLA: f64 = 16_777.215;

/// The samples as bytes: numbers to 255, or bytes that were widened to 16 bits.
pub(crate) fn bytes(pixels: &Pixels) -> Option<Vec<u8>> {
    match pixels {
        Pixels::U8(values) => Some(values.clone()),
        Pixels::U16(values) if values.iter().all(|value| *value <= 255) => {
            Some(values.iter().map(|value| *value as u8).collect())
        }
        Pixels::U16(values) if values.iter().all(|value| value.is_multiple_of(257)) => {
            Some(values.iter().map(|value| (value / 257) as u8).collect())
        }
        Pixels::U16(_) => None,
        Pixels::F32(values) => {
            let is_byte = |value: &f32| value.fract() == 0.0 && (0.0..=255.0).contains(value);
            values.iter().all(is_byte).then(|| values.iter().map(|value| *value as u8).collect())
        }
    }
}

/// What to say of a picture of two to four channels, the last of which is opacity if `alpha`; `None` if its channels are
/// no bytes of one value.
pub(super) fn explain(pixels: &Pixels, width: usize, channels: usize, alpha: bool) -> Option<String> {
    let bytes = bytes(pixels)?;
    let picture = Picture { bytes: &bytes, width, channels };
    let colours = channels - usize::from(alpha);
    let (which, guesses) = floats(&picture).or_else(|| integers(&picture, colours))?;
    let tries = guesses.join(", or ");
    Some(format!("the bytes of one value seem to be spread over {which}: try --encoding {tries}"))
}

type Guess = (String, Vec<String>);

#[derive(Clone, Copy)]
struct Picture<'a> {
    bytes: &'a [u8],
    width: usize,
    channels: usize,
}

impl Picture<'_> {
    fn pixels(&self) -> impl Iterator<Item = &[u8]> {
        self.bytes.chunks_exact(self.channels)
    }

    /// Pixels side by side and one above the other.
    fn neighbours(&self) -> impl Iterator<Item = (&[u8], &[u8])> {
        let beside = self.pixels().zip(self.pixels().skip(1));
        beside.chain(self.pixels().zip(self.pixels().skip(self.width)))
    }

    /// How many different bytes a channel has.
    fn levels(&self, channel: usize) -> usize {
        let mut seen = [false; 256];
        self.pixels().for_each(|pixel| seen[usize::from(pixel[channel])] = true);
        seen.iter().filter(|seen| **seen).count()
    }

    fn varies(&self, channel: usize) -> bool {
        self.pixels().any(|pixel| pixel[channel] != self.bytes[channel])
    }

    fn name(&self, channel: usize) -> &'static str {
        match (self.channels, channel) {
            (2, 0) => "the first channel",
            (2, _) => "the second channel",
            (_, 0) => "red",
            (_, 1) => "green",
            (_, 2) => "blue",
            _ => "opacity",
        }
    }

    /// Pixels in rows and in columns of three.
    fn triples(&self) -> impl Iterator<Item = [&[u8]; 3]> {
        let by = |step: usize| self.pixels().zip(self.pixels().skip(step)).zip(self.pixels().skip(2 * step));
        by(1).chain(by(self.width)).map(|((one, two), three)| [one, two, three])
    }

    /// Whether `low` wraps round where `high` steps.
    fn carries(&self, low: usize, high: usize) -> bool {
        let value = |pixel: &[u8]| i32::from(pixel[high]) * 256 + i32::from(pixel[low]);
        if self.levels(low) <= MASK_LEVELS {
            return false;
        }
        let is_most = |carried: usize, steps: usize| steps >= FEWEST_STEPS && 2 * carried > steps;
        let (mut steps, mut carried) = (0usize, 0usize);
        for (one, other) in self.neighbours() {
            // A step from nothing to a value is a gap of the map.
            if one[high].abs_diff(other[high]) == 1 && value(one) != 0 && value(other) != 0 {
                steps += 1;
                carried += usize::from((value(one) - value(other)).abs() < SMALL);
            }
        }
        if is_most(carried, steps) {
            return true;
        }
        // Where the value changes by more than a low byte holds from pixel to pixel, it does so evenly.
        (steps, carried) = (0, 0);
        for [one, two, three] in self.triples() {
            let jumps = one[low].abs_diff(two[low]) >= 64 || two[low].abs_diff(three[low]) >= 64;
            let moves = one[high] != two[high] || two[high] != three[high];
            if jumps && moves && [one, two, three].iter().all(|pixel| value(pixel) != 0) {
                steps += 1;
                carried += usize::from((value(one) - 2 * value(two) + value(three)).abs() < SMALL);
            }
        }
        is_most(carried, steps)
    }

    /// The median over the pixels that are not 0 of a number made of each.
    fn median(&self, of: impl Fn(&[u8]) -> f64) -> f64 {
        let mut values: Vec<f64> = self.pixels().map(of).filter(|value| *value != 0.0).collect();
        let middle = values.len() / 2;
        if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f64::total_cmp).1 }
    }
}

/// 32-bit floats in four channels: nearly all are depths, and neighbours are alike.
fn floats(picture: &Picture) -> Option<Guess> {
    if picture.channels != 4 {
        return None;
    }
    for (name, big_endian) in [("rgba-float-little-endian", false), ("rgba-float-big-endian", true)] {
        let float = |pixel: &[u8]| {
            let bytes = [pixel[0], pixel[1], pixel[2], pixel[3]];
            f64::from(if big_endian { f32::from_be_bytes(bytes) } else { f32::from_le_bytes(bytes) })
        };
        let is_depth = |value: f64| (1e-3..1e5).contains(&value);
        let is_gap = |value: f64| value == 0.0 || !value.is_finite() || value >= 1e5;
        let (mut depths, mut others) = (0usize, 0usize);
        for value in picture.pixels().map(float) {
            depths += usize::from(is_depth(value));
            others += usize::from(!is_depth(value) && !is_gap(value));
        }
        let pairs = picture.neighbours().map(|(one, other)| (float(one), float(other)));
        let (mut compared, mut alike) = (0usize, 0usize);
        for (one, other) in pairs.filter(|(one, other)| is_depth(*one) && is_depth(*other)) {
            compared += 1;
            alike += usize::from((one / other - 1.0).abs() < 0.05);
        }
        let varied = (0..3).filter(|channel| picture.varies(*channel)).count();
        if varied > 0 && depths >= 16 && others * 20 <= depths && 10 * alike >= 8 * compared {
            let millimetres = picture.median(float) > 100.0;
            let name = if millimetres { format!("{name} --scale 1000") } else { name.to_string() };
            return Some(("all four channels (a 32-bit float)".to_string(), vec![name]));
        }
    }
    None
}

/// Integers of 16 or 24 bits.
fn integers(picture: &Picture, colours: usize) -> Option<Guess> {
    let channels = picture.channels;
    let alpha = (colours < channels).then_some(colours);
    let equal = (1..colours).all(|channel| picture.pixels().all(|pixel| pixel[channel] == pixel[0]));
    let among: Vec<usize> =
        if equal { [Some(0), alpha].into_iter().flatten().collect() } else { (0..channels).collect() };
    let pairs =
        among.iter().flat_map(|low| among.iter().map(move |high| (*low, *high))).filter(|(low, high)| low != high);
    let links: Vec<(usize, usize)> = pairs.filter(|(low, high)| picture.carries(*low, *high)).collect();
    let Some(&(low, high)) = links.first() else {
        return constant(picture, colours, alpha);
    };
    let varied = (0..colours).filter(|channel| picture.varies(*channel)).count();
    let two = |pixel: &[u8]| f64::from(pixel[high]) * 256.0 + f64::from(pixel[low]);
    let first_is_low = low < high;
    let order = if first_is_low { "bytes-low-high" } else { "bytes-high-low" };
    let mut guesses = Vec::new(); // With the median, metres.
    if varied < 3 || Some(high) == alpha || Some(low) == alpha {
        guesses.push((order.to_string(), picture.median(two) / 1000.0));
    }
    let is_neighbour = low.abs_diff(high) == 1 && low.max(high) < 3;
    // Of 24 bits, only the high byte may be the same everywhere.
    let may_be_three = || varied == 3 || !picture.varies(if first_is_low { 2 } else { 0 });
    if colours == 3 && !equal && is_neighbour && may_be_three() {
        let weights = if first_is_low { [1.0, 256.0, 65_536.0] } else { [65_536.0, 256.0, 1.0] };
        let three = |pixel: &[u8]| (0..3).map(|at| weights[at] * f64::from(pixel[at])).sum();
        let median = picture.median(three);
        if first_is_low {
            guesses.push(("rgb24-carla".to_string(), median / CARLA));
            guesses.push(("rgb24-low-high".to_string(), median / 1000.0));
        } else {
            guesses.push(("rgb24-high-low".to_string(), median / 1000.0));
            guesses.push(("rgb24-high-low --scale 256000".to_string(), median / 256_000.0));
            guesses.push((format!("rgb24-high-low --scale {CARLA}"), median / CARLA));
        }
    }
    let far = |median: &f64| (median / LIKELY_M).ln().abs();
    guesses.sort_by(|(_, one), (_, other)| far(one).total_cmp(&far(other)));
    let which = if varied == 3 && is_neighbour {
        "the three colours".to_string()
    } else {
        format!("{} (low) and {} (high)", picture.name(low), picture.name(high))
    };
    (!guesses.is_empty()).then(|| (which, guesses.into_iter().map(|(name, _)| name).collect()))
}

/// A high byte that is the same everywhere: one other channel has more levels than a mask.
fn constant(picture: &Picture, colours: usize, alpha: Option<usize>) -> Option<Guess> {
    let varied: Vec<usize> = (0..picture.channels).filter(|channel| picture.varies(*channel)).collect();
    let [low] = varied[..] else { return None };
    let high = (0..picture.channels).find(|channel| {
        let opaque = Some(*channel) == alpha && picture.bytes[*channel] == u8::MAX && colours == 3;
        *channel != low && picture.bytes[*channel] != 0 && !opaque
    })?;
    // The grey of a picture beside a constant opacity is the picture.
    if picture.levels(low) <= MASK_LEVELS || colours == 1 && low == 0 {
        return None;
    }
    let order = if low < high { "bytes-low-high" } else { "bytes-high-low" };
    Some((
        format!("{} (low) and {} (high, the same everywhere)", picture.name(low), picture.name(high)),
        vec![order.into()],
    ))
}
