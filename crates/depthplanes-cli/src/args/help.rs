//! What help shows and in which order: commands in groups, flags under headings, and the flags of the short page.
//!
//! `-h` shows the flags of [`SHORT`], `--help` all of a command. A new command stands in [`GROUPS`]; a new flag in
//! [`HEADINGS`] if it is one on reading, and in [`SHORT`] if most people need it.

use super::exit_codes::EXIT_CODES;
use clap::Command;

/// Commands under a heading of `depthplanes -h`.
struct Group {
    heading: &'static str,
    commands: &'static [&'static str],
}

/// All commands, by who needs them.
const GROUPS: &[Group] = &[
    Group {
        heading: "Find planes",
        commands: &["detect", "floor", "track", "serve", "inspect", "explain", "noise", "demo"],
    },
    Group { heading: "See what there is", commands: &["presets", "encodings", "formats", "methods", "params"] },
    Group { heading: "Set up", commands: &["completions", "man"] },
    Group {
        heading: "Research: measure methods and compare them",
        commands: &["score", "compare", "eval", "datasets", "paper"],
    },
];

/// Headings of the flags on reading.
const HEADINGS: &[(&str, &[&str])] = &[
    ("Reading: the camera", &["preset", "intrinsics", "camera", "camera-size", "rectified", "ray-distance"]),
    ("Reading: the numbers", &["encoding", "scale", "depth-scale", "missing", "valid-range"]),
    ("Reading: stereo", &["disparity", "focal", "baseline", "doffs"]),
    (
        "Reading: files of special kinds",
        &["raw-size", "raw-type", "member", "page", "swap-bytes", "max-pixels", "max-bytes"],
    ),
];

/// The flags on the short page of a command. Commands that are not here show all of theirs.
const SHORT: &[(&str, &[&str])] = &[
    (
        "detect",
        &[
            "labels",
            "overlay",
            "planes",
            "cloud",
            "mesh",
            "out-dir",
            "only",
            "table",
            "legend",
            "outlines",
            "json",
            "preset",
            "intrinsics",
            "camera",
            "encoding",
            "scale",
            "method",
            "min-pixels",
            "noise-scale",
            "merge-coplanar",
        ],
    ),
    ("explain", &["at", "json", "preset", "intrinsics", "camera", "encoding", "scale", "method", "min-pixels"]),
    (
        "floor",
        &[
            "up",
            "camera-height",
            "overlay",
            "grid",
            "json",
            "preset",
            "intrinsics",
            "camera",
            "encoding",
            "scale",
            "method",
            "noise-scale",
        ],
    ),
    (
        "track",
        &[
            "out",
            "labels",
            "overlays",
            "out-dir",
            "floor",
            "live",
            "frames",
            "preset",
            "intrinsics",
            "camera",
            "encoding",
            "scale",
            "method",
            "noise-scale",
        ],
    ),
    (
        "serve",
        &[
            "port",
            "bind",
            "host",
            "up",
            "camera-height",
            "preset",
            "intrinsics",
            "camera",
            "encoding",
            "scale",
            "raw-size",
            "method",
        ],
    ),
    ("inspect", &["recursive", "json", "preset", "intrinsics", "camera", "encoding", "scale", "raw-size"]),
    ("noise", &["recursive", "json", "preset", "intrinsics", "camera", "encoding", "scale", "raw-size"]),
    (
        "compare",
        &[
            "methods",
            "picture",
            "truth",
            "truth-from",
            "repeat",
            "threads",
            "preset",
            "intrinsics",
            "camera",
            "encoding",
            "scale",
        ],
    ),
    ("eval", &["methods", "peers", "data", "report", "repeat", "jobs", "threads"]),
];

/// The heading of a flag on reading.
pub(super) fn heading(flag: &str) -> &'static str {
    HEADINGS.iter().find(|(_, flags)| flags.contains(&flag)).map_or("Reading", |(heading, _)| heading)
}

/// Hides what the command's short page leaves out, and says there where it is.
pub(super) fn with_short_page(command: Command) -> Command {
    let name = command.get_name().to_string();
    let Some((_, shown)) = SHORT.iter().find(|(short, _)| *short == name) else { return command };
    let command = command.mut_args(|arg| {
        let hidden = !arg.is_positional() && !shown.contains(&arg.get_id().as_str());
        arg.hide_short_help(hidden)
    });
    command.after_help(more(&name)).after_long_help(format!("{}\n\n{EXIT_CODES}", more(&name)))
}

fn more(command: &str) -> String {
    let has_method = !["inspect", "noise"].contains(&command);
    let every = if has_method { "every flag, and all parameters of the default method" } else { "every flag" };
    let rows = [
        (format!("{command} --help"), every),
        ("params METHOD".into(), "the parameters of another method, which are flags as well"),
        ("presets".into(), "the sensors; `encodings`, `formats` and `methods` list the others"),
    ];
    let rows: Vec<_> = rows.into_iter().filter(|(words, _)| has_method || words != "params METHOD").collect();
    let width = rows.iter().map(|(words, _)| words.len()).max().unwrap_or(0);
    let lines = rows.iter().map(|(words, about)| format!("\n  depthplanes {words:<width$}  {about}"));
    format!("More:{}", lines.collect::<String>())
}

/// The page of `depthplanes -h`: the commands in their groups.
pub(super) fn template(commands: &[Command]) -> String {
    let mut text = String::from("{about-with-newline}\n{usage-heading} {usage}\n");
    for group in GROUPS {
        text += &format!("\n{}:\n", group.heading);
        for name in group.commands {
            let command = commands.iter().find(|command| command.get_name() == *name);
            let about = command.and_then(|command| command.get_about()).expect("each command says what it does");
            text += &format!("  {name:<12} {about}\n");
        }
    }
    text + "\nOptions:\n{options}{after-help}"
}

#[cfg(test)]
mod tests {
    use super::{GROUPS, SHORT};

    #[test]
    fn every_command_stands_in_one_group_and_every_short_flag_is_one() {
        let program = super::super::program();
        let mut grouped: Vec<&str> = GROUPS.iter().flat_map(|group| group.commands).copied().collect();
        let mut commands: Vec<&str> = program.get_subcommands().map(|command| command.get_name()).collect();
        grouped.sort_unstable();
        commands.sort_unstable();
        assert_eq!(grouped, commands);
        for (name, flags) in SHORT {
            let command = program.find_subcommand(name).expect("a command");
            for flag in *flags {
                assert!(command.get_arguments().any(|arg| arg.get_id() == *flag), "{name} has no --{flag}");
            }
        }
    }
}
