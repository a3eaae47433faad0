//! What a word of the command line says of a source: a file or folder, and a topic in it.

use std::path::Path;

/// The file or folder of a word, and the topic behind it, if one is stated: `FILE:/topic`. Several topics are one text:
/// `/depth:/imu`.
///
/// ```
/// use std::path::Path;
/// assert_eq!(depthplanes_video::path_and_topic("walk.mcap:/depth/image"), (Path::new("walk.mcap"), Some("/depth/image")));
/// assert_eq!(depthplanes_video::path_and_topic("walk.mcap"), (Path::new("walk.mcap"), None));
/// ```
pub fn path_and_topic(word: &str) -> (&Path, Option<&str>) {
    if word.starts_with("scene:") || Path::new(word).exists() {
        return (Path::new(word), None);
    }
    let ends = || word.match_indices(":/").map(|(at, _)| at).filter(|at| *at > 0);
    match ends().find(|at| Path::new(&word[..*at]).exists()).or(ends().next()) {
        Some(at) => (Path::new(&word[..at]), Some(&word[at + 1..])),
        None => (Path::new(word), None),
    }
}

/// The topics of such a text.
pub(crate) fn topics(stated: Option<&str>) -> Vec<&str> {
    let Some(text) = stated else { return Vec::new() };
    let starts = std::iter::once(0).chain(text.match_indices(":/").map(|(at, _)| at + 1));
    let starts: Vec<usize> = starts.chain([text.len() + 1]).collect();
    starts.windows(2).map(|pair| &text[pair[0]..pair[1] - 1]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_names_a_file_and_any_number_of_topics() {
        assert_eq!(path_and_topic("no.mcap:/depth:/imu"), (Path::new("no.mcap"), Some("/depth:/imu")));
        assert_eq!(topics(Some("/depth:/imu")), ["/depth", "/imu"]);
        assert_eq!(topics(Some("/depth")), ["/depth"]);
        assert!(topics(None).is_empty());
    }
}
