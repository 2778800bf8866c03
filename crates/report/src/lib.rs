//! Pressure maps, plots and the HTML report.

mod axis;
mod color;
pub mod data;
mod error;
mod file;
mod font;
mod html;
pub mod plot;
mod pressure_map;
mod raster;
mod scene;
pub mod sensor_drawing;
mod svg;

pub use color::{Ink, PALETTE, viridis};
pub use data::{Provenance, ReportData};
pub use error::ReportError;
pub use html::{render, write};
pub use pressure_map::{MapSettings, PressureMap, Rectangle, Weights, pitch_mm, pressure_map};
pub use raster::png;
pub use scene::{Anchor, Mark, Scene};
pub use sensor_drawing::SensorDrawing;
pub use svg::svg;
