//! What a word of the command line says of a source: a file or folder, and a topic in it.

use std::path::Path;

/// The file or folder of a word, and the topic behind it, if one is stated: `FILE:/topic`.
///
/// ```
/// use std::path::Path;
/// assert_eq!(depthplanes_video::path_and_topic("walk.mcap:/depth/image"), (Path::new("walk.mcap"), Some("/depth/image")));
/// assert_eq!(depthplanes_video::path_and_topic("walk.mcap"), (Path::new("walk.mcap"), None));
/// ```
pub fn path_and_topic(word: &str) -> (&Path, Option<&str>) {
    match word.rfind(":/") {
        Some(at) if at > 0 && !word.starts_with("scene:") && !Path::new(word).exists() => {
            (Path::new(&word[..at]), Some(&word[at + 1..]))
        }
        _ => (Path::new(word), None),
    }
}
