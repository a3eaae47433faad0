//! One map from a file or from bytes: format, then encoding, then what the user knows better.
//!
//! What the user states goes before the preset, the preset before the guess.

use std::io::Read;
use std::path::Path;

use depthplanes::noise::{NoiseModel, SensorNoise};
use depthplanes::{Intrinsics, Sensor};

use crate::camera_file::CameraFile;
use crate::choice::{Choice, choose};
use crate::encoding::{self, Encoding, Given, Meaning, Stereo};
use crate::error::{Error, Result};
use crate::file_bytes::{self, read_known};
use crate::formats::{self, DecodeOptions, Image};
use crate::frame::{Frame, Pixels, Provenance, Source};
use crate::presets::{self, PresetNoise, SensorPreset};
use crate::ray_distance;
use crate::traps::missing::not_measured;
use crate::traps::traps;

/// What the user says of a map beside its bytes. The default says nothing.
///
/// ```
/// use depthplanes_io::ReadOptions;
/// let pgm = b"P2 3 1 65535 5000 0 10000";
/// let options = ReadOptions { encoding: Some("tum".into()), ..Default::default() };
/// let frame = depthplanes_io::decode(pgm, "doc.pgm", &options)?;
/// assert_eq!(frame.sensor.measure.depth_m(10_000.0), Some(2.0));
/// # Ok::<(), depthplanes_io::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Limits, member of an archive, size of headerless samples.
    pub decode: DecodeOptions,
    /// A row of [`presets::SENSOR_PRESETS`].
    pub preset: Option<String>,
    /// A row of [`crate::encoding::ENCODINGS`].
    pub encoding: Option<String>,
    /// The encoding's scale; what it counts is [`Encoding::scale`].
    pub scale: Option<f64>,
    /// Metres of a map unit, as cameras state it ("depth scale"); of maps of depth, instead of `scale`.
    pub depth_scale: Option<f64>,
    /// The values are distances along the rays, not depths along the optical axis; needs the camera.
    pub ray_distance: bool,
    /// The numbers are disparities; settles the guess when no encoding is stated.
    pub disparity: bool,
    /// Swap the two bytes of 16-bit samples.
    pub swap_bytes: bool,
    /// A value that means "missing" beside 0, map units.
    pub missing: Option<f64>,
    /// Smallest and largest valid value, map units.
    pub valid_range: Option<(f64, f64)>,
    /// The camera.
    pub intrinsics: Option<Intrinsics>,
    /// Columns and rows that the intrinsics are for, if known; maps of another size are refused.
    pub camera_size: Option<(usize, usize)>,
    /// The stereo rig, for disparities; ignored for depth.
    pub stereo: Option<Stereo>,
    /// How far off a pixel is by itself ([`Sensor::noise`]).
    pub noise: Option<SensorNoise>,
    /// The part of the error that neighbouring pixels share ([`Sensor::smooth_noise`]).
    pub smooth_noise: Option<SensorNoise>,
}

impl ReadOptions {
    /// The same with everything that a camera file states.
    pub fn camera(mut self, camera: &CameraFile) -> Self {
        self.intrinsics = Some(camera.intrinsics);
        self.camera_size = camera.size;
        self.stereo = camera.stereo.or(self.stereo);
        self
    }
}

/// Reads one map from a file.
///
/// # Errors
/// [`Error::Io`], and those of [`decode`].
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Frame> {
    let path = path.as_ref();
    let name = path.display().to_string();
    let bytes = read_known(path, options.decode.limits.max_bytes, |first| formats::begins(first, &options.decode))?;
    decode(&bytes, &name, options)
}

/// Reads one map from something that may have no end, such as standard input: after its first bytes it is read on only
/// if they are of a known format. `name` is for messages only.
///
/// # Errors
/// [`Error::Io`], and those of [`decode`].
pub fn read_stream(source: impl Read, name: &str, options: &ReadOptions) -> Result<Frame> {
    let most = options.decode.limits.max_bytes;
    let bytes = file_bytes::read_stream(source, name, most, |first| formats::begins(first, &options.decode))?;
    decode(&bytes, name, options)
}

