//! The live page's server, asked as a page asks it.

mod support;

use depthplanes_io::outputs::grey16_png;
use depthplanes_serve::{Config, Server};
use serde_json::{Value, json};
use std::net::TcpListener;
use std::time::{Duration, Instant};
use support::{Page, Pipe, SCENE, request, scene, serve};

fn started() -> Server {
    serve(scene(SCENE), Config::default())
}

#[test]
fn a_page_gets_all_it_needs_before_the_first_frame() {
    let server = started();
    let mut page = Page::open(server.address());
    let hello = page.message().unwrap();
    assert_eq!(hello["type"], "hello");
    let names: Vec<&str> =
        hello["parameters"].as_array().unwrap().iter().map(|of| of["name"].as_str().unwrap()).collect();
    let known: Vec<&str> = depthplanes::methods::default().params.iter().map(|of| of.name).collect();
    assert_eq!(names, known);
    let camera = page.until("camera", |_| true);
    assert_eq!(camera["arrays"]["rays"]["length"], 2 * 160 * 120);
    let frame = page.until("frame", |_| true);
    assert_eq!(frame["camera"], camera["camera"]);
    assert_eq!(frame["arrays"]["depth"]["length"], 160 * 120);
    assert_eq!(frame["arrays"]["marks"]["length"], 160 * 120);
    let planes = frame["planes"].as_array().unwrap();
    let largest = frame["labels"].as_array().unwrap().iter().filter(|label| **label == 1).count();
    assert_eq!(planes[0]["pixel_count"], largest);
    assert_eq!(planes[0]["class"], "floor");
    let corners: u64 = frame["rings"].as_array().unwrap().iter().map(|ring| ring[2].as_u64().unwrap()).sum();
    assert_eq!(frame["arrays"]["corners_px"]["length"], 2 * corners);
    assert_eq!(frame["arrays"]["corners_m"]["length"], 3 * corners);
    let stages: Vec<&str> = frame["stages"].as_array().unwrap().iter().map(|of| of[0].as_str().unwrap()).collect();
    for stage in ["read", "tiles", "grow", "track", "ground", "outlines", "message"] {
        assert!(stages.contains(&stage), "{stages:?}");
    }
}

#[test]
fn play_pause_step_and_seek_do_what_they_say() {
    let server = started();
    let mut page = Page::open(server.address());
    page.until("frame", |frame| frame["index"] == 3);
    page.ask(json!({"type": "pause"}));
    let paused = page.until("state", |state| state["is_playing"] == false);
    let at = paused["index"].as_u64().unwrap();
    page.ask(json!({"type": "step"}));
    page.until("state", |state| state["index"] == (at + 1) % 40);
    page.ask(json!({"type": "seek", "index": 20}));
    page.until("frame", |frame| frame["index"] == 20);
    page.ask(json!({"type": "step", "back": true}));
    page.until("frame", |frame| frame["index"] == 19);
    page.ask(json!({"type": "seek", "index": 4_000_000}));
    page.until("frame", |frame| frame["index"] == 39);
    page.ask(json!({"type": "play"}));
    page.until("frame", |frame| frame["index"] == 1); // it begins anew
}

#[test]
fn what_can_be_asked_for_again_rests_while_nobody_looks() {
    let server = started();
    let mut page = Page::open(server.address());
    page.until("frame", |frame| frame["index"] == 2);
    drop(page);
    std::thread::sleep(Duration::from_millis(1000)); // 30 frames
    let frame = Page::open(server.address()).until("frame", |_| true);
    assert!((2..15).contains(&frame["index"].as_u64().unwrap()), "{}", frame["index"]);
    Page::open(server.address()).until("frame", |frame| frame["index"] == 20); // and it goes on
}

#[test]
fn it_plays_at_the_pace_of_the_source() {
    let server = started(); // 30 frames a second
    let mut page = Page::open(server.address());
    page.until("frame", |frame| frame["index"] == 2);
    let start = Instant::now();
    page.until("frame", |frame| frame["index"] == 32);
    let seconds = start.elapsed().as_secs_f64();
    assert!((0.97..3.0).contains(&seconds), "30 frames in {seconds} s");
}

