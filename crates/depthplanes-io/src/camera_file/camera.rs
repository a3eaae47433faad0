//! What a camera file states, and the small steps that its forms share.

use depthplanes::{Distortion, DistortionModel, Intrinsics};

use crate::encoding::Stereo;
use crate::error::{Error, Result};

/// What a camera file states of a camera.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CameraFile {
    /// Which camera of the file it is, such as `P2` or `[LEFT_CAM_HD]`; empty where there is one alone.
    pub name: String,
    /// The pinhole camera.
    pub intrinsics: Intrinsics,
    /// The distortion of its lens; none if the map is taken to be rectified.
    pub distortion: Option<Distortion>,
    /// The camera of maps of the other kind: of the raw picture where the map is taken to be rectified, of the rectified
    /// one where it is taken to be raw.
    pub otherwise: Option<(Intrinsics, Option<Distortion>)>,
    /// Whether the map is taken to be of the rectified picture.
    pub rectified: bool,
    /// Columns and rows that the intrinsics are for, if stated.
    pub size: Option<(usize, usize)>,
    /// The stereo rig, if stated.
    pub stereo: Option<Stereo>,
    /// Whether the file belongs to maps of disparity (Middlebury, ETH3D).
    pub disparity: bool,
    /// Metres per unit of the maps that belong to it, if stated.
    pub unit_m: Option<f64>,
    /// Cameras of the file for other sizes of maps; this one is the first of them.
    pub choices: Vec<CameraFile>,
    /// What a person should know: which of several cameras this is, what was ignored.
    pub notes: Vec<String>,
}

impl CameraFile {
    /// A pinhole camera of which nothing else is known.
    pub fn new(intrinsics: Intrinsics) -> Self {
        CameraFile {
            name: String::new(),
            intrinsics,
            distortion: None,
            otherwise: None,
            rectified: false,
            size: None,
            stereo: None,
            disparity: false,
            unit_m: None,
            choices: Vec::new(),
            notes: Vec::new(),
        }
    }

    pub(super) fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    pub(super) fn size(mut self, size: Option<(usize, usize)>) -> Self {
        self.size = size.or(self.size);
        self
    }

    pub(super) fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// With the lens of maps of the raw picture; `rectified` says which the map is taken for. Zeros are no distortion.
    pub(super) fn lens(mut self, distortion: Option<Distortion>, rectified: bool) -> Self {
        let Some(distortion) = distortion.filter(|distortion| !distortion.is_none()) else { return self };
        self.rectified = rectified;
        let [raw, straight] = [(self.intrinsics, Some(distortion)), (self.intrinsics, None)];
        let (taken, other) = if rectified { (straight, raw) } else { (raw, straight) };
        (self.distortion, self.otherwise) = (taken.1, Some(other));
        self
    }

    /// The first of several cameras for maps of different sizes.
    ///
    /// # Errors
    /// [`Error::Unreadable`] if there is none.
    pub(super) fn first_of(cameras: Vec<CameraFile>) -> Result<CameraFile> {
        let first = cameras.first().cloned().ok_or_else(|| unreadable("it has no camera"))?;
        Ok(CameraFile { choices: cameras, ..first })
    }

    /// The camera for maps of a size: that of the file's choices, if it has several.
    pub(crate) fn for_size(&self, size: (usize, usize)) -> &CameraFile {
        self.choices.iter().find(|camera| camera.size == Some(size)).unwrap_or(self)
    }

    /// The camera for maps of the rectified picture, or of the raw one.
    pub(crate) fn seen(&self, rectified: Option<bool>) -> (Intrinsics, Option<Distortion>) {
        match self.otherwise {
            Some(other) if rectified.is_some_and(|rectified| rectified != self.rectified) => other,
            _ => (self.intrinsics, self.distortion),
        }
    }
}

/// What is no camera file, and what would be one.
pub(super) fn unreadable(wrong: impl Into<String>) -> Error {
    let accepted = "fx,fy,cx,cy; a 3 x 3, 3 x 4 or 4 x 4 matrix; a camera in JSON or YAML (ROS, OpenCV, Open3D, RealSense, COLMAP, \
         KITTI, ORB-SLAM, Kalibr, nerf and others: docs/cameras.md); or a Middlebury calib.txt";
    Error::Unreadable { format: "camera file", wrong: wrong.into(), accepted }
}

/// Checked intrinsics in pixels.
pub(super) fn pinhole(fx: f64, fy: f64, cx: f64, cy: f64) -> Result<CameraFile> {
    let intrinsics = Intrinsics::new(fx, fy, cx, cy)?;
    if fx.abs() <= 10.0 && fy.abs() <= 10.0 && cx.abs() <= 2.0 && cy.abs() <= 2.0 {
        return Err(unreadable(format!(
            "{fx},{fy},{cx},{cy} are not pixels; if they are shares of the picture's size, multiply fx, cx by its width and fy, cy by \
             its height"
        )));
    }
    Ok(CameraFile::new(intrinsics))
}

