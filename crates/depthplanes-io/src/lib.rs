//! Bytes to frames and detections to bytes: the only crate with codecs.
//!
//! `bytes -> formats -> Image -> encoding -> Frame`: a format says what the numbers are, an
//! encoding what they mean.
#![forbid(unsafe_code)]

pub mod camera_file;
mod choice;
mod doubts;
pub mod encoding;
pub mod error;
mod file_bytes;
pub mod formats;
mod frame;
mod in_memory;
pub mod inspect;
pub mod labels;
mod map_camera;
pub mod measures;
pub mod memory;
pub mod noise_table;
pub mod outputs;
mod packed;
pub mod page;
pub mod presets;
mod ray_distance;
pub mod read;
mod resized;
mod stereo;
mod traps;

pub use doubts::doubts;
pub use error::{Error, Result};
pub use frame::{Frame, Pixels, Provenance, Source};
pub use in_memory::{Settled, SettledMaps, frame_of_samples};
pub use labels::{LabelImage, read_labels};
pub use noise_table::read_noise_table;
pub use read::{ReadOptions, decode, read, read_stream};

/// The programs of the README and of the page on the library are documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
#[doc = include_str!("../../../docs/library.md")]
struct Pages;