#[test]
fn parameters_act_at_once_also_while_it_is_paused() {
    let server = started();
    let mut page = Page::open(server.address());
    page.until("frame", |frame| frame["index"] == 3);
    page.ask(json!({"type": "pause"}));
    page.until("state", |state| state["is_playing"] == false);
    page.ask(json!({"type": "seek", "index": 3}));
    let before = page.until("frame", |frame| frame["index"] == 3);
    page.ask(json!({"type": "set", "name": "min-pixels", "value": 3000}));
    let fewer = page.until("frame", |frame| frame["serial"].as_u64() > before["serial"].as_u64());
    assert_eq!(fewer["index"], 3);
    let count = |frame: &Value| frame["planes"].as_array().unwrap().len();
    assert!(count(&fewer) < count(&before), "{} {}", count(&fewer), count(&before));
    assert!(fewer["planes"].as_array().unwrap().iter().all(|plane| plane["pixel_count"].as_u64() > Some(3000)));
    page.ask(json!({"type": "set", "name": "min-pixels", "value": -1}));
    let refused = page.until("refused", |_| true); // this page alone is told
    assert!(refused["error"].as_str().unwrap().contains("min-pixels"), "{refused}");
    page.ask(json!({"type": "set", "name": "theta", "value": 1}));
    page.until("refused", |refused| refused["error"].as_str().is_some_and(|error| error.contains("theta")));
    let state = page.until("state", |_| true);
    assert_eq!((&state["values"][0], &state["error"]), (&json!(3000.0), &Value::Null));
    page.ask(json!({"type": "reset"}));
    page.until("state", |state| state["values"][0] == 100.0 && state["error"].is_null());
}

#[test]
fn a_pixel_without_a_plane_is_explained() {
    let server = started();
    let mut page = Page::open(server.address());
    page.ask(json!({"type": "pause"}));
    page.until("state", |state| state["is_playing"] == false);
    page.ask(json!({"type": "seek", "index": 5}));
    let frame = page.until("frame", |frame| frame["index"] == 5);
    let at = frame["labels"].as_array().unwrap().iter().position(|label| *label == 0).unwrap();
    let pixel = [at % 160, at / 160];
    page.ask(json!({"type": "explain", "serial": frame["serial"], "at": pixel}));
    let answer = page.until("explanation", |_| true);
    assert_eq!((&answer["at"], &answer["serial"]), (&json!(pixel), &frame["serial"]));
    assert!(answer["verdict"]["text"].as_str().unwrap().starts_with("No plane here"), "{answer}");
    page.ask(json!({"type": "explain", "serial": frame["serial"], "at": [160, 0]}));
    assert!(page.until("explanation", |_| true)["error"].is_string());
    page.ask(json!({"type": "explain", "serial": 0, "at": [0, 0]}));
    assert!(page.until("explanation", |_| true)["error"].as_str().unwrap().contains("has passed"));
}

#[test]
fn foreign_hosts_and_origins_get_nothing() {
    let server = started();
    let address = server.address();
    let own = format!("Origin: http://{address}\r\n");
    assert_eq!(request(address, "GET", "/", "", b"").0, 200);
    assert_eq!(request(address, "GET", "/", &own, b"").0, 200);
    assert_eq!(request(address, "GET", "/no-such-file", &own, b"").0, 404);
    let port = address.port();
    for headers in [
        "Host: evil.example\r\n".to_string(),
        format!("Host: evil.example:{port}\r\nOrigin: http://evil.example:{port}\r\n"),
        "Origin: http://evil.example\r\n".into(),
        "Origin: null\r\n".into(),
        format!("Origin: http://localhost:{port}\r\n"),
    ] {
        for (method, path) in [("GET", "/"), ("POST", "/file/map.png")] {
            let (status, answer) = request(address, method, path, &headers, b"");
            assert_eq!(status, 403, "{headers} {answer}");
            assert!(answer.contains("refused: "), "{answer}");
        }
    }
    assert_eq!(Page::try_open(address, &[("origin", "http://evil.example")]).err(), Some(403));
    assert_eq!(Page::try_open(address, &[("host", "evil.example")]).err(), Some(403));
    assert!(Page::try_open(address, &[("origin", &format!("http://{address}"))]).is_ok());
}

