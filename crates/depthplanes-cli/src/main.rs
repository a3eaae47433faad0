//! The program `depthplanes`.
fn main() {}
