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
use crate::map_camera::{MapCamera, Stated, map_camera};
use crate::presets::{self, PresetNoise, SensorPreset};
use crate::ray_distance;
use crate::traps::missing::not_measured;
use crate::traps::packing::not_packed;
use crate::traps::traps;

/// What the user says of a map beside its bytes. The default says nothing.
///
/// ```
/// use depthplanes_io::ReadOptions;
/// let pgm = b"P2 3 1 65535 5000 0 10000";
/// let options = ReadOptions { encoding: Some("tum".into()), ..Default::default() };
/// let frame = depthplanes_io::decode(pgm, "doc.pgm", &options)?;
/// assert_eq!(frame.sensor.value_kind.depth_m(10_000.0), Some(2.0));
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
    /// What a camera file states; not used if there are `intrinsics`.
    pub camera_file: Option<CameraFile>,
    /// Columns and rows that the intrinsics or the camera file are for: they are scaled to the map. Without it they are
    /// for the map's size, or for the one that the file states, and maps of another size are refused.
    pub camera_size: Option<(usize, usize)>,
    /// Whether the map is of the rectified picture, so that lens distortion is ignored; by default as the camera file suggests.
    pub rectified: Option<bool>,
    /// The stereo rig, for disparities; ignored for depth. It makes a map without a stated encoding one of disparities.
    pub stereo: Option<Stereo>,
    /// How far off a pixel is by itself ([`Sensor::noise`]).
    pub noise: Option<SensorNoise>,
    /// The part of the error that neighbouring pixels share ([`Sensor::smooth_noise`]).
    pub smooth_noise: Option<SensorNoise>,
}

impl ReadOptions {
    /// That there are a preset and an encoding of the names stated, before there is a map.
    ///
    /// # Errors
    /// [`Error::Parameter`] with the names there are.
    pub fn check(&self) -> Result<()> {
        self.preset.as_deref().map(presets::by_name).transpose()?;
        self.encoding.as_deref().map(encoding::by_name).transpose()?;
        Ok(())
    }

    /// The same with a stereo rig of which some numbers are stated: focal length and difference of the principal points in
    /// pixels, baseline in metres. The others are the camera file's; without them the focal length is the camera's own and the
    /// difference 0. If none is stated nothing changes.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a rig without a baseline or a focal length.
    pub fn rig(mut self, focal_px: Option<f64>, baseline_m: Option<f64>, doffs_px: Option<f64>) -> Result<Self> {
        if [focal_px, baseline_m, doffs_px].iter().all(Option::is_none) {
            return Ok(self);
        }
        let lacking = |option| Error::parameter(option, "not given", "a stereo rig needs it as well");
        let file = self.camera_file.as_ref();
        let known = file.and_then(|camera| camera.stereo);
        let baseline_m = baseline_m.or(known.map(|rig| rig.baseline_m)).ok_or_else(|| lacking("--baseline"))?;
        let camera = self.intrinsics.or(file.map(|camera| camera.intrinsics));
        let focal_px = focal_px.or(known.map(|rig| rig.focal_px)).or(camera.map(|camera| camera.fx.abs()));
        let focal_px = focal_px.ok_or_else(|| lacking("--focal (or --intrinsics)"))?;
        let doffs_px = doffs_px.or(known.map(|rig| rig.doffs_px)).unwrap_or(0.0);
        self.stereo = Some(Stereo { focal_px, baseline_m, doffs_px });
        Ok(self)
    }

