//! Requests of JavaScript, and their answers as messages.

use crate::clock::Clock;
use crate::error::{InputError, Result};
use crate::finder::Finder;
use crate::map::{MapOf, known};
use crate::reading::{Words, reading, refuse_others};
use crate::shown::View;
use crate::tables::tables;
use depthplanes_io::outputs::{OUTPUTS, json_line};
use depthplanes_io::page::{Message, camera_message};
use depthplanes_io::{Frame, Pixels, ReadOptions};
use serde::Deserialize;
use serde_json::json;

/// A request's head.
#[derive(Deserialize)]
struct Request {
    ask: Ask,
    /// What the bytes behind the head are.
    map: Option<MapOf>,
    /// What was stated when the map was read, of a map that was.
    read_with: Option<Words>,
    /// What is stated else: of the map, if it was not read before, and of how planes are looked for.
    #[serde(default)]
    words: Words,
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Ask {
    /// What is there?
    Tables,
    /// Are the words accepted?
    Check,
    /// What does the file say?
    Read,
    /// Where are planes?
    Detect,
    /// Why is the pixel so?
    Explain([usize; 2]),
    /// What would the program write? The name of the output, and the extension.
    Encode(String, String),
    /// What does a page show of the map?
    Show,
    /// Where do its pixels look?
    Camera,
}

/// The session at which one request after the other is answered.
#[derive(Default)]
pub(crate) struct Session {
    request: Vec<u8>,
    response: Vec<u8>,
    last: Option<Last>,
    finder: Option<Finder>,
    view: View,
}

/// The last map.
struct Last {
    map: MapOf,
    options: ReadOptions,
    bytes: Vec<u8>,
    frame: Frame,
}

impl Session {
    /// Room for a request; `None` if there is no memory.
    pub(crate) fn room(&mut self, bytes: usize) -> Option<&mut [u8]> {
        self.request.clear();
        self.request.try_reserve_exact(bytes).ok()?;
        self.request.resize(bytes, 0);
        Some(&mut self.request)
    }

    /// The last answer.
    pub(crate) fn response(&self) -> &[u8] {
        &self.response
    }

    /// Answers the request that stands in the room; returns the length of the answer. A refusal is a head with `error`.
    pub(crate) fn respond(&mut self) -> usize {
        self.response = Vec::new(); // before another one is made
        let message = self.message().unwrap_or_else(|InputError(error)| Message::new(json!({"error": error})));
        self.response = message.into_bytes();
        self.response.len()
    }

    fn message(&mut self) -> Result<Message> {
        let (head, bytes) = parts(&self.request)?;
        let request: Request = serde_json::from_slice(head)?;
        if let Ask::Tables = request.ask {
            return Ok(Message::new(tables()));
        }
        let mut clock = Clock::new();
        let (options, left) = request.stated()?;
        let reads_alone = matches!(request.ask, Ask::Read | Ask::Camera);
        if reads_alone {
            refuse_others(&left)?;
        }
        let finder = match &mut self.finder {
            Some(finder) if reads_alone || finder.is_for(&left) => finder,
            finder => finder.insert(Finder::new(&left)?),
        };
        let Some(map) = request.map else { return Ok(Message::default()) };
        let name = map.name();
        let stage = map.stage();
        let frame = frame_of(&mut self.last, map, options, bytes)?;
        clock.ends(stage);
        match request.ask {
            Ask::Tables | Ask::Check => Ok(Message::default()),
            Ask::Read => Ok(read(frame)),
            Ask::Camera => Ok(camera_message(frame.width, frame.height, &frame.sensor).unwrap_or_default()),
            Ask::Detect => detected(finder, frame, &name, clock),
            Ask::Explain(at) => Ok(Message::new(finder.explain(frame, &name, at)?)),
            Ask::Encode(output, extension) => encoded(finder, frame, &name, &output, &extension),
            Ask::Show => self.view.message(finder, frame, &name, clock),
        }
    }
}

impl Request {
    /// How the map is read, and the words that are left for the finder.
    fn stated(&self) -> Result<(ReadOptions, Words)> {
        let mut left = self.words.clone();
        let own = reading(&mut left)?;
        let Some(words) = &self.read_with else { return Ok((own, left)) };
        if own != ReadOptions::default() {
            let text = "the frame was read already, and knows its sensor, camera and unit; accepted: a Detector without these \
                        for frames, or the array for this one";
            return Err(InputError(text.into()));
        }
        Ok((reading(&mut words.clone())?, left))
    }
}

/// Head and bytes of a request.
fn parts(request: &[u8]) -> Result<(&[u8], &[u8])> {
    let parts = request
        .split_first_chunk()
        .and_then(|(length, rest)| rest.split_at_checked(u32::from_le_bytes(*length) as usize));
    parts.ok_or_else(|| InputError("a request that ends before its head does".into()))
}

/// The frame of a map: the last one, if it is the same.
fn frame_of<'a>(last: &'a mut Option<Last>, map: MapOf, options: ReadOptions, bytes: &[u8]) -> Result<&'a Frame> {
    let is_same = |last: &Last| last.map == map && last.options == options && last.bytes == bytes;
    if !last.as_ref().is_some_and(is_same) {
        *last = None; // its memory may be needed
        let frame = map.frame(bytes, &options)?;
        *last = Some(Last { map, options, bytes: bytes.to_vec(), frame });
    }
    Ok(&last.as_ref().expect("it was just read").frame)
}

/// What was read.
fn read(frame: &Frame) -> Message {
    let mut message = Message::new(known(frame)).with(json!({
        "width": frame.width,
        "height": frame.height,
        "format": frame.format,
        "notes": frame.warnings,
    }));
    match &frame.pixels {
        Pixels::U8(pixels) => message.add_u8("depth", pixels),
        Pixels::U16(pixels) => message.add_u16("depth", pixels),
        Pixels::F32(pixels) => message.add_f32("depth", pixels),
    }
    message
}

/// The planes of a frame.
fn detected(finder: &mut Finder, frame: &Frame, name: &str, mut clock: Clock) -> Result<Message> {
    finder.find(frame, &mut |stage| clock.ends(stage))?;
    let mut message = Message::new(json!({"stages": clock.stages}));
    message.add_u16("labels", &finder.found.labels);
    if let Some(curved) = &finder.found.curved {
        message.add_u16("curved", &curved.labels);
    }
    message.add_u8("record", finder.report(frame, name, json_line).as_bytes());
    Ok(message)
}

/// The bytes of an output, as the program writes them.
fn encoded(finder: &mut Finder, frame: &Frame, name: &str, output: &str, extension: &str) -> Result<Message> {
    let found = OUTPUTS.iter().find(|row| row.name == output).ok_or_else(|| {
        let accepted = OUTPUTS.iter().map(|row| row.name).collect::<Vec<_>>().join(", ");
        depthplanes::Error::Unknown { what: "output", given: output.into(), accepted }
    })?;
    let writer = found.writer(format!("planes.{extension}").as_ref())?;
    finder.find(frame, &mut |_| ())?;
    let mut message = Message::default();
    message.add_u8("bytes", &finder.report(frame, name, writer.encode)?);
    Ok(message)
}
