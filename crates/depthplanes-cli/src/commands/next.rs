//! What to type next: a `detect` command for a file that was looked at. Proposals only; nothing is applied.

use crate::args::Reading;
use crate::terminal::plain;
use depthplanes::ValueKind;
use depthplanes_io::Frame;
use depthplanes_io::encoding::ENCODINGS;
use depthplanes_io::inspect::Summary;
use depthplanes_io::presets::{SENSOR_PRESETS, SensorPreset};

/// The lines, without their heading.
pub(super) fn lines(name: &str, frame: &Frame, seen: &Summary, given: &Reading) -> Vec<String> {
    if seen.range.is_none() {
        return Vec::new();
    }
    if seen.warnings.iter().any(|warning| warning.contains("is this a label image")) {
        return vec!["nothing, if it is one: the regions are in it; `depthplanes score` compares label images".into()];
    }
    let (words, encoding) = flags(frame, seen, given);
    let words: Vec<String> = [name.to_string()].into_iter().chain(words).map(|word| quoted(&word)).collect();
    let mut lines = vec![format!("depthplanes detect {}", plain(&words.join(" ")))];
    if frame.sensor.intrinsics.is_none() && frame.format != "scene" && encoding != "grey" {
        lines.extend(camera(frame, &encoding));
    }
    lines
}

/// The flags that were given and those that the notes propose, and the encoding that these make.
fn flags(frame: &Frame, seen: &Summary, given: &Reading) -> (Vec<String>, String) {
    let mut words = given.words.clone();
    let mut encoding = seen.encoding.to_string();
    for proposed in seen.warnings.iter().filter_map(|warning| proposed(warning, given)) {
        if !words.contains(&proposed[0]) {
            if proposed[0] == "--encoding" {
                encoding.clone_from(&proposed[1]);
            }
            words.extend(proposed);
        } else if proposed[0] == "--raw-size"
            && let Some(at) = words.iter().position(|word| *word == proposed[0])
        {
            words[at + 1].clone_from(&proposed[1]);
        }
    }
    let told = ["--encoding", "--preset", "--disparity", "--scale"];
    let is_told = words.iter().any(|word| told.contains(&word.as_str()));
    if !is_told && frame.format != "scene" && ENCODINGS.iter().any(|known| known.name == encoding) {
        words.extend(["--encoding".to_string(), encoding.clone()]);
    }
    (words, encoding)
}

/// The flag that a note says to try beside those given, with its value if it takes one.
fn proposed(warning: &str, given: &Reading) -> Option<Vec<String>> {
    let (_, rest) = warning.split_once("try --")?;
    let plain = |word: &str| word.trim_end_matches([',', ';', ':', ')', '.']).to_string();
    let mut words = rest.split_whitespace().map(plain);
    let (flag, value) = (format!("--{}", words.next()?), words.next());
    let with_value: Vec<String> = [Some(flag.clone()), value].into_iter().flatten().collect();
    // The type of headerless samples makes sense beside their size alone.
    let beside: Vec<String> = given
        .raw_size
        .filter(|_| flag == "--raw-type")
        .map_or(Vec::new(), |(width, height)| vec!["--raw-size".into(), format!("{width}x{height}")]);
    let is_read = |words: &Vec<String>| Reading::from_words(&[beside.as_slice(), words].concat()).is_ok();
    [with_value, vec![flag]].into_iter().find(is_read)
}

/// What makes the planes metric.
fn camera(frame: &Frame, encoding: &str) -> Vec<String> {
    let mut lines = vec!["for metres add the calibration of your camera:".to_string()];
    if frame.sensor.value_kind == ValueKind::Disparity {
        lines.push("  --baseline METRES with --intrinsics FX,FY,CX,CY, or --camera FILE".into());
    } else {
        lines.push("  --intrinsics FX,FY,CX,CY or --camera FILE".into());
    }
    let fits = |preset: &&SensorPreset| {
        let size = preset.camera.map(|(width, height, _)| (width, height));
        size == Some((frame.width, frame.height)) && preset.encoding == encoding
    };
    let fitting: Vec<&SensorPreset> = SENSOR_PRESETS.iter().filter(fits).collect();
    if !fitting.is_empty() {
        let size = format!("{} x {}", frame.width, frame.height);
        lines.push(format!("or, if it is one of these sensors with {size} pixels, its nominal camera (less exact):"));
        lines.extend(fitting.iter().map(|preset| format!("  --preset {:<11} {}", preset.name, preset.about)));
    }
    lines
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./:=,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

#[cfg(test)]
mod tests {
    use super::{proposed, quoted};
    use crate::args::Reading;

    #[test]
    fn flags_are_taken_from_notes() {
        let flags = |note| proposed(note, &Reading::default()).map(|words| words.join(" "));
        assert_eq!(flags("5 % are 65535: try --missing 65535").as_deref(), Some("--missing 65535"));
        assert_eq!(flags("often so: try --encoding tum, or --disparity").as_deref(), Some("--encoding tum"));
        assert_eq!(flags("swapped: try --swap-bytes").as_deref(), Some("--swap-bytes"));
        assert_eq!(flags("of each other: try --swap-bytes first").as_deref(), Some("--swap-bytes"));
        assert_eq!(flags("try --no-such-flag 3"), None);
        assert_eq!(flags("only 5 different values: is this a label image?"), None);
    }

    #[test]
    fn words_are_quoted_for_the_shell() {
        assert_eq!(
            ["a/b-1.png", "a b", "it's", "$x", ""].map(quoted),
            ["a/b-1.png", "'a b'", r"'it'\''s'", "'$x'", "''"]
        );
    }
}