/// Reads one map from bytes; `name` is for messages only.
///
/// # Errors
/// [`Error::In`] around [`Error::Unreadable`], [`Error::Limit`], [`Error::Parameter`] or
/// [`Error::Library`]; never a panic, whatever the bytes.
pub fn decode(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Frame> {
    decode_unnamed(bytes, options).map_err(|error| error.in_file(name))
}

fn decode_unnamed(bytes: &[u8], options: &ReadOptions) -> Result<Frame> {
    let preset = options.preset.as_deref().map(presets::by_name).transpose()?;
    let by_user = options.encoding.as_deref().map(encoding::by_name).transpose()?;
    let channels = by_user.is_some_and(|encoding| encoding.channels);
    let (mut image, format) = formats::decode(bytes, &DecodeOptions { channels, ..options.decode.clone() })?;
    if options.swap_bytes {
        swap_bytes(&mut image)?;
    }
    let disparity = options.disparity || options.stereo.is_some();
    let Choice { encoding, why, note } = choose(&image, format.name, by_user, disparity, preset)?;
    image.warnings.extend(note);
    if options.disparity && !encoding.disparity {
        let accepted = "an encoding of disparity (disparity, kitti, middlebury), or leave --disparity out";
        return Err(Error::parameter("--encoding", encoding.name, accepted));
    }
    let scale = scale(options, encoding)?;
    let meaning = (encoding.apply)(&mut image, &Given { scale, stereo: options.stereo })?;
    let intrinsics = camera(options, preset, &mut image)?;
    let of_preset = |part: fn(&SensorPreset) -> Option<PresetNoise>| part(preset?)?.of();
    let of_preset_or_file = preset.and_then(|preset| preset.missing).or(image.missing);
    let missing = missing(options, &image)?.or(of_preset_or_file).or(encoding.missing);
    let missing = missing.filter(|value| storable(&image.pixels, *value)).or_else(|| {
        let (value, note) = not_measured(&image.pixels, meaning.measure).filter(|_| options.valid_range.is_none())?;
        image.warnings.push(note);
        Some(value)
    });
    let mut frame = Frame {
        width: image.width,
        height: image.height,
        missing,
        pixels: image.pixels,
        valid_range: options.valid_range.or(meaning.valid_range),
        sensor: Sensor::default()
            .measure(meaning.measure)
            .intrinsics(intrinsics)
            .noise(noise(options.noise, of_preset(|preset| preset.noise), &meaning)?)
            .smooth_noise(noise(options.smooth_noise, of_preset(|preset| preset.smooth_noise), &meaning)?),
        format: format.name,
        encoding: encoding.name,
        provenance: Provenance {
            encoding: why,
            preset: preset.map(|preset| preset.name),
            scale,
            stereo: options.stereo.filter(|_| encoding.disparity),
            noise: source(options.noise, preset.and_then(|preset| preset.noise)),
            smooth_noise: source(options.smooth_noise, preset.and_then(|preset| preset.smooth_noise)),
            ray_distance: options.ray_distance,
        },
        warnings: image.warnings,
    };
    frame.view()?; // What the library would refuse later is refused here, with the file's name.
    if options.ray_distance {
        ray_distance::to_depth(&mut frame)?;
    }
    let traps = traps(&frame);
    frame.warnings.extend(traps);
    Ok(frame)
}

/// The encoding's scale, as it was stated or by the device's depth scale.
fn scale(options: &ReadOptions, encoding: &Encoding) -> Result<Option<f64>> {
    let Some(depth_scale) = options.depth_scale else { return Ok(options.scale) };
    if options.scale.is_some() {
        let accepted = "either of the two: --scale counts map units per metre, --depth-scale metres per map unit";
        return Err(Error::parameter("--depth-scale", depth_scale, format!("not together with --scale; {accepted}")));
    }
    if encoding.disparity || encoding.scale.is_empty() {
        let accepted = format!("a map of depth; the encoding `{}` has another unit", encoding.name);
        return Err(Error::parameter("--depth-scale", depth_scale, accepted));
    }
    Ok(Some(1.0 / depth_scale))
}

/// Who stated a part of the noise.
fn source(stated: Option<SensorNoise>, of_preset: Option<PresetNoise>) -> Option<Source> {
    stated.map(|_| Source::Stated).or(of_preset.map(|_| Source::Preset))
}

/// Whether a pixel can be `value` at all.
fn storable(pixels: &Pixels, value: f64) -> bool {
    let most = match pixels {
        Pixels::U8(_) => f64::from(u8::MAX),
        Pixels::U16(_) => f64::from(u16::MAX),
        Pixels::F32(_) => return value.is_finite(),
    };
    value.fract() == 0.0 && (0.0..=most).contains(&value)
}

/// The user's value for "missing", which must be one that a pixel can have.
fn missing(options: &ReadOptions, image: &Image) -> Result<Option<f64>> {
    match options.missing {
        Some(value) if !storable(&image.pixels, value) => {
            let accepted =
                format!("a value that a {} pixel can have; 0, NaN and infinities are missing anyway", image.sample);
            Err(Error::parameter("--missing", value, accepted))
        }
        value => Ok(value),
    }
}

fn swap_bytes(image: &mut Image) -> Result<()> {
    match &mut image.pixels {
        Pixels::U16(values) => values.iter_mut().for_each(|value| *value = value.swap_bytes()),
        _ => return Err(Error::parameter("--swap-bytes", image.sample, "maps of 16-bit integers")),
    }
    Ok(())
}

/// A part of the user's noise, which must suit the map, or the preset's.
fn noise(given: Option<SensorNoise>, of_preset: Option<SensorNoise>, meaning: &Meaning) -> Result<Option<SensorNoise>> {
    let Some(noise) = given else { return Ok(of_preset) };
    if NoiseModel::new(meaning.measure, noise, 0.0).is_none() {
        let accepted = "maps in depth, or in disparity of a known rig (--focal, --baseline)";
        return Err(Error::parameter("--noise-table", "for depth and the map is not", accepted));
    }
    Ok(Some(noise))
}

/// The camera for this map: the user's, or the preset's if the size is right.
fn camera(options: &ReadOptions, preset: Option<&SensorPreset>, image: &mut Image) -> Result<Option<Intrinsics>> {
    let size = (image.width, image.height);
    if let Some(given) = options.intrinsics {
        if let Some((width, height)) = options.camera_size.filter(|stated| *stated != size) {
            let accepted = format!("the camera of this map, which has {} x {} pixels", size.0, size.1);
            return Err(Error::parameter("camera", format_args!("for {width} x {height} pixels"), accepted));
        }
        let Intrinsics { fx, fy, cx, cy } = given;
        return Ok(Some(Intrinsics::new(fx, fy, cx, cy)?));
    }
    match preset.and_then(|preset| preset.camera) {
        Some((width, height, intrinsics)) if (width, height) == size => Ok(Some(intrinsics)),
        Some((width, height, _)) => {
            let (w, h) = size;
            image.warnings.push(format!("the preset's camera is for {width} x {height}, not {w} x {h}: not used"));
            Ok(None)
        }
        None => Ok(None),
    }
}
