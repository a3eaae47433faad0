//! The camera of a map: the one that is stated, held against the map's size.
//!
//! A camera that cannot be the map's is refused with what to type instead; one that is unlikely is noted.

use depthplanes::{Distortion, DistortionModel, Intrinsics};

use crate::camera_file::CameraFile;
use crate::encoding::Stereo;
use crate::error::{Error, Result};
use crate::presets::SensorPreset;
use crate::resized::{OF_CROP, OF_OTHER_CROP, Size, flag, of_other_shape, scaled, turned, whole_picture};

/// Furthest that a principal point lies from the middle without a note, as a share of the side: our choice. It is 0.11 in
/// Middlebury's rigs.
const FAR: f64 = 0.2;

/// Fields of view without a note, degrees: our choice. Long lenses and fisheyes are beyond them.
const FIELD_DEG: [f64; 2] = [5.0, 150.0];

/// Sizes of pictures whose nominal cameras have the principal point in the middle.
const COMMON: [Size; 12] = [
    (320, 240),
    (424, 240),
    (512, 424),
    (640, 360),
    (640, 400),
    (640, 480),
    (640, 576),
    (848, 480),
    (1280, 720),
    (1280, 960),
    (1920, 1080),
    (1920, 1440),
];

/// What is stated of a map's camera.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stated<'a> {
    /// Intrinsics by themselves.
    pub(crate) intrinsics: Option<Intrinsics>,
    /// A camera file, where there are none.
    pub(crate) file: Option<&'a CameraFile>,
    /// The size that either is for.
    pub(crate) size: Option<Size>,
    /// Whether the map is of the rectified picture, where the file has cameras for both.
    pub(crate) rectified: Option<bool>,
    /// The sensor, whose camera is taken where nothing else is stated.
    pub(crate) preset: Option<&'a SensorPreset>,
}

/// The camera of a map.
#[derive(Clone, Debug, Default)]
pub(crate) struct MapCamera {
    pub(crate) intrinsics: Option<Intrinsics>,
    pub(crate) distortion: Option<Distortion>,
    pub(crate) stereo: Option<Stereo>,
    /// Metres per map unit, if the file states it.
    pub(crate) unit_m: Option<f64>,
    pub(crate) notes: Vec<String>,
}

/// The camera for a map of a size.
///
/// # Errors
/// [`Error::Parameter`] for a camera of another size, one whose principal point lies outside of the map, and focal lengths
/// in the place of the principal point; [`Error::Library`] for one that cannot be.
pub(crate) fn map_camera(stated: &Stated<'_>, map: Size) -> Result<MapCamera> {
    if let Some(given) = stated.intrinsics {
        let Intrinsics { fx, fy, cx, cy } = given;
        let intrinsics = Intrinsics::new(fx, fy, cx, cy)?;
        let (intrinsics, _) = scaled_to(&intrinsics, stated.size, map)?;
        let notes = checked(&intrinsics, map, stated.size.is_some(), None)?;
        return Ok(MapCamera { intrinsics: Some(intrinsics), notes, ..MapCamera::default() });
    }
    match (stated.file, stated.preset.and_then(|preset| preset.camera)) {
        (Some(file), _) => of_file(stated, file, map),
        (None, Some((width, height, intrinsics))) if (width, height) == map => {
            Ok(MapCamera { intrinsics: Some(intrinsics), ..MapCamera::default() })
        }
        (None, Some((width, height, _))) => {
            let (w, h) = map;
            let note = format!("the preset's camera is for {width} x {height}, not {w} x {h}: not used");
            Ok(MapCamera { notes: vec![note], ..MapCamera::default() })
        }
        (None, None) => Ok(MapCamera::default()),
    }
}

