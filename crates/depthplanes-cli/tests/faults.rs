//! Inputs and machines that fail: nothing steers the terminal, nothing is read for ever, and what cannot be had is said.
#![cfg(unix)]

mod support;

use std::time::{Duration, Instant};
use support::{Bench, Ran, data, two_planes};

/// What a terminal obeys, or does not show.
fn steers(c: char) -> bool {
    (c.is_control() && c != '\n')
        || matches!(c, '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
}

/// Runs the program; nothing of what it says steers the terminal.
#[track_caller]
fn quiet(bench: &Bench, words: &[&str]) -> Ran {
    let ran = bench.run(words);
    assert!(!ran.out.contains(steers) && !ran.err.contains(steers), "{words:?}: {ran:?}");
    assert!(!ran.err.contains("panicked"), "{words:?}: {ran:?}");
    ran
}

/// Escape, bell, delete, C1, bidirectional and zero-width marks, line ends.
const NAMES: [&str; 6] = [
    "a\u{1b}[31mb.pgm",
    "a\u{7}\u{8}\u{7f}.pgm",
    "a\u{9b}31m\u{90}.pgm",
    "a\u{202e}gnp\u{2066}.pgm",
    "a\u{200b}\u{feff}.pgm",
    "a\nerror: b\r.pgm",
];

#[test]
fn names_of_files_do_not_steer_the_terminal() {
    let bench = Bench::new("faults_names");
    std::fs::create_dir(bench.folder.join("t")).unwrap();
    for name in NAMES {
        bench.write(name, &two_planes(1003));
        bench.write(&format!("t/{name}"), &two_planes(1003));
        bench.write(&format!("cut{name}"), b"P5 32 24 65535\n0");
        let escaped = r"a\u";
        for words in [
            &["detect", name][..],
            &["inspect", name],
            &["noise", name],
            &["explain", name, "--at", "9,9"],
            &["score", name, name],
            &["compare", name, "--methods", "planar", "--repeat", "1"],
        ] {
            let ran = quiet(&bench, words);
            assert!(ran.out.contains(escaped), "{words:?}: {ran:?}");
            assert_eq!(ran.code, Some(0), "{words:?}");
            assert!(!ran.out.contains("\nerror"), "{ran:?}");
        }
        for command in ["detect", "inspect", "noise"] {
            assert_eq!(quiet(&bench, &[command, &format!("cut{name}")]).fails(2).lines().count(), 1, "{name}");
        }
        quiet(&bench, &["detect", name, name, "--encoding", name]).fails(2);
        quiet(&bench, &["detect", name, &format!("--{name}")]).fails(2);
        quiet(&bench, &["detect", name, "--labels", name]).fails(2);
        quiet(&bench, &["detect", name, "--camera", &format!("gone{name}")]).fails(2);
        quiet(&bench, &["score", "t", name]).fails(2);
    }
    quiet(&bench, &["detect", "t", "--out-dir", "o"]).ok();
    quiet(&bench, &["score", "t", "o"]).ok();
    quiet(&bench, &["score", "t", "t", "--json"]).ok();
    quiet(&bench, &["noise", "t"]).ok();
}

#[test]
fn json_keeps_the_names_and_does_not_steer_the_terminal_either() {
    let bench = Bench::new("faults_json");
    for name in NAMES {
        bench.write(name, &two_planes(1003));
        for words in
            [&["detect", name, "--json"][..], &["inspect", name, "--json"], &["explain", name, "--at", "9,9", "--json"]]
        {
            let out = quiet(&bench, words).ok();
            let record: serde_json::Value = serde_json::from_str(&out).unwrap();
            assert_eq!(record["source"], name, "{words:?}");
        }
    }
}

/// An archive of one stored member, which is as good as any until its checksum is looked at.
fn archive(member: &str) -> Vec<u8> {
    let name = format!("{member}.npy");
    let mut bytes =
        [&b"PK\x03\x04\x14\0\0\0\0\0\0\0\0\0"[..], &[0; 12], &[name.len() as u8, 0, 0, 0], name.as_bytes()].concat();
    let at = bytes.len() as u32;
    bytes.extend([&b"PK\x01\x02\x14\0\x14\0\0\0\0\0\0\0\0\0"[..], &[0; 12], &[name.len() as u8, 0], &[0; 16]].concat());
    bytes.extend(name.as_bytes());
    let length = bytes.len() as u32 - at;
    bytes.extend([&b"PK\x05\x06\0\0\0\0\x01\0\x01\0"[..], &length.to_le_bytes(), &at.to_le_bytes(), &[0; 2]].concat());
    bytes
}

#[test]
fn what_stands_in_files_does_not_steer_the_terminal() {
    let bench = Bench::with_map("faults_contents");
    for steering in ["\u{1b}[31mX\u{7}", "\u{9b}1m", "\u{202e}x\u{2066}", "\u{200b}x\u{feff}\u{7f}"] {
        bench.write("x.npz", &archive(steering));
        bench.write("x.pgm", format!("P5\n{steering} 2\n255\n\0\0\0\0").as_bytes());
        bench.write("x.pfm", format!("Pf\n2 {steering}\n-1\n").as_bytes());
        bench.write(
            "x.pcd",
            format!("# .PCD v0.7\nVERSION 0.7\nFIELDS {steering}\nTYPE {steering}\nDATA {steering}\n").as_bytes(),
        );
        bench.write("x.npy", format!("\u{1}{steering}").as_bytes());
        for name in ["x.npz", "x.pgm", "x.pfm", "x.pcd", "x.npy"] {
            for words in
                [&["detect", name][..], &["inspect", name], &["inspect", name, "--json"], &["score", name, name]]
            {
                quiet(&bench, words).fails(2);
            }
            quiet(&bench, &["detect", name, "--member", steering]).fails(2);
        }
        bench.write("noise.csv", format!("1,2\n{steering},3\n").as_bytes());
        quiet(&bench, &["detect", "map.pgm", "--noise-table", "noise.csv"]).fails(2);
        for camera in
            [format!("{{\"{steering}\": 1}}"), format!("fx: {steering}"), format!("cam0=[{steering}]"), steering.into()]
        {
            bench.write("camera", camera.as_bytes());
            quiet(&bench, &["detect", "map.pgm", "--camera", "camera"]).fails(2);
        }
    }
    let Some(data) = data() else { return };
    let file = |name: &str| data.join("reports/faults").join(name).to_str().unwrap().to_string();
    for name in ["esc.npz", "esc.pfm"] {
        quiet(&bench, &["detect", &file(name)]).fails(2);
    }
    let said = quiet(&bench, &["detect", "map.pgm", "--noise-table", &file("esc.csv")]).fails(2);
    assert!(said.contains(r"line 2 is `\u001b[31mX\u0007,3`"), "{said}");
}

#[test]
fn what_has_no_end_is_refused_at_its_first_bytes_or_at_the_limit() {
    let bench = Bench::with_map("faults_endless");
    let start = Instant::now();
    for line in ["$DP detect /dev/zero", "$DP inspect /dev/urandom", "$DP detect - </dev/zero", "yes | $DP detect -"] {
        assert!(bench.shell(line).fails(2).contains("match no format"), "{line}");
    }
    bench.shell("mkfifo endless; yes >endless & $DP detect endless").fails(2);
    let header = "{ printf 'P5 640 480 65535\\n'; cat /dev/zero; }";
    let said = bench.shell(&format!("{header} | $DP detect - --max-bytes 2000000")).fails(2);
    assert!(said.contains("raise it with --max-bytes N"), "{said}");
    let said = bench.shell("$DP detect /dev/zero --raw-size 640x480 --max-bytes 2000000").fails(2);
    assert!(said.contains("--max-bytes"), "{said}");
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    // What ends is read, also from a pipe.
    bench.shell("cat map.pgm | $DP detect -").ok();
    bench.shell("mkfifo one; cat map.pgm >one & $DP detect one").ok();
    bench.shell("$DP detect /dev/stdin <map.pgm").ok();
}

#[test]
fn what_is_no_file_is_refused_for_what_it_is() {
    let bench = Bench::with_map("faults_kinds");
    let socket = std::os::unix::net::UnixListener::bind(bench.folder.join("socket"));
    let said = |words: &[&str]| bench.run(words).fails(2);
    if socket.is_ok() {
        assert!(said(&["detect", "socket"]).contains("this is a socket"));
        assert!(said(&["detect", "map.pgm", "--labels", "socket"]).contains("socket"));
    }
    assert!(said(&["detect", "map.pgm", "--camera", "."]).contains("this is a folder"));
    assert!(said(&["detect", "map.pgm", "--noise-table", "."]).contains("this is a folder"));
    assert!(said(&["detect", "map.pgm", "--camera", "/dev/zero"]).contains("the limit is"));
    assert!(bench.shell("$DP detect - <.").fails(2).contains("-: "));
}

#[test]
fn large_maps_are_refused_with_the_flag_that_allows_them() {
    let bench = Bench::with_map("faults_limits");
    let said = |words: &[&str]| bench.run(words).fails(2);
    let message = said(&["detect", "map.pgm", "--max-pixels", "767"]);
    assert!(
        message.contains(
            "number of pixels is 768, the limit is 767; if the file is trusted, raise it with --max-pixels N"
        )
    );
    assert!(said(&["inspect", "map.pgm", "--max-bytes", "99"]).contains("--max-bytes N"));
    assert!(said(&["detect", "map.pgm", "--max-pixels", "0"]).contains("a whole number from 1"));
    bench.run(&["detect", "map.pgm", "--max-pixels", "768"]).ok();
    // 100 million pixels in a few bytes are refused before they are unpacked.
    let mut picture = depthplanes_io::outputs::grey16_png(1, 1, &[7]);
    picture[16..24].copy_from_slice(&[0, 0, 0x27, 0x10, 0, 0, 0x27, 0x10]);
    let crc = crc(&picture[12..29]);
    picture[29..33].copy_from_slice(&crc.to_be_bytes());
    bench.write("large.png", &picture);
    assert!(said(&["detect", "large.png"]).contains("number of pixels is 100000000"));
}

fn crc(bytes: &[u8]) -> u32 {
    !bytes
        .iter()
        .fold(!0, |sum, &byte| (0..8).fold(sum ^ u32::from(byte), |sum, _| (sum >> 1) ^ (0xedb8_8320 * (sum & 1))))
}

#[test]
fn memory_that_cannot_be_had_is_said_beforehand() {
    let bench = Bench::with_map("faults_memory");
    let mut large = b"P5 4000 3000 65535\n".to_vec();
    large.extend(std::iter::repeat_n([7, 208], 12_000_000).flatten());
    bench.write("large.pgm", &large);
    for (limit, words) in [
        ("400000", "detect large.pgm"),
        ("400000", "detect large.pgm --method ransac --jobs 2 --threads 2"),
        ("400000", "explain large.pgm --at 1,1"),
        ("90000", "inspect large.pgm"),
        ("400000", "detect scene:room:size=5000x5000"),
    ] {
        let said = bench.shell(&format!("ulimit -v {limit}; exec $DP {words}")).fails(1);
        assert!(said.contains("are needed and cannot be had"), "{words}: {said}");
    }
    // One that cannot be done does not end the others.
    let ran = bench.shell("ulimit -v 400000; exec $DP detect large.pgm map.pgm");
    assert!(ran.out.contains("map.pgm: 32 x 24") && ran.fails(1).contains("1 of 2 inputs failed"));
    std::fs::remove_file(bench.folder.join("large.pgm")).unwrap();
}

#[test]
fn where_no_thread_can_be_made_the_work_is_done_without() {
    let bench = Bench::with_map("faults_threads");
    bench.write("other.pgm", &two_planes(2000));
    // No machine has room for such stacks.
    let ran = bench.shell("RUST_MIN_STACK=70368744177664 $DP detect map.pgm other.pgm --jobs 2 --threads 2");
    assert!(ran.err.contains("note: threads cannot be made"), "{ran:?}");
    assert!(ran.err.contains("note: only 0 of 2 threads can be made"), "{ran:?}");
    assert_eq!(ran.ok(), bench.run(&["detect", "map.pgm", "other.pgm"]).ok());
}
