//! Calibration: measured curves from files, the fitted material as a file, and plots.

mod curves;
mod material;
mod plot;

pub(crate) use curves::{CsvPlace, Measured, of_csv, of_file};
pub(crate) use material::material_file;
pub(crate) use plot::scene;
