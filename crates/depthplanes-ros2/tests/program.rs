//! The program: its help, wrong invocations, and the commands of docs/ros2.md.

mod support;

use std::process::{Command, Output};
use std::time::Duration;
use support::{Domain, said_within};

fn run(words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_depthplanes-ros2")).args(words).output().unwrap()
}

#[test]
fn help_is_a_page() {
    let output = run(&["-h"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && text.contains("--camera-info"), "{text}");
    assert!(text.lines().count() < 45, "{} lines", text.lines().count());
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
}

#[test]
fn wrong_words_are_said_with_what_is_accepted() {
    for (words, told) in [
        (&["--domain-id", "300"][..], "accepted: 0 to 232"),
        (&["--depth", "/a b"], "accepted: letters, digits and underscores"),
        (&["--name", "7th"], "accepted: a name such as depthplanes"),
        (&["--camera-height=-1"], "camera"),
        (&["--method", "ngaf", "--noise", "1"], "noise"),
        (&["--up", "1,2"], "accepted: 3 numbers"),
        (&["--preset", "none"], "none"),
    ] {
        let output = run(&[&["--localhost"], words].concat());
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{words:?}: {said}");
        assert!(said.contains(told), "{words:?}: {said}");
    }
}

#[test]
fn the_commands_of_the_page_start_the_node() {
    let page = include_str!("../../../docs/ros2.md");
    let commands: Vec<&str> = page.lines().filter_map(|line| line.strip_prefix("depthplanes-ros2 ")).collect();
    assert!(commands.len() > 4, "{commands:?}");
    for command in commands {
        let words: Vec<&str> = command.split_whitespace().collect();
        let mut node = Domain::new().node_alone(&words);
        let said = said_within(&mut node, Duration::from_secs(60), " waits for images on ", || ());
        let flag = words.iter().position(|word| *word == "--depth").map(|at| words[at + 1]);
        let remap = words.iter().find_map(|word| word.strip_prefix("depth:="));
        let depth = flag.or(remap).unwrap_or("/camera/depth/image_rect_raw");
        assert!(said.contains(depth), "{command}: {said}");
        assert!(node.end().contains("0 images were searched, 0 were dropped"), "{command}");
    }
}
