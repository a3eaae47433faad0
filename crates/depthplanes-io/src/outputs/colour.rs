//! A colour for each label: well apart for neighbours in number, the same in every picture.
//!
//! Hues advance by the golden angle in OKLCH (Ottosson 2020), which spreads any first few labels
//! evenly over the circle. Labels whose hues come close again are 8, 13, 21 .. numbers apart
//! (Fibonacci). Three tones in turn tell those of 8 and 13 apart, and every second 21 labels are
//! darker.

/// 360 degrees over the square of the golden ratio.
const GOLDEN_ANGLE_DEG: f64 = 137.507_764_050_037_85;
/// Hue of label 1: a blue, which no depth grey is mistaken for.
const FIRST_HUE_DEG: f64 = 255.0;
/// Lightness and chroma, repeating.
const TONES: [(f64, f64); 3] = [(0.68, 0.17), (0.83, 0.15), (0.56, 0.18)];
/// After so many labels hues and tones come close to those of the first.
const TURN: usize = 21;
/// How much darker every second turn is.
const DARKER: f64 = 0.07;

/// Share of the plane's colour in pictures; the rest is the map's grey, so that relief stays visible.
pub(super) const COLOUR_SHARE: f32 = 0.58;

/// The colour of a label in overlays and clouds, sRGB. Label 0, no plane, is black.
pub fn colour(label: u16) -> [u8; 3] {
    if label == 0 {
        return [0; 3];
    }
    let step = usize::from(label - 1);
    let hue = (FIRST_HUE_DEG + step as f64 * GOLDEN_ANGLE_DEG).to_radians();
    let (lightness, chroma) = TONES[step % TONES.len()];
    let darker = DARKER * (step / TURN % 2) as f64;
    within_gamut(lightness - darker, chroma, hue)
}

/// The colour of a lasting id, from 1; from 65536 on the colours come again.
pub fn id_colour(id: u32) -> [u8; 3] {
    colour((id.saturating_sub(1) % u32::from(u16::MAX)) as u16 + 1)
}

/// The colours of labels `0..=planes`.
pub(super) fn palette(planes: usize) -> Vec<[u8; 3]> {
    (0..=planes).map(|label| colour(label as u16)).collect()
}

/// The colour of that lightness and hue, with as much of the chroma as sRGB can show.
fn within_gamut(lightness: f64, mut chroma: f64, hue: f64) -> [u8; 3] {
    loop {
        let linear = oklab_to_linear([lightness, chroma * hue.cos(), chroma * hue.sin()]);
        if linear.iter().all(|channel| (0.0..=1.0).contains(channel)) || chroma <= 0.0 {
            return linear.map(encode_srgb);
        }
        chroma -= 0.005;
    }
}

/// OKLab to linear sRGB, with the matrices of Ottosson's "A perceptual color space for image
/// processing".
fn oklab_to_linear([l, a, b]: [f64; 3]) -> [f64; 3] {
    let long = (l + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let medium = (l - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let short = (l - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    [
        4.076_741_662_1 * long - 3.307_711_591_3 * medium + 0.230_969_929_2 * short,
        -1.268_438_004_6 * long + 2.609_757_401_1 * medium - 0.341_319_396_5 * short,
        -0.004_196_086_3 * long - 0.703_418_614_7 * medium + 1.707_614_701_0 * short,
    ]
}

fn encode_srgb(linear: f64) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::colour;

    fn distance(a: [u8; 3], b: [u8; 3]) -> f64 {
        a.iter().zip(b).map(|(&x, y)| (f64::from(x) - f64::from(y)).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn the_first_labels_are_well_apart() {
        for (labels, least) in [(20, 40.0), (42, 15.0)] {
            for (a, b) in (1..=labels).flat_map(|a| (1..a).map(move |b| (a, b))) {
                let apart = distance(colour(a), colour(b));
                assert!(apart > least, "labels {a} and {b}: {:?} {:?}, {apart:.0} apart", colour(a), colour(b));
            }
        }
    }

    #[test]
    fn labels_that_follow_each_other_are_never_alike() {
        for label in 2..=u16::MAX {
            assert!(distance(colour(label - 1), colour(label)) > 60.0, "labels {} and {label}", label - 1);
        }
    }

    #[test]
    fn label_zero_is_black_and_the_last_label_is_not() {
        assert_eq!(colour(0), [0; 3]);
        assert_ne!(colour(u16::MAX), [0; 3]);
    }
}
