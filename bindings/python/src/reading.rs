//! What is stated of maps beside their numbers, as the readers of files take it.

use crate::error::{Error, Result};
use depthplanes::Intrinsics;
use depthplanes::noise::{NoiseTable, SensorNoise};
use depthplanes_io::camera_file::read_camera;
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::{ReadOptions, read_noise_table};
use pyo3::prelude::*;
use std::path::PathBuf;

/// What is stated of maps. The keywords are those of the program's flags, but for `sensor` (`--preset`), `unit` (`--encoding`)
/// and `intrinsics` and `camera_file`, which are both `camera` in Python.
#[pyclass(frozen, module = "depthplanes._native")]
pub(crate) struct Reading {
    pub(crate) options: ReadOptions,
}

/// The noise of depth over the range: a file, or its rows.
#[derive(FromPyObject)]
enum Noise {
    Rows(Vec<[f64; 2]>),
    File(PathBuf),
}

#[pymethods]
impl Reading {
    #[new]
    #[pyo3(signature = (
        *, sensor=None, intrinsics=None, camera_file=None, unit=None, scale=None, depth_scale=None, ray_distance=false,
        disparity=false, focal=None, baseline=None, doffs=None, missing=None, valid_range=None, camera_size=None,
        rectified=None, swap_bytes=false, noise_table=None, member=None, raw_size=None, raw_type=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords")]
    fn new(
        sensor: Option<String>,
        intrinsics: Option<[f64; 4]>,
        camera_file: Option<PathBuf>,
        unit: Option<String>,
        scale: Option<f64>,
        depth_scale: Option<f64>,
        ray_distance: bool,
        disparity: bool,
        focal: Option<f64>,
        baseline: Option<f64>,
        doffs: Option<f64>,
        missing: Option<f64>,
        valid_range: Option<(f64, f64)>,
        camera_size: Option<(usize, usize)>,
        rectified: Option<bool>,
        swap_bytes: bool,
        noise_table: Option<Noise>,
        member: Option<String>,
        raw_size: Option<(usize, usize)>,
        raw_type: Option<String>,
    ) -> Result<Self> {
        let mut options = ReadOptions {
            decode: DecodeOptions { member, raw_size, raw_type, ..DecodeOptions::default() },
            preset: sensor,
            encoding: unit,
            scale,
            depth_scale,
            ray_distance,
            disparity,
            swap_bytes,
            missing,
            valid_range,
            camera_size,
            rectified,
            noise: noise_table.map(noise).transpose()?,
            ..ReadOptions::default()
        };
        if let Some(path) = camera_file {
            options = options.camera(&read_camera(path)?);
        }
        if let Some([fx, fy, cx, cy]) = intrinsics {
            options.intrinsics = Some(Intrinsics::new(fx, fy, cx, cy)?);
        }
        if options.camera_size.is_some() && options.intrinsics.is_none() && options.camera_file.is_none() {
            return Err(Error::Input("camera_size needs the camera that it is of: state camera".into()));
        }
        options.check()?;
        Ok(Reading { options: options.rig(focal, baseline, doffs)? })
    }
}

fn noise(given: Noise) -> Result<SensorNoise> {
    Ok(SensorNoise::Table(match given {
        Noise::Rows(rows) => NoiseTable::new(&rows)?,
        Noise::File(path) => read_noise_table(path)?,
    }))
}
