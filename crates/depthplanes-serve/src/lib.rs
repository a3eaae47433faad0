//! The live page: depth video, planes, floor and obstacles in a browser, and sliders that act at once.
//!
//! In: a source of frames and a method. Out: a page on a socket of this machine.
//!
//! `source -> reader -> player (pipeline) -> newest frame -> clients`: the reader waits for the source, the player finds
//! planes and never waits for anybody, and each client is sent the newest frame when it has drawn those before. What the
//! messages hold stands in docs/live.md.
//!
//! ```
//! use depthplanes_serve::{Config, Server};
//! let source = depthplanes_video::open("scene:robot:size=160x120", &Default::default())?;
//! let listener = std::net::TcpListener::bind("127.0.0.1:0")?;
//! let server = Server::start(listener, source, Config::default())?;
//! println!("http://{}/", server.address());
//! server.stop();
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod client;
mod config;
mod connections;
mod error;
mod event;
mod explainer;
mod guard;
mod head;
mod hub;
mod page;
mod pipeline;
mod player;
mod rays;
mod reader;
mod recent;
mod server;
mod state;
mod upload;

pub use config::{Config, Limits};
pub use error::{Error, Result};
pub use server::Server;

/// The program of the page on the live page is a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/live.md")]
struct Page;
