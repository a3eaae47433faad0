//! An occupancy grid as the two files that ROS' `map_server` reads: a picture and a YAML file that says where it lies.
//!
//! Source: <https://wiki.ros.org/map_server>, "Map format". Black is occupied, white free and grey unknown. The picture's rows
//! go from the largest y down, the grid's from the least y up.

use super::error::OutputError;
use super::files::write_together;
use super::picture::{grey8_pgm, grey8_png};
use depthplanes::ground::{Occupancy, OccupancyGrid};
use std::path::{Path, PathBuf};

/// Greys of the picture; with [`THRESHOLDS`] map_server takes 0 for occupied and 254 for free, as its own map_saver writes
/// them. Its grey of the unknown, 205, is free to readers with a threshold of 0.25; the middle is unknown to all.
fn grey(of: Occupancy) -> u8 {
    match of {
        Occupancy::Occupied => 0,
        Occupancy::Free => 254,
        Occupancy::Unknown => 128,
    }
}

/// Shares of black from which on a cell is occupied, and below which it is free: those of map_saver.
const THRESHOLDS: [f64; 2] = [0.65, 0.196];

/// The name of the YAML file beside a grid's picture.
pub fn grid_yaml_path(picture: &Path) -> PathBuf {
    picture.with_extension("yaml")
}

/// Writes a grid as a picture (PNG, or PGM if the name ends in `.pgm`) and the YAML file beside it: both, or none.
///
/// # Errors
/// As [`super::write_file`].
pub fn write_grid(path: &Path, grid: &OccupancyGrid) -> Result<(), OutputError> {
    let rows = grid.cells.chunks_exact(grid.width.max(1)).rev();
    let greys: Vec<u8> = rows.flatten().map(|&cell| grey(cell)).collect();
    let is_pgm = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("pgm"));
    let encode = if is_pgm { grey8_pgm } else { grey8_png };
    let picture = encode(grid.width, grid.height, &greys);
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    write_together(&[(path, &picture), (&grid_yaml_path(path), yaml(&name, grid).as_bytes())])
}

fn yaml(name: &str, grid: &OccupancyGrid) -> String {
    let [occupied, free] = THRESHOLDS;
    let [x, y] = grid.origin_m.map(|at| (at * 1e6).round() / 1e6 + 0.0);
    // A string of JSON is one of YAML.
    let image = serde_json::Value::from(name);
    format!(
        "image: {image}\nmode: trinary\nresolution: {:?}\norigin: [{x:?}, {y:?}, 0.0]\nnegate: 0\noccupied_thresh: {occupied:?}\n\
         free_thresh: {free:?}\n",
        grid.resolution_m
    )
}
