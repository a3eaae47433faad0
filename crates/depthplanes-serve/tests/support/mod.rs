//! Pages of the server without a browser, and plain requests.

use depthplanes_serve::{Config, Server};
use depthplanes_video::{Source, VideoFrame, open};
use serde_json::{Value, json};
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::time::{Duration, Instant};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket};

/// Longer than anything takes.
pub const LONG: Duration = Duration::from_secs(30);

/// A small scene, which never ends.
pub const SCENE: &str = "scene:robot:sensor=kinect,size=160x120,frames=40";

pub fn serve(source: Box<dyn Source>, config: Config) -> Server {
    Server::start(TcpListener::bind("127.0.0.1:0").unwrap(), source, config).unwrap()
}

pub fn scene(word: &str) -> Box<dyn Source> {
    open(word, &Default::default()).unwrap()
}

/// The frames of a scene one after the other, without a way back.
#[derive(Debug)]
pub struct Pipe(pub Box<dyn Source>);

impl Source for Pipe {
    fn next_frame(&mut self) -> Option<depthplanes_video::Result<VideoFrame>> {
        self.0.next_frame()
    }
}

/// A page.
pub struct Page {
    socket: WebSocket<TcpStream>,
    /// Whether it says that it has drawn frames.
    pub draws: bool,
    /// The newest state.
    state: Value,
    /// The code with which the server has closed the connection.
    pub closed_with: Option<u16>,
}

impl Page {
    pub fn open(address: SocketAddr) -> Page {
        Self::try_open(address, &[]).unwrap()
    }

    /// Opens it with further headers; the status of a refusal.
    pub fn try_open(address: SocketAddr, headers: &[(&'static str, &str)]) -> Result<Page, u16> {
        let mut request = format!("ws://{address}/live").into_client_request().unwrap();
        for (name, value) in headers {
            request.headers_mut().insert(*name, value.parse().unwrap());
        }
        let stream = TcpStream::connect(address).unwrap();
        stream.set_read_timeout(Some(LONG)).unwrap();
        match tungstenite::client(request, stream) {
            Ok((socket, _)) => Ok(Page { socket, draws: true, state: Value::Null, closed_with: None }),
            Err(tungstenite::HandshakeError::Failure(tungstenite::Error::Http(response))) => {
                Err(response.status().as_u16())
            }
            Err(error) => panic!("{error}"),
        }
    }

    pub fn ask(&mut self, wish: Value) {
        self.socket.send(Message::text(wish.to_string())).unwrap();
    }

    pub fn send_text(&mut self, text: &str) {
        self.socket.send(Message::text(text)).unwrap();
    }

    /// The next message; of binary ones the head. `None` when the server has closed the connection.
    pub fn message(&mut self) -> Option<Value> {
        let start = Instant::now();
        loop {
            assert!(start.elapsed() < LONG, "nothing but pings");
            match self.socket.read() {
                Ok(Message::Text(text)) => {
                    let message: Value = serde_json::from_str(&text).unwrap();
                    if message["type"] == "state" {
                        self.state = message.clone();
                    }
                    return Some(message);
                }
                Ok(Message::Binary(bytes)) => {
                    let head = head(&bytes);
                    if self.draws && head["type"] == "frame" {
                        // Where the server has ended the next message says so.
                        let _ = self.socket.send(Message::text(json!({"type": "drawn"}).to_string()));
                    }
                    return Some(head);
                }
                Ok(Message::Close(why)) => {
                    self.closed_with = why.map(|why| why.code.into());
                    return None;
                }
                Err(_) => return None,
                Ok(_) => (),
            }
        }
    }

    /// The next message of a type for which something holds; of states the one that is known, if it holds.
    pub fn until(&mut self, kind: &str, holds: impl Fn(&Value) -> bool) -> Value {
        if kind == self.state["type"] && holds(&self.state) {
            return self.state.clone();
        }
        let start = Instant::now();
        while let Some(message) = self.message() {
            if message["type"] == kind && holds(&message) {
                return message;
            }
            assert!(start.elapsed() < LONG, "{message}");
        }
        panic!("the connection was closed before such a {kind}");
    }
}

fn head(bytes: &[u8]) -> Value {
    let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
    let mut head: Value = serde_json::from_slice(&bytes[4..4 + length]).unwrap();
    // As many bytes as the head says.
    let size = |kind: &Value| [("u8", 1), ("u16", 2), ("f32", 4)].iter().find(|(name, _)| kind == name).unwrap().1;
    let arrays = head["arrays"].as_object().unwrap();
    let number = |of: &Value| of.as_u64().unwrap() as usize;
    let ends = arrays.values().map(|of| number(&of["at"]) + number(&of["length"]) * size(&of["type"]));
    assert_eq!(ends.max().unwrap().next_multiple_of(8), bytes.len() - 4 - length);
    if let Some(labels) = head["arrays"].get("labels") {
        let (at, length) = (4 + length + number(&labels["at"]), number(&labels["length"]));
        let labels = bytes[at..at + 2 * length].chunks_exact(2).map(|two| u16::from_le_bytes([two[0], two[1]]));
        head["labels"] = json!(labels.collect::<Vec<u16>>());
    }
    head
}

/// A plain request: status and body.
pub fn request(address: SocketAddr, method: &str, path: &str, headers: &str, body: &[u8]) -> (u16, String) {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(LONG)).unwrap();
    let host = if headers.contains("Host:") { String::new() } else { format!("Host: {address}\r\n") };
    let length = body.len();
    let head =
        format!("{method} {path} HTTP/1.1\r\n{host}{headers}Connection: close\r\nContent-Length: {length}\r\n\r\n");
    stream.write_all(head.as_bytes()).unwrap();
    let _ = stream.write_all(body); // whoever refuses it need not read it
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    let answer = String::from_utf8_lossy(&answer).into_owned();
    let status = answer.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap_or(0);
    (status, answer)
}
