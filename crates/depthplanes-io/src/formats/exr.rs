//! OpenEXR, the depth channel of the first flat layer (feature `exr`).
//!
//! In: half, float or 32-bit integer channels. Out: `f32` values of the channel Z, Y or depth, or
//! of the only one. Renderers write metres or scene units; the file does not say.

use std::io::Cursor;

use exr::meta::MetaData;
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};

use super::format::{DecodeOptions, Format, Image};
use crate::error::{Error, Result};
use crate::frame::Pixels;

pub(super) const FORMAT: Format = Format {
    name: "exr",
    about: "OpenEXR, channel Z, Y, depth or the only one",
    extensions: &["exr"],
    sniff: |bytes| bytes.starts_with(b"\x76\x2f\x31\x01"),
    ends: |_, _| None,
    decode,
};

/// Above what any of its packings reaches.
const BEST_RATIO: usize = 4096;

fn unreadable(wrong: impl ToString) -> Error {
    let accepted = "a flat layer with a channel Z, Y or depth, or with one channel only";
    Error::Unreadable { format: "exr", wrong: wrong.to_string(), accepted }
}

fn decode(bytes: &[u8], options: &DecodeOptions) -> Result<Image> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(unreadable)?;
    for header in &meta.headers {
        let size = header.layer_size;
        let sample_bytes = 4 * header.channels.list.len();
        let area = options.limits.area("exr", size.width() as u64, size.height() as u64, sample_bytes)?;
        if area.saturating_mul(sample_bytes) > bytes.len().saturating_mul(BEST_RATIO) {
            return Err(unreadable(format!("{size:?} pixels cannot come out of {} bytes", bytes.len())));
        }
    }
    let picture = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(unreadable)?;
    let layer = picture.layer_data;
    let channels = &layer.channel_data.list;
    // Renderers put the layer's name in front: `ViewLayer.Depth.Z`.
    let named = |name: &str| {
        let is_named = |full: &str| full.rsplit('.').next().unwrap_or(full).eq_ignore_ascii_case(name);
        channels.iter().find(|channel| is_named(&channel.name.to_string()))
    };
    let only = || if channels.len() == 1 { channels.first() } else { None };
    let depth = named("z").or_else(|| named("depth")).or_else(|| named("y")).or_else(|| named("v")).or_else(only);
    let grey = || {
        let [r, g, b] = [named("r")?, named("g")?, named("b")?];
        (r.sample_data == g.sample_data && r.sample_data == b.sample_data).then_some(r)
    };
    let channel = depth.or_else(grey).ok_or_else(|| {
        let names: Vec<_> = channels.iter().map(|channel| channel.name.to_string()).collect();
        let differing = if named("r").is_some() { ", which differ: a colour picture, not depth" } else { "" };
        unreadable(format!("its channels are {}{differing}", names.join(", ").escape_debug()))
    })?;
    let (values, sample): (Vec<f32>, _) = match &channel.sample_data {
        FlatSamples::F16(values) => (values.iter().map(|value| value.to_f32()).collect(), "float16"),
        FlatSamples::F32(values) => (values.clone(), "float32"),
        FlatSamples::U32(values) => (values.iter().map(|&value| value as f32).collect(), "uint32"),
    };
    let (width, height) = (layer.size.width(), layer.size.height());
    if values.len() != width * height {
        return Err(unreadable("the channel is subsampled"));
    }
    let mut warnings = Vec::new();
    if channels.len() > 1 {
        let (name, count) = (channel.name.to_string(), channels.len());
        warnings.push(format!("the channel `{}` of {count} is taken", name.escape_debug()));
    }
    if meta.headers.len() > 1 {
        warnings.push(format!("the file has {} layers: the first is taken", meta.headers.len()));
    }
    Ok(Image::new(width, height, Pixels::F32(values), sample, warnings))
}
