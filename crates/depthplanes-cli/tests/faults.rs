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
    let said = bench.shell(&format!("{header} | $DP detect -")).fails(2);
    assert!(said.contains("ends after 614417 bytes") && said.contains("head -c 614417"), "{said}");
    let said = bench.shell(&format!("{header} | $DP detect - --max-bytes 600000")).fails(2);
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

/// Small maps by a name and their bytes, each of a format whose header states the size.
fn headed_maps() -> Vec<(&'static str, Vec<u8>)> {
    let values: Vec<u16> = (0..32 * 24).map(|at| if at % 32 < 16 { 1003 } else { 1503 }).collect();
    let little: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    let floats: Vec<u8> = values.iter().flat_map(|&value| (f32::from(value) / 1000.0).to_le_bytes()).collect();
    let header = format!("{:<117}\n", "{'descr': '<u2', 'fortran_order': False, 'shape': (24, 32), }");
    // One strip behind the header, then the page: width, height, bits, grey, place, rows, length.
    let entries = [(256, 32), (257, 24), (258, 16), (262, 1), (273, 8), (278, 24), (279, 1536)];
    let page = entries.iter().flat_map(|(tag, value): &(u16, u32)| {
        [&tag.to_le_bytes()[..], &4u16.to_le_bytes(), &1u32.to_le_bytes(), &value.to_le_bytes()].concat()
    });
    let page: Vec<u8> = page.collect();
    let text: Vec<String> = values.iter().map(u16::to_string).collect();
    vec![
        ("m.png", depthplanes_io::outputs::grey16_png(32, 24, &values)),
        ("m.pgm", two_planes(1003)),
        ("t.pgm", format!("P2\n32 24\n65535\n{}\n", text.join("  ")).into_bytes()),
        ("m.pfm", [&b"Pf\n32 24\n-1.0\n"[..], &floats].concat()),
        ("m.npy", [&b"\x93NUMPY\x01\0\x76\0"[..], header.as_bytes(), &little].concat()),
        ("m.tif", [&b"II*\0"[..], &1544u32.to_le_bytes(), &little, &7u16.to_le_bytes(), &page, &[0; 4]].concat()),
    ]
}

#[test]
fn a_pipe_is_read_no_further_than_its_map_can_reach() {
    let bench = Bench::new("faults_headed");
    for (name, bytes) in headed_maps() {
        bench.write(name, &bytes);
        let whole = bench.run(&["detect", name, "--encoding", "millimetre"]).ok();
        let row = |text: &str| text.lines().skip(1).map(str::to_string).collect::<Vec<_>>();
        for tail in ["true", "head -c 5000 /dev/zero"] {
            let line = format!("{{ cat {name}; {tail}; }} | $DP detect - --encoding millimetre");
            assert_eq!(row(&bench.shell(&line).ok()), row(&whole), "{line}");
        }
        for tail in ["/dev/zero", "/dev/urandom"] {
            let start = Instant::now();
            let line = format!("ulimit -v 400000; {{ cat {name}; cat {tail}; }} | $DP detect -");
            let said = bench.shell(&line).fails(2);
            assert!(said.contains("more follow without an end"), "{line}: {said}");
            assert!(start.elapsed() < Duration::from_secs(5), "{line}");
        }
    }
    // A beginning alone, and then anything.
    for begin in [
        r"\211PNG\r\n\032\n",
        r"\211PNG\r\n\032\n\000\000\000\015IHDR\000\000\002\200\000\000\001\340\020",
        r"P5 64 48 255\n",
        r"II*\0",
    ] {
        for tail in ["/dev/zero", "/dev/urandom"] {
            let start = Instant::now();
            bench.shell(&format!("{{ printf '{begin}'; cat {tail}; }} | $DP detect -")).fails(2);
            assert!(start.elapsed() < Duration::from_secs(5), "{begin}");
        }
    }
    // What a header asks for beyond the limit is said before it is read.
    let said = bench.shell("{ printf 'P5 60000 60000 65535\n'; cat /dev/zero; } | $DP detect -").fails(2);
    assert!(said.contains("--max-bytes N"), "{said}");
    let said = bench.shell("$DP detect /dev/zero --raw-size 640x480 --raw-type uint16").fails(2);
    assert!(said.contains("head -c 614400"), "{said}");
}

#[test]
fn a_pipe_that_nobody_writes_into_is_waited_for_and_that_is_said() {
    let bench = Bench::with_map("faults_fifo");
    let whole = bench.run(&["detect", "map.pgm"]).ok();
    for words in ["detect pipe", "inspect pipe", "detect map.pgm --camera pipe", "score map.pgm pipe"] {
        let line = format!("rm -f pipe; mkfifo pipe; timeout 3 $DP {words}");
        let ran = bench.shell(&line);
        assert_eq!(ran.code, Some(124), "{words}: {ran:?}");
        assert!(ran.err.contains("note: pipe: waiting: this is a pipe"), "{words}: {ran:?}");
    }
    // A writer that comes late is heard.
    let ran = bench.shell("rm -f pipe; mkfifo pipe; { sleep 1.5; cat map.pgm >pipe; } & $DP detect pipe");
    assert!(ran.err.contains("note: pipe: waiting"), "{ran:?}");
    assert_eq!(ran.ok().replace("pipe", "map.pgm"), whole);
    let ran = bench.shell("rm -f pipe; mkfifo pipe; cat map.pgm >pipe & $DP detect pipe");
    assert!(!ran.err.contains("waiting"), "{ran:?}");
    assert_eq!(ran.ok().replace("pipe", "map.pgm"), whole);
}

