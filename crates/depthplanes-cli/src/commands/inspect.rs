//! stub
use crate::args::Reading;
use crate::failure::Outcome;
use std::io::Write;
pub(super) fn run(_inputs: &[String], _reading: &Reading, _json: bool, _out: &mut dyn Write) -> Outcome {
    Ok(())
}
