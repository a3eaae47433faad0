//! `depthplanes serve`: where it listens, what it says, and how it ends. What the page does is tested in depthplanes-serve and
//! tests/browser.
#![cfg(unix)]

mod support;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Stdio};
use support::Bench;

const SCENE: &str = "scene:robot:sensor=kinect,size=160x120";

/// Starts it; the address that it prints.
fn start(bench: &Bench, words: &[&str]) -> (Child, String) {
    let mut command = bench.command_of(env!("CARGO_BIN_EXE_depthplanes"));
    command.arg("serve").arg(SCENE).args(words).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut line = String::new();
    BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
    (child, line.trim().to_string())
}

/// Interrupts it; its exit code and what it has said.
fn interrupt(mut child: Child) -> (Option<i32>, String) {
    let id = child.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    let mut said = String::new();
    child.stderr.as_mut().unwrap().read_to_string(&mut said).unwrap();
    (child.wait().unwrap().code(), said)
}

#[test]
fn it_listens_on_this_machine_alone_says_so_and_ends_cleanly() {
    let (child, url) = start(&Bench::new("serve_loopback"), &["--port", "0"]);
    let address = url.strip_prefix("http://127.0.0.1:").and_then(|rest| rest.strip_suffix('/'));
    let port: u16 = address.unwrap_or_else(|| panic!("{url}")).parse().unwrap();
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    write!(stream, "GET / HTTP/1.1\r\nHost: localhost:{port}\r\nConnection: close\r\n\r\n").unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 200") && answer.contains("<title>depthplanes</title>"), "{answer}");
    let (code, said) = interrupt(child);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("only this machine can open the page"), "{said}");
}

#[test]
fn letting_others_in_is_said() {
    let (child, url) = start(&Bench::new("serve_open"), &["--port", "0", "--bind", "0.0.0.0"]);
    assert!(url.starts_with("http://127.0.0.1:"), "{url}");
    let (code, said) = interrupt(child);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("note: other machines can open the page"), "{said}");
}

#[test]
fn a_port_that_is_taken_and_a_source_that_is_none_are_errors() {
    let bench = Bench::new("serve_errors");
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let program = || bench.command_of(env!("CARGO_BIN_EXE_depthplanes"));
    let ran = program().args(["serve", SCENE, "--port", &port]).output().unwrap();
    let said = String::from_utf8_lossy(&ran.stderr).into_owned();
    assert!(ran.status.code() == Some(2) && said.contains("--port 0"), "{said}");
    let ran = program().args(["serve", "no-such-folder"]).output().unwrap();
    let said = String::from_utf8_lossy(&ran.stderr).into_owned();
    assert!(ran.status.code() == Some(2) && said.contains("no-such-folder"), "{said}");
    assert!(ran.stdout.is_empty());
}
