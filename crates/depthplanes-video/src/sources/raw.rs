//! Raw frames on standard input, one after the other without a header, as `ffmpeg -f rawvideo -pix_fmt gray16le -` writes them.

use crate::error::{Error, Result};
use crate::frame::VideoFrame;
use crate::source::{Source, SourceInfo, SourceOptions};
use depthplanes_io::formats::raw_bytes;
use depthplanes_io::{ReadOptions, decode};
use std::io::Read;

pub(super) const RAW: SourceInfo = SourceInfo {
    name: "raw",
    about: "- for raw frames on standard input; needs their size and type (--raw-size, --raw-type)",
    is: |word| word == "-",
    open: |_, options| Ok(Box::new(Raw::new(std::io::stdin(), options)?)),
};

/// Raw frames from anything that can be read.
pub(super) struct Raw<R> {
    input: R,
    bytes: Vec<u8>,
    next: u64,
    options: ReadOptions,
    is_over: bool,
}

impl<R> std::fmt::Debug for Raw<R> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Raw").field("frame_bytes", &self.bytes.len()).field("next", &self.next).finish_non_exhaustive()
    }
}

impl<R: Read> Raw<R> {
    pub(super) fn new(input: R, options: &SourceOptions) -> Result<Self> {
        let mut options = options.read.clone();
        let bytes = raw_bytes(&options.decode)?;
        options.decode.raw_type.get_or_insert_with(|| "uint16".into());
        Ok(Raw { input, bytes: vec![0; bytes], next: 0, options, is_over: false })
    }

    /// Fills the bytes of a frame; how many there were.
    fn fill(&mut self) -> std::io::Result<usize> {
        let mut filled = 0;
        while filled < self.bytes.len() {
            match self.input.read(&mut self.bytes[filled..]) {
                Ok(0) => break,
                Ok(count) => filled += count,
                Err(error) if error.kind() == std::io::ErrorKind::Interrupted => (),
                Err(error) => return Err(error),
            }
        }
        Ok(filled)
    }

    fn read(&mut self) -> Option<Result<VideoFrame>> {
        let index = self.next;
        self.next += 1;
        let name = format!("-#{index}");
        match self.fill() {
            Err(source) => {
                self.is_over = true;
                Some(Err(Error::Io { path: "-".into(), source }))
            }
            Ok(0) => {
                self.is_over = true;
                None
            }
            Ok(filled) if filled < self.bytes.len() => {
                self.is_over = true;
                let wrong = format!("the stream ends in the middle of a frame: {filled} of {} bytes", self.bytes.len());
                Some(Err(Error::source(name, wrong, "whole frames; is the size or the type another one?")))
            }
            Ok(_) => {
                let frame = decode(&self.bytes, &name, &self.options).map_err(Error::from);
                Some(frame.map(|frame| VideoFrame { index, name, time_s: None, pose: None, up: None, frame }))
            }
        }
    }
}

impl<R: Read + Send> Source for Raw<R> {
    fn next_frame(&mut self) -> Option<Result<VideoFrame>> {
        if self.is_over { None } else { self.read() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use depthplanes_io::formats::DecodeOptions;

    #[test]
    fn frames_follow_each_other_and_half_a_frame_at_the_end_is_said() {
        let frame = |value: u16| std::iter::repeat_n(value.to_le_bytes(), 16 * 12).flatten();
        let bytes: Vec<u8> = frame(1000).chain(frame(2000)).chain(frame(3000).take(100)).collect();
        let decode = DecodeOptions { raw_size: Some((16, 12)), ..DecodeOptions::default() };
        let options = SourceOptions::default().read(ReadOptions { decode, ..ReadOptions::default() });
        let mut source = Raw::new(bytes.as_slice(), &options).unwrap();
        let first = |frame: VideoFrame| match frame.frame.pixels {
            depthplanes_io::Pixels::U16(pixels) => pixels[0],
            other => panic!("{other:?}"),
        };
        assert_eq!(first(source.next_frame().unwrap().unwrap()), 1000);
        assert_eq!(first(source.next_frame().unwrap().unwrap()), 2000);
        let error = source.next_frame().unwrap().unwrap_err().to_string();
        assert!(error.contains("100 of 384 bytes"), "{error}");
        assert!(source.next_frame().is_none());
    }
}
