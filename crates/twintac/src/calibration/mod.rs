//! Calibration: measured curves from files, the fitted material as text, and plots.

mod curves;
mod material;
mod plot;

pub(crate) use curves::{CsvPlace, of_csv, of_file};
pub(crate) use material::material_block;
pub(crate) use plot::scene;
