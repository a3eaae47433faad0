//! `depthplanes eval --peers`: other people's methods in the same report, by a peer made up of a few lines of shell.
#![cfg(unix)]

mod support;

use serde_json::Value;
use support::Bench;

const SET: &str = "scene:planes3:seed=1-2,size=160x120";
/// What a peer of one method says of it.
const LIST: &str = r#"{"peers":[{"name":"flat","version":"flatland 2.1","parameters":"level 7"}]}"#;

/// Writes a peer that answers the list so, and each map by the lines `on_map`; `$folder` is the map's folder. Every
/// question is a line of `asked`.
fn peer(bench: &Bench, list: &str, on_map: &str) {
    let script = format!(
        r#"while read -r question; do
    echo "$question" >> asked
    case $question in
    *list*) echo '{list}' ;;
    *)
        folder=${{question#*'"folder":"'}}
        folder=${{folder%%'"'*}}
        {on_map} ;;
    esac
done
"#
    );
    bench.write("peer.sh", script.as_bytes());
}

/// One plane over the whole map.
const ONE_PLANE: &str = r#"ls "$folder" >> seen
        { echo P2 160 120 255; yes 7 | head -n 19200; } > "$folder/all.pgm"
        echo '{"labels":"all.pgm","median_ms":2.5,"least_ms":1.25}'"#;

fn eval(bench: &Bench) -> support::Ran {
    bench.run(&["eval", SET, "--methods", "planar", "--peers", "sh peer.sh", "--repeat", "2", "--report", "report"])
}

fn rows(bench: &Bench) -> Vec<Value> {
    let text = String::from_utf8(bench.read("report/rows.jsonl")).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn lines(bench: &Bench, file: &str) -> Vec<String> {
    String::from_utf8(bench.read(file)).unwrap().lines().map(String::from).collect()
}

#[test]
fn a_peer_is_scored_and_shown_as_our_methods_are() {
    let bench = Bench::new("peers_report");
    peer(&bench, LIST, ONE_PLANE);
    let out = eval(&bench).ok();
    assert!(out.lines().any(|line| line.starts_with("flat  ")), "{out}");
    let own: Vec<Value> = rows(&bench).into_iter().filter(|row| row["label"] == "flat").collect();
    assert_eq!(own.len(), 2);
    let (row, found) = (&own[0], &own[0]["outcome"]["found"]);
    assert_eq!([&row["method"], &row["version"], &row["parameters"]], ["flat", "flatland 2.1", "level 7"]);
    assert_eq!(
        [&found["median_ms"], &found["least_ms"], &found["planes"]].map(Value::as_f64),
        [2.5, 1.25, 1.0].map(Some)
    );
    assert_eq!(found["labelled_pixels"], row["valid_pixels"], "pixels without a value have no plane");
    assert!(
        found["scores"]["segcomp.correct"].as_f64() == Some(0.0) && found["scores"]["planes.truth"] == 3.0,
        "{found}"
    );
    let page = String::from_utf8(bench.read("report/report.html")).unwrap();
    assert!(page.contains("<dt>flat</dt><dd>flatland 2.1; level 7</dd>"), "no peer among the facts");
    assert!(page.contains("flat: 1 plane<"), "no picture of the peer");
    assert!(page.contains(concat!("<dd>depthplanes ", env!("CARGO_PKG_VERSION"), "</dd>")), "another program");
    assert_eq!(lines(&bench, "seen"), ["depth.npy", "values.npy", "depth.npy", "values.npy"]);
    let question: Value = serde_json::from_str(&lines(&bench, "asked")[1]).unwrap();
    assert!(question["peer"] == "flat" && question["repeat"] == 2 && question["metric"] == true, "{question}");
    assert!(question["camera"]["fx"].as_f64().unwrap() > 0.0, "{question}");
}

#[test]
fn an_evaluation_that_goes_on_asks_a_peer_for_no_map_again() {
    let bench = Bench::new("peers_again");
    peer(&bench, LIST, ONE_PLANE);
    eval(&bench).ok();
    let before = rows(&bench);
    std::fs::remove_file(bench.folder.join("asked")).unwrap();
    let again = eval(&bench);
    assert!(again.err.contains("4 of 4 results are there already"), "{again:?}");
    assert_eq!((lines(&bench, "asked").len(), rows(&bench)), (1, before));
    // Another version is another method.
    peer(&bench, &LIST.replace("2.1", "2.2"), ONE_PLANE);
    assert!(eval(&bench).err.contains("2 of 4 results are there already"));
}

#[test]
fn a_refusal_of_a_peer_is_a_row() {
    let bench = Bench::new("peers_refuses");
    peer(&bench, LIST, r#"echo '{"refused":"it sees no curtains"}'"#);
    let ran = eval(&bench);
    assert!(ran.err.contains("2 of 4 results are refusals"), "{ran:?}");
    let page = String::from_utf8(bench.read("report/report.html")).unwrap();
    assert!(page.contains("flat on scene:planes3:seed=1,size=160x120: it sees no curtains"), "no refusal");
}

#[test]
fn what_is_wrong_with_a_peer_is_said() {
    let bench = Bench::new("peers_wrong");
    let says = |code: i32, list: &str, on_map: &str, parts: &[&str]| {
        peer(&bench, list, on_map);
        let ran = bench.run(&["eval", SET, "--peers", "sh peer.sh", "--repeat", "1", "--report", "report"]);
        assert_eq!(ran.code, Some(code), "{ran:?}");
        let missing = parts.iter().find(|part| !ran.err.contains(**part));
        assert!(missing.is_none() && !ran.err.contains("panicked"), "no {missing:?}: {ran:?}");
    };
    let dies = r#"echo 'the roof fell in' >&2; exit 3"#;
    says(
        1,
        LIST,
        dies,
        &["the roof fell in", "ended without an answer", "3", "seed=1,size=160x120: --peers sh peer.sh"],
    );
    says(1, LIST, "echo hello", &["it answered `hello`", "a line like {\"labels\""]);
    says(1, "[]", "", &["asked for its methods, it answered `[]`", "a line like {\"peers\""]);
    let small = r#"echo 'P2 1 1 255 7' > "$folder/a"; echo '{"labels":"a","median_ms":1,"least_ms":1}'"#;
    says(1, LIST, small, &["flat: its labels are 1 x 1, the map is 160 x 120"]);
    let absent = r#"echo '{"labels":"nowhere.npy","median_ms":1,"least_ms":1}'"#;
    says(2, LIST, absent, &["nowhere.npy"]);
    says(2, &LIST.replace("flat\"", "planar\""), "", &["`planar` is the name of another method"]);
    let start = |command: &str| bench.run(&["eval", SET, "--peers", command, "--report", "report"]).fails(2);
    assert!(start("./absent").contains("`./absent` cannot be started"));
    assert!(start(" ").contains("it names no program"));
    // What was made before is kept: that of planar on the first map.
    assert_eq!(rows(&bench).len(), 1);
}