#[test]
fn the_page_asks_nobody_else() {
    let server = started();
    let (_, answer) = request(server.address(), "GET", "/", "", b"");
    assert!(answer.contains("content-security-policy: default-src 'self'"), "{answer}");
    for path in ["/", "/page.css"] {
        let (status, answer) = request(server.address(), "GET", path, "", b"");
        assert_eq!(status, 200);
        assert!(!answer.contains("//"), "{path} names another server");
    }
    let (_, script) = request(server.address(), "GET", "/page.js", "", b"");
    assert!(script.contains("@license") && script.contains("Three.js Authors"), "the licence of three.js");
    assert!(request(server.address(), "GET", "/licences.txt", "", b"").1.contains("Permission is hereby granted"));
}

#[test]
fn a_frozen_page_slows_nobody_and_then_gets_the_newest_frame() {
    let server = started();
    let mut frozen = Page::open(server.address());
    frozen.draws = false;
    let first = frozen.until("frame", |_| true);
    let mut others: Vec<Page> = (0..19).map(|_| Page::open(server.address())).collect();
    let start = Instant::now();
    for page in &mut others {
        page.until("frame", |frame| frame["index"] == 5);
    }
    others[0].until("frame", |frame| frame["index"] == 35);
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    let second = frozen.until("frame", |_| true);
    assert!(second["serial"].as_u64().unwrap() <= first["serial"].as_u64().unwrap() + 3, "{}", second["serial"]);
    frozen.ask(json!({"type": "drawn"}));
    let newest = frozen.until("frame", |_| true);
    assert!(newest["serial"].as_u64().unwrap() > second["serial"].as_u64().unwrap() + 20, "{}", newest["serial"]);
}

#[test]
fn a_page_that_reads_nothing_slows_nobody() {
    let server = serve(scene("scene:robot:sensor=kinect,size=640x480,frames=8"), Config::default());
    let deaf: Vec<Page> = (0..4).map(|_| Page::open(server.address())).collect();
    let mut page = Page::open(server.address());
    for index in [6, 2, 6] {
        page.until("frame", |frame| frame["index"] == index);
    }
    assert_eq!(deaf.len(), 4);
}

