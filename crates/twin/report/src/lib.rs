//! Pressure maps, plots and the HTML report.
//!
//! Charts and drawings are plain data that turn into a [`Scene`]; [`svg`] and [`png`] paint it without any font of the
//! system. [`render`] makes one self-contained page of a [`ReportData`] that other crates fill in: this crate computes
//! no results. A [`Page`] has the same look and contents of the caller's choice.
//!
//! ```
//! use twintac_report::data::Headline;
//! use twintac_report::{Provenance, ReportData, render};
//!
//! let headline = Headline { presses: 12, nearest_in_contact_percent: 1.3, ..Headline::default() };
//! let data = ReportData { provenance: Provenance::Emulated, headline: Some(headline), ..ReportData::default() };
//! assert!(render(&data).contains("on 12 presses that it never saw"));
//! ```

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
pub use html::{Block, Cell, Page, PageSection, render, write};
pub use pressure_map::{
    Kernel, MapSettings, PreparedMap, PressureMap, Rectangle, Weights, leave_one_out_width_mm, pitch_mm,
    pressure_map,
};
pub use raster::png;
pub use scene::{Anchor, Mark, Scene};
pub use sensor_drawing::SensorDrawing;
pub use svg::svg;
