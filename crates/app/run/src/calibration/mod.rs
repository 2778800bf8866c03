//! Calibration: measured curves from files, the fitted material as a file, and plots.

mod curves;
mod material;
mod plot;

pub use curves::{CsvPlace, Measured, of_csv, of_file};
pub use material::material_file;
pub use plot::scene;