fn of_file(stated: &Stated<'_>, file: &CameraFile, map: Size) -> Result<MapCamera> {
    let camera = file.for_size(stated.size.unwrap_or(map));
    let (own, distortion) = camera.seen(stated.rectified);
    let size = stated.size.or(camera.size);
    if let (None, Some(size), 2..) = (stated.size, camera.size, file.choices.len())
        && size != map
        && file.choices.iter().any(|choice| choice.size != camera.size)
    {
        return Err(no_choice(file, map));
    }
    if let (None, Some(size)) = (stated.size, camera.size)
        && size != map
    {
        return Err(other_size(&own, size, map));
    }
    let (intrinsics, scale) = scaled_to(&own, size, map)?;
    let mut notes = camera.notes.clone();
    notes.extend(checked(&intrinsics, map, size.is_some(), distortion.as_ref())?);
    notes.extend(lens_note(stated, camera, distortion.as_ref()));
    let stereo =
        camera.stereo.map(|rig| Stereo { focal_px: rig.focal_px * scale, doffs_px: rig.doffs_px * scale, ..rig });
    Ok(MapCamera { intrinsics: Some(intrinsics), distortion, stereo, unit_m: camera.unit_m, notes })
}

/// What is done about the lens, unless a flag has said it.
fn lens_note(stated: &Stated<'_>, camera: &CameraFile, distortion: Option<&Distortion>) -> Option<String> {
    let (_, other) = camera.otherwise.as_ref()?;
    if stated.rectified.is_some() {
        return None;
    }
    let model = |distortion: &Distortion| distortion.model().name();
    match (distortion, other) {
        (Some(distortion), _) => Some(format!(
            "the lens distortion of the camera file ({}) is undone; --rectified if the map is of the undistorted picture",
            model(distortion)
        )),
        (None, Some(distortion)) if !camera.notes.iter().any(|note| note.contains("--rectified")) => Some(format!(
            "the map is taken to be rectified, and the lens distortion of the camera file ({}) is not used; --rectified=no undoes it",
            model(distortion)
        )),
        _ => None,
    }
}

/// The camera of one size for maps of another, and the factor.
fn scaled_to(camera: &Intrinsics, size: Option<Size>, map: Size) -> Result<(Intrinsics, f64)> {
    match size {
        Some(size) if size != map => {
            let camera = scaled(camera, size, map).ok_or_else(|| other_size(camera, size, map))?;
            Ok((camera, map.0 as f64 / size.0 as f64))
        }
        _ => Ok((*camera, 1.0)),
    }
}

fn other_size(camera: &Intrinsics, (width, height): Size, map: Size) -> Error {
    let (w, h) = map;
    let accepted = match scaled(camera, (width, height), map) {
        Some(scaled) => format!(
            "the camera of this map, which has {w} x {h} pixels; scaled it is {}, and --camera-size {width}x{height} scales it; {}",
            flag(&scaled),
            OF_CROP
        ),
        None => match turned(camera, (width, height), map) {
            Some([clockwise, other]) => format!(
                "the camera of this map, which has {w} x {h} pixels: the picture was turned by 90 degrees; turn the map back, or give \
                 {} if it was turned clockwise, {} if counter-clockwise",
                flag(&clockwise),
                flag(&other)
            ),
            None => format!(
                "the camera of this map, which has {w} x {h} pixels and another shape: {}",
                of_other_shape(camera, (width, height), map)
            ),
        },
    };
    Error::parameter("camera", format_args!("for {width} x {height} pixels"), accepted)
}

/// No camera of the file is for the map's size.
fn no_choice(file: &CameraFile, (w, h): Size) -> Error {
    let shown = |camera: &CameraFile| match camera.size {
        Some((width, height)) => format!("{} {width}x{height}", camera.name),
        None => camera.name.clone(),
    };
    let names: Vec<String> = file.choices.iter().take(12).map(shown).collect();
    let accepted = format!(
        "a map of one of the sizes in the file: {}; or --camera-size WxH, which says which of them is scaled to the map",
        names.join(", ")
    );
    Error::parameter("camera", format_args!("for other sizes than {w} x {h}"), accepted)
}