/// A 3 x 3, 3 x 4 or 4 x 4 matrix, row by row or column by column: the principal point stands where the zeros do not. A
/// 3 x 4 matrix may have a last column: it is given as well.
pub(super) fn matrix(m: &[f64]) -> Result<CameraFile> {
    let short = |m: &[f64]| m.iter().map(|x| x.to_string()).collect::<Vec<_>>().join(" ");
    let no = || unreadable(format!("the matrix {} is not fx 0 cx; 0 fy cy; 0 0 1", short(m)));
    let square = match *m {
        [a, b, c, d, e, f, g, h, i] => [a, b, c, d, e, f, g, h, i],
        [a, b, c, _, d, e, f, _, g, h, i, _] => [a, b, c, d, e, f, g, h, i],
        [a, b, c, x, d, e, f, y, g, h, i, z, p, q, r, one] => {
            if [x, y, z, p, q, r] != [0.0; 6] || one != 1.0 {
                return Err(no());
            }
            [a, b, c, d, e, f, g, h, i]
        }
        _ => return Err(unreadable(format!("{} numbers instead of 9, 12 or 16 of a matrix", m.len()))),
    };
    let [fx, b, cx, d, fy, cy, g, h, one] = match square {
        [a, b, 0.0, d, e, 0.0, g, h, i] => [a, d, g, b, e, h, 0.0, 0.0, i],
        rows => rows,
    };
    // A skew of a thousandth of the focal length moves no plane by more than the calibration is wrong.
    let small = 1e-3 * fx.abs();
    if [d, g, h] != [0.0; 3] || (one - 1.0).abs() > 1e-9 || b.abs() > small || [fx, fy] == [1.0; 2] {
        return Err(no());
    }
    let camera = pinhole(fx, fy, cx, cy)?;
    Ok(if b == 0.0 { camera } else { camera.note(format!("the skew of {b} pixels is ignored")) })
}

/// Columns and rows, if they can be those of a map.
pub(super) fn size(width: Option<f64>, height: Option<f64>) -> Option<(usize, usize)> {
    let side = |side: f64| (side >= 1.0 && side.fract() == 0.0 && side < 1e6).then_some(side as usize);
    Some((side(width?)?, side(height?)?))
}

/// The model that a name means; none for one that is not known here.
pub(super) fn model(name: &str) -> Option<DistortionModel> {
    let name: String = name.to_lowercase().chars().filter(char::is_ascii_alphanumeric).collect();
    let has = |words: &[&str]| words.iter().any(|word| name.contains(word));
    if has(&["inverse"]) {
        Some(DistortionModel::InverseBrownConrady)
    } else if has(&["modified"]) {
        Some(DistortionModel::ModifiedBrownConrady)
    } else if has(&["ftheta", "omni", "mei", "eucm", "doublesphere", "atan", "fov", "thinprismfisheye", "division"]) {
        None
    } else if has(&["equi", "fisheye", "kannala", "kb4", "kb8"]) {
        Some(DistortionModel::KannalaBrandt)
    } else if name.is_empty()
        || has(&["plumb", "radtan", "radial", "brown", "rational", "opencv", "pinhole", "perspective", "none"])
    {
        Some(DistortionModel::BrownConrady)
    } else {
        None
    }
}

/// Refuses a model whose `fx` is no pinhole's focal length, whatever its coefficients.
///
/// # Errors
/// [`Error::Unreadable`] with its name.
pub(super) fn refuse_no_pinhole(name: &str) -> Result<()> {
    let short: String = name.to_lowercase().chars().filter(char::is_ascii_alphanumeric).collect();
    let is = ["ds", "ucm", "eucm", "mei", "omni", "cata", "ocam"].contains(&short.as_str());
    let parts = ["doublesphere", "unified", "omni", "catadioptric", "scaramuzza", "equirect", "spherical", "panoram"];
    let starts = ["eucm", "ucm", "ds-", "omni"].iter().any(|start| name.to_lowercase().starts_with(start));
    if is || starts || parts.iter().any(|part| short.contains(part)) {
        return Err(unreadable(format!(
            "its camera model `{name}` is no pinhole, and its numbers are not those of one; undistort the map to a pinhole camera, and \
             give that camera"
        )));
    }
    Ok(())
}

/// A camera with coefficients of a named model, of which `rectified` says what the map is taken for. What is not known is
/// noted.
pub(super) fn with_lens(camera: CameraFile, name: &str, coefficients: &[f64], rectified: bool) -> Result<CameraFile> {
    refuse_no_pinhole(name)?;
    if coefficients.iter().all(|&k| k == 0.0) && model(name) != Some(DistortionModel::KannalaBrandt) {
        return Ok(camera);
    }
    // Four zeros of a fisheye are a lens, but no coefficients are none.
    if coefficients.is_empty() {
        return Ok(camera);
    }
    let Some(model) = model(name) else {
        return Ok(camera.note(format!(
            "its lens distortion of the model `{name}` is not known here and is ignored: planes bend towards the corners, and large \
             ones may fall apart; undistort the map first"
        )));
    };
    match Distortion::new(model, coefficients) {
        Ok(distortion) => Ok(camera.lens(Some(distortion), rectified)),
        Err(_) if coefficients.iter().all(|k| k.is_finite()) => Ok(camera.note(format!(
            "its lens distortion has {} coefficients, more than the model `{}` has here, and is ignored: planes bend towards \
             the corners",
            coefficients.len(),
            model.name()
        ))),
        Err(error) => Err(error.into()),
    }
}
