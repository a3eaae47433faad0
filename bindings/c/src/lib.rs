//! The C interface of `depthplanes`. `include/depthplanes.h` is made from these sources by cbindgen, and types and functions
//! have the names that they have there.
//!
//! Pixels go in and labels come out without a copy. Everything that can fail is asked of a detector, which keeps the text of
//! its last error; a panic becomes an error as well.
#![allow(non_camel_case_types, reason = "they are the names of C")]

mod border;
mod detection;
mod detector;
mod error;
mod ground;
mod map;
mod outlines;
mod plane;
mod reader;
mod settings;
mod stated;
mod tables;
mod tracker;