#[test]
fn jobs_for_which_there_is_no_memory_wait_for_each_other() {
    let bench = Bench::new("faults_jobs");
    let mut large = b"P5 3000 2000 65535\n".to_vec();
    large.extend((0..6_000_000u32).flat_map(|at| (if at % 3000 < 1500 { 1003u16 } else { 1503 }).to_be_bytes()));
    for name in ["a.pgm", "b.pgm", "c.pgm", "d.pgm"] {
        bench.write(name, &large);
    }
    let words = "detect a.pgm b.pgm c.pgm d.pgm --labels-of";
    let words = words.replace(" --labels-of", "");
    let one = bench.shell(&format!("ulimit -v 3000000; exec $DP {words}")).ok();
    let ran = bench.shell(&format!("ulimit -v 3000000; exec $DP {words} --jobs 3"));
    assert!(ran.err.contains("no memory for so many maps at once"), "{ran:?}");
    assert_eq!(ran.ok(), one);
    assert!(!bench.shell(&format!("exec $DP {words} --jobs 2")).err.contains("memory"));
    std::fs::remove_dir_all(&bench.folder).unwrap();
}

#[test]
fn formats_that_this_build_does_not_read_are_not_named_as_accepted() {
    let bench = Bench::new("faults_exr");
    let is_built = cfg!(feature = "exr");
    bench.write("m.exr", b"\x76\x2f\x31\x01\x02\0\0\0channels\0");
    bench.write("unknown", b"\x01\x02\x03\x04\x05\x06\x07\x08\x09");
    let said = bench.run(&["detect", "unknown"]).fails(2);
    assert_eq!(said.contains("EXR"), is_built, "{said}");
    assert!(said.contains("TIFF"), "{said}");
    let formats = bench.run(&["formats"]).ok();
    assert_eq!(formats.to_lowercase().contains("exr"), is_built, "{formats}");
    for words in [&["detect", "m.exr"][..], &["inspect", "m.exr"], &["detect", "."], &["detect", "*.exr"]] {
        let said = bench.run(words).fails(2);
        assert_eq!(said.contains("--features exr"), !is_built, "{words:?}: {said}");
    }
    let help = bench.run(&["detect", "--help"]).ok();
    assert_eq!(help.contains("EXR"), is_built, "{help}");
}

#[test]
fn a_link_that_leads_nowhere_is_said_and_the_other_maps_are_read() {
    let bench = Bench::new("faults_dangling");
    std::fs::create_dir_all(bench.folder.join("maps/below")).unwrap();
    bench.write("maps/a.pgm", &two_planes(1003));
    bench.write("maps/below/b.pgm", &two_planes(1003));
    for gone in ["maps/gone.pgm", "maps/below/gone.png", "maps/gone.npy"] {
        std::os::unix::fs::symlink("/nowhere/at/all", bench.folder.join(gone)).unwrap();
    }
    for (words, gone, count) in [
        (&["inspect", "maps"][..], &["maps/gone.pgm", "maps/gone.npy"][..], 2),
        (&["detect", "maps", "--recursive"], &["maps/gone.pgm", "maps/below/gone.png", "maps/gone.npy"], 3),
        (&["detect", "maps/*.pgm"], &["maps/gone.pgm"], 1),
    ] {
        let ran = quiet(&bench, words);
        assert_eq!(ran.code, Some(0), "{ran:?}");
        assert!(gone.iter().all(|name| ran.err.contains(&format!("{name}: left out"))), "{ran:?}");
        assert_eq!(ran.err.matches("left out").count(), count, "{ran:?}");
    }
}

#[test]
fn what_is_no_file_in_a_folder_of_a_report_is_refused_in_time() {
    for name in ["rows.jsonl", ".lock", "rows.torn.jsonl"] {
        let bench = Bench::with_map("faults_pipe_of_rows");
        std::fs::create_dir_all(bench.folder.join("own/kinect_v1")).unwrap();
        bench.write("own/kinect_v1/depth1.png", &[]);
        std::fs::create_dir_all(bench.folder.join("report")).unwrap();
        if name == "rows.torn.jsonl" {
            bench.write("report/rows.jsonl", b"{torn");
        }
        bench.shell(&format!("mkfifo report/{name}")).ok();
        let start = Instant::now();
        let words = "timeout 20 \"$DP\" eval kinect --data own --methods ngaf --repeat 1 --report report";
        let said = bench.shell(words).fails(2);
        assert!(said.contains(name) && start.elapsed() < Duration::from_secs(15), "{said}");
    }
}