#[test]
fn no_more_pages_than_accepted_are_open() {
    let mut config = Config::default();
    config.limits.clients = 2;
    let server = serve(scene(SCENE), config);
    let mut pages: Vec<Page> = (0..2).map(|_| Page::open(server.address())).collect();
    assert_eq!(Page::try_open(server.address(), &[]).err(), Some(503));
    pages[0].until("frame", |_| true);
    drop(pages);
    let start = Instant::now();
    while Page::try_open(server.address(), &[]).is_err() {
        assert!(start.elapsed() < support::LONG, "closed pages make room");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn connections_above_the_limit_wait_for_others_to_end() {
    let mut config = Config::default();
    config.limits.connections = 1;
    let server = serve(scene(SCENE), config);
    let page = Page::open(server.address());
    let address = server.address();
    let waiting = std::thread::spawn(move || request(address, "GET", "/", "", b"").0);
    std::thread::sleep(Duration::from_millis(200));
    assert!(!waiting.is_finished());
    drop(page);
    assert_eq!(waiting.join().unwrap(), 200);
}

#[test]
fn what_is_no_wish_is_refused_and_a_flood_ends() {
    let server = started();
    let mut page = Page::open(server.address());
    for text in
        ["", "{}", "[1", r#"{"type":"sing"}"#, r#"{"type":"seek","index":-1}"#, r#"{"type":"set","name":"theta"}"#]
    {
        page.send_text(text);
        let refused = page.until("refused", |_| true);
        assert!(refused["error"].as_str().unwrap().contains("not understood"), "{text}: {refused}");
    }
    page.send_text(&" ".repeat(100_000));
    while page.message().is_some() {}
    assert_eq!(page.closed_with, Some(1009));
    Page::open(server.address()).until("frame", |_| true);
}

#[test]
fn a_file_that_is_dragged_in_is_shown_with_its_notes() {
    let mut config = Config::default();
    config.limits.upload_bytes = 100_000;
    let server = serve(scene(SCENE), config);
    let address = server.address();
    let mut page = Page::open(address);
    page.until("frame", |_| true);
    page.ask(json!({"type": "pause"}));
    page.until("state", |state| state["is_playing"] == false);
    page.ask(json!({"type": "seek", "index": 7}));
    page.until("frame", |frame| frame["index"] == 7);
    let wall: Vec<u16> = (0..64 * 48).map(|at| [1500, 2500, 65535][at % 64 / 25]).collect();
    let (status, answer) = request(address, "POST", "/file/a%20wall.png", "", &grey16_png(64, 48, &wall));
    assert_eq!(status, 204, "{answer}");
    let frame = page.until("frame", |frame| frame["name"] == "a wall.png");
    assert!(frame["planes"].as_array().unwrap().len() >= 2);
    assert!(frame["notes"].to_string().contains("--missing 65535"), "{}", frame["notes"]);
    let state = page.until("state", |state| state["file"] == "a wall.png");
    assert_eq!(state["is_playing"], false);
    page.ask(json!({"type": "return"}));
    let frame = page.until("frame", |frame| frame["name"].as_str().unwrap().starts_with("frame-"));
    assert_eq!(frame["index"], 7, "it goes back to the frame that was shown before");
    let (status, answer) = request(address, "POST", "/file/text.png", "", b"no map at all");
    assert_eq!(status, 422);
    assert!(answer.contains("text.png: "), "{answer}");
    assert_eq!(request(address, "POST", "/file/large.png", "", &vec![0; 100_001]).0, 413);
    page.ask(json!({"type": "play"}));
    page.until("frame", |frame| frame["index"] == 8);
}

#[test]
fn a_pipe_is_played_to_its_end_and_what_it_cannot_do_is_said() {
    let server = serve(Box::new(Pipe(scene("scene:robot:size=160x120,frames=4"))), Config::default());
    let mut page = Page::open(server.address());
    let ended = page.until("state", |state| state["has_ended"] == true);
    assert_eq!((&ended["index"], &ended["can_seek"], &ended["is_playing"]), (&json!(3), &json!(false), &json!(false)));
    page.ask(json!({"type": "seek", "index": 0}));
    page.until("state", |state| state["error"].as_str().is_some_and(|error| error.contains("start to its end")));
    let nothing = serve(scene("scene:robot:size=160x120,frames=0"), Config::default());
    let mut page = Page::open(nothing.address());
    page.until("state", |state| state["error"].as_str().is_some_and(|error| error.contains("no frame")));
}

#[test]
fn frames_that_fail_are_said_and_the_others_shown() {
    let folder = std::env::temp_dir().join(format!("depthplanes-serve-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let wall = grey16_png(64, 48, &[1500; 64 * 48]);
    for (name, bytes) in [("1.png", wall.as_slice()), ("2.png", &wall[..40]), ("3.png", &wall)] {
        std::fs::write(folder.join(name), bytes).unwrap();
    }
    let server = serve(scene(folder.to_str().unwrap()), Config::default());
    let mut page = Page::open(server.address());
    let failed = page.until("state", |state| state["error"].is_string());
    assert!(failed["error"].as_str().unwrap().contains("2.png"), "{failed}");
    assert_eq!(failed["index"], 1);
    let frame = page.until("frame", |frame| frame["index"] == 2);
    assert!(frame["ground"].is_null() && frame["camera"].is_null(), "there is no camera");
    page.until("state", |state| state["error"].is_null());
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn it_ends_with_a_farewell_and_begins_anew_at_the_same_place() {
    let server = started();
    let address = server.address();
    let mut pages: Vec<Page> = (0..3).map(|_| Page::open(address)).collect();
    pages[0].until("frame", |_| true);
    pages[1].draws = false;
    let start = Instant::now();
    server.stop();
    assert!(start.elapsed() < Duration::from_secs(5), "{:?}", start.elapsed());
    for page in &mut pages {
        while page.message().is_some() {}
    }
    let again = Server::start(TcpListener::bind(address).unwrap(), scene(SCENE), Config::default()).unwrap();
    Page::open(again.address()).until("frame", |_| true);
}
