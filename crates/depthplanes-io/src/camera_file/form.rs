//! What a form of camera files is, and the text that the forms look at.

use std::cell::OnceCell;

use serde_json::Value;

use super::camera::CameraFile;
use super::once::OnceKeys;
use super::{assign, xml, yaml};
use crate::error::Result;

/// One form of camera files.
#[derive(Debug)]
#[non_exhaustive]
pub struct CameraForm {
    /// Its name.
    pub name: &'static str,
    /// Which programs write it, and which camera of several is taken.
    pub about: &'static str,
    /// The line that shows what it looks like.
    pub sample: &'static str,
    pub(super) recognise: fn(&Document<'_>) -> bool,
    pub(super) parse: fn(&Document<'_>) -> Result<CameraFile>,
}

/// The text of a file, and its tree if it is JSON, YAML, XML or lines of `key = value`.
pub(super) struct Document<'a> {
    pub(super) text: &'a str,
    tree: OnceCell<std::result::Result<Value, String>>,
}

impl<'a> Document<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Document { text: text.trim_start_matches('\u{feff}').trim(), tree: OnceCell::new() }
    }

    pub(super) fn is_json(&self) -> bool {
        self.text.starts_with('{')
            || self.text.starts_with("[{")
            || self.text.starts_with("[[")
            || self.text.starts_with("[\n")
    }

    pub(super) fn read(&self) -> &std::result::Result<Value, String> {
        self.tree.get_or_init(|| match serde_json::from_str(self.text) {
            Ok(OnceKeys(tree)) => tree,
            // Python prints maps that are no JSON.
            Err(error) if self.is_json() => yaml::parse(self.text).map_err(|_| error.to_string()),
            Err(_) if self.text.starts_with('<') => xml::parse(self.text),
            Err(_) => {
                let lines = assign::parse(self.text).or_else(|| assign::table(self.text).map(Ok));
                // `width: 640, height: 480, fx: 525` on one line.
                let is_line = self.text.lines().count() == 1 && self.text.matches(": ").count() > 1;
                let line = || is_line.then(|| yaml::parse(&format!("{{{}}}", self.text)).ok()).flatten();
                lines.or_else(|| line().map(Ok)).unwrap_or_else(|| yaml::parse(self.text))
            }
        })
    }

    pub(super) fn tree(&self) -> Option<&Value> {
        self.read().as_ref().ok()
    }
}

pub(super) const fn form(
    name: &'static str,
    about: &'static str,
    sample: &'static str,
    recognise: fn(&Document<'_>) -> bool,
    parse: fn(&Document<'_>) -> Result<CameraFile>,
) -> CameraForm {
    CameraForm { name, about, sample, recognise, parse }
}