/// Notes on a camera that is unlikely for a map; `is_size_stated` if a size was stated, so that the principal point of a part of
/// a picture may lie outside of it.
fn checked(camera: &Intrinsics, map: Size, is_size_stated: bool, lens: Option<&Distortion>) -> Result<Vec<String>> {
    refuse_other_orders(camera, map)?;
    if !is_size_stated {
        refuse_outside(camera, map)?;
    }
    let is_wide = lens.is_some_and(|lens| lens.model() == DistortionModel::KannalaBrandt);
    let notes = [
        mirrored(camera),
        middle_elsewhere(camera, map),
        odd_pixels(camera, map),
        odd_field(camera, map).filter(|_| !is_wide),
    ];
    Ok(notes.into_iter().flatten().collect())
}

/// Whether a place is the middle of a picture to within a pixel.
fn is_middle_of([u, v]: [f64; 2], (width, height): Size) -> bool {
    (2.0 * u + 1.0 - width as f64).abs() <= 1.5 && (2.0 * v + 1.0 - height as f64).abs() <= 1.5
}

/// Whether a place is no further from the middle than [`FAR`].
fn is_near_middle(at: [f64; 2], (width, height): Size) -> bool {
    let is_near = |at: f64, side: usize| (at - 0.5 * (side as f64 - 1.0)).abs() <= FAR * side as f64;
    is_near(at[0], width) && is_near(at[1], height)
}

fn is_outside(camera: &Intrinsics, (width, height): Size) -> bool {
    let is_outside = |at: f64, side: usize| at < -0.5 || at > side as f64 - 0.5;
    is_outside(camera.cx, width) || is_outside(camera.cy, height)
}

/// Refuses parts of the picture's size, and focal lengths in the place of the principal point.
fn refuse_other_orders(camera: &Intrinsics, map: Size) -> Result<()> {
    let Intrinsics { fx, fy, cx, cy } = *camera;
    let [width, height] = [map.0, map.1].map(|side| side as f64);
    let refused = |accepted| Err(Error::parameter("camera", format_args!("{fx},{fy},{cx},{cy}"), accepted));
    if [fx, fy, cx, cy].iter().all(|part| (0.0..2.0).contains(part)) {
        let own = Intrinsics { fx: fx * width, fy: fy * height, cx: cx * width - 0.5, cy: cy * height - 0.5 };
        return refused(format!("pixels; if these are parts of the picture's width and height, {}", flag(&own)));
    }
    // Focal lengths are about equal, and the principal point is the middle of the map or of a picture of its shape.
    let is_shape = ((2.0 * fx + 1.0) / (2.0 * fy + 1.0) / (width / height) - 1.0).abs() < 0.02;
    let is_middle = is_near_middle([fx, fy], map) || is_shape && is_outside(camera, map);
    let is_swapped = (cx - cy).abs() <= 0.05 * cx.abs() && fx != fy && is_middle;
    if is_swapped && !is_near_middle([cx, cy], map) {
        let swapped = Intrinsics { fx: cx, fy: cy, cx: fx, cy: fy };
        let own = whole_picture(&swapped, map).map_or(swapped, |(_, scaled)| scaled);
        return refused(format!("focal lengths first, then the principal point: {}", flag(&own)));
    }
    Ok(())
}

/// Refuses a principal point outside of the map, unless it is that of the turned picture, which is noted.
fn refuse_outside(camera: &Intrinsics, map: Size) -> Result<()> {
    let Intrinsics { cx, cy, .. } = *camera;
    let (w, h) = map;
    if !is_outside(camera, map) || is_middle_of([cx, cy], (h, w)) {
        return Ok(());
    }
    let accepted = match whole_picture(camera, map) {
        Some(((width, height), scaled)) => format!(
            "a principal point within the map, which has {w} x {h} pixels; this one is that of {width} x {height}: {}, or \
             --camera-size {width}x{height}; {OF_CROP}",
            flag(&scaled)
        ),
        None => match COMMON.into_iter().find(|size| is_middle_of([cx, cy], *size)) {
            Some((width, height)) => format!(
                "a principal point within the map, which has {w} x {h} pixels; this one is that of {width} x {height}: {}",
                of_other_shape(camera, (width, height), map)
            ),
            None => format!(
                "a principal point within the map, which has {w} x {h} pixels; --camera-size WxH if the camera is for another \
                 size; {OF_CROP}, and state --camera-size {w}x{h} if the principal point is then still outside"
            ),
        },
    };
    Err(Error::parameter("principal point", format_args!("{cx},{cy}"), accepted))
}