    /// The same with everything that a camera file states.
    pub fn camera(mut self, camera: &CameraFile) -> Self {
        (self.intrinsics, self.camera_file) = (None, Some(camera.clone()));
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
    let bytes = read_known(path, options.decode.limits.max_bytes, &|first| formats::ends(first, &options.decode))?;
    decode(&bytes, &name, options)
}

/// Reads one map from something that may have no end, such as standard input: after its first bytes it is read on only
/// if they are of a known format, and no further than a map can reach whose header states its size. `name` is for messages
/// only.
///
/// # Errors
/// [`Error::Io`], [`Error::Endless`], and those of [`decode`].
pub fn read_stream(source: impl Read, name: &str, options: &ReadOptions) -> Result<Frame> {
    let most = options.decode.limits.max_bytes;
    let bytes = file_bytes::read_stream(source, name, most, &|first| formats::ends(first, &options.decode))?;
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
    let by_user = options.encoding.as_deref().map(encoding::by_name).transpose()?;
    let channels = by_user.is_some_and(|encoding| encoding.channels);
    let (image, format) = formats::decode(bytes, &DecodeOptions { channels, ..options.decode.clone() })?;
    frame_of(image, format.name, options)
}

/// The frame of an image: what its numbers mean, which camera saw it, what is missing, what is odd.
pub(crate) fn frame_of(mut image: Image, format: &'static str, options: &ReadOptions) -> Result<Frame> {
    let preset = options.preset.as_deref().map(presets::by_name).transpose()?;
    let by_user = options.encoding.as_deref().map(encoding::by_name).transpose()?;
    if options.swap_bytes {
        swap_bytes(&mut image)?;
    }
    let of_disparity = options.camera_file.as_ref().is_some_and(|camera| camera.disparity);
    let disparity = options.disparity || options.stereo.is_some() || of_disparity;
    let Choice { encoding, why, note } = choose(&image, format, by_user, disparity, options.scale.is_some(), preset)?;
    image.warnings.extend(note);
    if options.disparity && !encoding.disparity {
        let accepted = "an encoding of disparity (disparity, kitti, middlebury), or leave --disparity out";
        return Err(Error::parameter("--encoding", encoding.name, accepted));
    }
    let camera = camera(options, preset, &mut image)?;
    let is_stated = why == "stated" || why == "preset";
    let scale =
        scale(options, encoding)?.or_else(|| scale_of_camera_file(&camera, encoding.name, is_stated, &mut image));
    image.warnings.extend(doubt_of_rig(options.stereo, &camera, encoding));
    image.warnings.extend(not_packed(&image.pixels, encoding.name));
    let stereo = options.stereo.or(camera.stereo);
    let meaning = (encoding.apply)(&mut image, &Given { scale, stereo })?;
    let of_preset = |part: fn(&SensorPreset) -> Option<PresetNoise>| part(preset?)?.of();
    let missing = missing(options, preset, encoding, &meaning, &mut image)?;
    let mut frame = Frame {
        width: image.width,
        height: image.height,
        missing,
        pixels: image.pixels,
        valid_range: options.valid_range.or(meaning.valid_range),
        sensor: Sensor::default()
            .value_kind(meaning.value_kind)
            .intrinsics(camera.intrinsics)
            .distortion(camera.distortion)
            .noise(noise(options.noise, of_preset(|preset| preset.noise), &meaning)?)
            .smooth_noise(noise(options.smooth_noise, of_preset(|preset| preset.smooth_noise), &meaning)?),
        format,
        encoding: encoding.name,
        provenance: Provenance {
            encoding: why,
            preset: preset.map(|preset| preset.name),
            scale,
            stereo: stereo.filter(|_| encoding.disparity),
            disparity,
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
    let units_per_metre = 1.0 / depth_scale;
    if !(units_per_metre > 0.0 && units_per_metre.is_finite() && depth_scale.is_finite()) {
        return Err(Error::parameter("--depth-scale", depth_scale, "metres of a map unit: a finite number above 0"));
    }
    Ok(Some(units_per_metre))
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

/// The value for "missing": the one that is known, or else one that no sensor measures. The user's must be one that a pixel
/// can have.
fn missing(
    options: &ReadOptions,
    preset: Option<&SensorPreset>,
    encoding: &Encoding,
    meaning: &Meaning,
    image: &mut Image,
) -> Result<Option<f64>> {
    if let Some(value) = options.missing.filter(|value| !storable(&image.pixels, *value)) {
        let accepted =
            format!("a value that a {} pixel can have; 0, NaN and infinities are missing anyway", image.sample);
        return Err(Error::parameter("--missing", value, accepted));
    }
    let known = known_missing(options, preset, encoding, image.missing, &image.pixels);
    if known.is_some() || options.valid_range.is_some() {
        return Ok(known);
    }
    let view = image.pixels.view(image.width, image.height);
    let odd = view.ok().and_then(|view| not_measured(view, meaning.value_kind));
    Ok(odd.map(|(value, note)| {
        image.warnings.push(note);
        value
    }))
}

/// The value for "missing" that is known without a look at the map: the user's, or else the preset's, the file's or the
/// encoding's.
pub(crate) fn known_missing(
    options: &ReadOptions,
    preset: Option<&SensorPreset>,
    encoding: &Encoding,
    of_file: Option<f64>,
    pixels: &Pixels,
) -> Option<f64> {
    let of_preset = preset.and_then(|preset| preset.missing);
    options.missing.or(of_preset).or(of_file).or(encoding.missing).filter(|value| storable(pixels, *value))
}

/// What a person should know of a stereo rig that was stated.
fn doubt_of_rig(rig: Option<Stereo>, camera: &MapCamera, encoding: &Encoding) -> Option<String> {
    let (rig, name) = (rig?, encoding.name);
    if !encoding.disparity {
        return Some(format!("the stereo rig is not used: the encoding `{name}` is no disparity"));
    }
    let (focal, fx) = (rig.focal_px, camera.intrinsics?.fx);
    ((focal / fx.abs() - 1.0).abs() > 0.02)
        .then(|| format!("the rig's focal length is {focal} pixels and the camera's {fx}: one of them is wrong"))
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
    if NoiseModel::new(meaning.value_kind, noise, 0.0).is_none() {
        let accepted = "maps in depth, or in disparity of a known rig (--focal, --baseline)";
        return Err(Error::parameter("--noise-table", "for depth and the map is not", accepted));
    }
    Ok(Some(noise))
}

/// The camera for this map; what is to be said of it goes to the image's warnings.
fn camera(options: &ReadOptions, preset: Option<&SensorPreset>, image: &mut Image) -> Result<MapCamera> {
    let stated = Stated {
        intrinsics: options.intrinsics,
        file: options.camera_file.as_ref(),
        size: options.camera_size,
        rectified: options.rectified,
        preset,
    };
    let of_points = image.intrinsics.filter(|_| stated.intrinsics.is_none() && stated.file.is_none());
    if let Some(camera @ Intrinsics { fx, fy, cx, cy }) = of_points {
        image.warnings.push(format!(
            "the camera is the one that the points of the cloud came from: fx {fx:.2}, fy {fy:.2}, cx {cx:.2}, cy {cy:.2}"
        ));
        return Ok(MapCamera { intrinsics: Some(camera), ..MapCamera::default() });
    }
    let mut camera = map_camera(&stated, (image.width, image.height))?;
    image.warnings.append(&mut camera.notes);
    Ok(camera)
}

/// Map units in a metre, as the camera file states them, where the encoding is a guess.
fn scale_of_camera_file(camera: &MapCamera, encoding: &str, is_stated: bool, image: &mut Image) -> Option<f64> {
    let units = camera.unit_m.map(f64::recip).filter(|units| units.is_finite() && (units - 1000.0).abs() > 1e-6)?;
    if is_stated || encoding != "millimetre" || !matches!(image.pixels, Pixels::U16(_)) {
        return None;
    }
    image
        .warnings
        .push(format!("{units} map units are a metre, as the camera file states; --scale 1000 for millimetres"));
    Some(units)
}
