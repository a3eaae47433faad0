//! Detections to bytes: one file for each output, and the table that names them.
//!
//! In: a [`Report`], one frame and what was found in it. Out: the bytes of a file, which
//! [`write_all`] puts on the disk whole or not at all. A row of [`OUTPUTS`] gives an output its
//! flag, its file name in a folder of results and its line in the docs.

mod cloud;
mod coco;
mod colour;
mod curved;
mod depth;
mod destination;
mod error;
mod explanation_record;
mod files;
mod font;
mod geojson;
mod grid;
mod ground;
mod ground_record;
mod labels;
mod legend;
mod lines;
mod mesh;
mod noise;
mod noise_record;
mod npy;
mod outline;
mod output;
mod overlay;
#[cfg(feature = "parquet")]
mod parquet;
mod picture;
mod planes;
mod record;
mod shade;
mod staged;
mod table;
mod table_form;
mod times;
mod tinted;

pub use colour::{colour, id_colour};
pub use depth::depth_m;
pub use error::OutputError;
pub use explanation_record::explanation_record;
pub use files::{check_folder, check_paths, write_all, write_file};
pub use grid::{grid_yaml_path, write_grid};
pub use ground::{ground_png, mark_colour};
pub use ground_record::ground_record;
pub use labels::{npy as labels_npy, png as labels_png};
pub use mesh::mesh_ply;
pub use noise::noise_in_words;
pub use noise_record::{NOISE_RANGES_M, noise_record};
pub use npy::map_npy;
pub use output::{Output, Report, Writer};
pub use overlay::{overlay_pixels, overlay_png, tracked_png};
pub use picture::grey16_png;
pub use planes::{CSV_COLUMNS, document as json_document, line as json_line};
pub use record::SCHEMA;
pub use staged::remove_unfinished;
pub use table::{TableFile, TableForm};
pub use times::{Spread, Times};
pub use tinted::{Tile, side_by_side, tinted_png};

/// All outputs.
pub const OUTPUTS: &[Output] =
    &[labels::OUTPUT, overlay::OUTPUT, planes::OUTPUT, cloud::OUTPUT, mesh::OUTPUT, curved::OUTPUT];