/// A principal point that is the middle of another picture, or far from that of the map.
fn middle_elsewhere(camera: &Intrinsics, map: Size) -> Option<String> {
    let (Intrinsics { cx, cy, .. }, (w, h)) = (*camera, map);
    let has = format!("and the map has {w} x {h}");
    if w != h && is_middle_of([cx, cy], (h, w)) {
        return Some(format!(
            "the principal point {cx},{cy} is the middle of {h} x {w} pixels, {has}: are cx and cy exchanged, or was the picture \
             turned by 90 degrees?"
        ));
    }
    if let Some(((width, height), scaled)) = whole_picture(camera, map) {
        return Some(format!(
            "the principal point {cx},{cy} is the middle of {width} x {height} pixels, {has}: if the picture was resized, give \
             --camera-size {width}x{height} or {}; {OF_CROP}",
            flag(&scaled)
        ));
    }
    let is_known = |size: &Size| !is_middle_of([cx, cy], map) && is_middle_of([cx, cy], *size);
    if let Some((width, height)) = COMMON.into_iter().find(is_known) {
        return Some(format!(
            "the principal point {cx},{cy} is the middle of {width} x {height} pixels, {has}: {}",
            of_other_shape(camera, (width, height), map)
        ));
    }
    (!is_near_middle([cx, cy], map)).then(|| {
        format!(
            "the principal point {cx},{cy} lies far from the middle of {w} x {h} pixels: check --intrinsics, --camera and \
             --camera-size; {OF_OTHER_CROP}"
        )
    })
}

/// A mirrored picture: unlike `fy` below 0, which means that y points up (ICL-NUIM), nobody's camera has it.
fn mirrored(&Intrinsics { fx, .. }: &Intrinsics) -> Option<String> {
    (fx < 0.0).then(|| {
        format!("fx is {fx}, below 0: x points to the left, in planes and points as well; state it above 0 for x to the right")
    })
}

/// Pixels that are far from square: where they would not be in the order fx,cx,fy,cy, or where nobody's are. Scanners and
/// maps without every second row have such pixels.
fn odd_pixels(camera: &Intrinsics, map: Size) -> Option<String> {
    let Intrinsics { fx, fy, cx, cy } = *camera;
    let is_square = |fx: f64, fy: f64| (0.7..1.4).contains(&(fx / fy).abs());
    let is_other_order = !is_square(fx, fy) && is_square(fx, cx) && is_near_middle([fy, cy], map);
    let is_own_order = is_middle_of([cx, cy], map);
    let far = "pixels that are far from square";
    match () {
        () if is_other_order && !is_own_order => {
            Some(format!("focal lengths of {fx} and {fy} pixels mean {far}: is the order fx,fy,cx,cy?"))
        }
        () if !(0.1..10.0).contains(&(fx / fy).abs()) => {
            Some(format!("focal lengths of {fx} and {fy} pixels mean {far}: check --intrinsics and --camera"))
        }
        () => None,
    }
}

/// A field of view that is far from usual.
fn odd_field(&Intrinsics { fx, fy, .. }: &Intrinsics, (width, height): Size) -> Option<String> {
    let field = |side: usize, focal: f64| 2.0 * (0.5 * side as f64 / focal.abs()).atan().to_degrees();
    let [across, down] = [field(width, fx), field(height, fy)];
    let is_usual = |field: &f64| (FIELD_DEG[0]..=FIELD_DEG[1]).contains(field);
    (![across, down].iter().all(is_usual)).then(|| {
        format!(
            "focal lengths of {fx} and {fy} pixels mean a field of view of {across:.1} x {down:.1} degrees: check --intrinsics, \
             --camera and --camera-size"
        )
    })
}
