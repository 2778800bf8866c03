//! Plots, and pages that show them.
//!
//! A plot ([`Panels`], [`Bars`], [`HeatMaps`], [`Density`], [`Places`], [`Scatter`]) is plain data. It turns into a [`Scene`]: lines,
//! areas and texts in pixels. [`svg`] and [`png`] paint a scene with an embedded font, so that the same data give the
//! same bytes on every machine. [`page::Page`] is one self-contained HTML file of texts, tables and scenes.
//!
//! This crate knows no sensor and computes no results.
//!
//! ```
//! use twintac_plot::{Bar, Bars, Ink, svg};
//!
//! let bar = Bar { name: "S0".into(), value: 1.3, uncertainty: None, text: "1.3 %".into(), ink: Ink::Twin };
//! let bars = Bars { title: "Error by taxel".into(), x_label: "error, %".into(), bars: vec![bar] };
//! assert!(svg(&bars.scene()).contains("1.3 %"));
//! ```

mod axis;
mod chart;
mod color;
mod error;
mod font;
mod number;
pub mod page;
mod raster;
mod scene;
mod svg;
mod write;

pub use axis::{extent, padded};
pub use chart::{
    Bar, Bars, Density, HeatMap, HeatMaps, Panel, Panels, Places, Scatter, ScatterPoint, Series,
};
pub use color::{Ink, PALETTE, viridis};
pub use error::PlotError;
pub use font::text_width;
pub use number::{fixed, short};
pub use raster::{pixels, png};
pub use scene::{Anchor, Mark, SMALL, Scene};
pub use svg::svg;
