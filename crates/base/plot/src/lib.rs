//! Plots as SVG and PNG, and HTML pages that show them.
//!
//! - Input: a chart as plain data ([`Panels`] of lines, [`Bars`], [`HeatMaps`], [`Density`],
//!   [`Places`], [`Scatter`]), in the units of its axes.
//! - Its method `scene` lays it out as a [`Scene`]: lines, areas, images and texts in pixels, x
//!   right and y down. Drawings can be built as a [`Scene`] directly.
//! - Output: [`svg`] and [`png`] paint a scene, [`Scene::write`] writes it to a file, and
//!   [`page::Page`] is one self-contained HTML file of texts, tables and scenes.
//!
//! ```
//! use twintac_plot::{Bar, Bars, Ink, svg};
//!
//! let bar = Bar { name: "S0".into(), value: 1.3, uncertainty: None, text: "1.3 %".into(), ink: Ink::Twin };
//! let bars = Bars { title: "Error by taxel".into(), x_label: "error, %".into(), bars: vec![bar] };
//! assert!(svg(&bars.scene()).contains("1.3 %"));
//! ```
//!
//! # How it works
//!
//! The layout measures each text with the embedded font, so that no label leaves the picture:
//! margins grow with the labels, long texts are shortened or wrapped. The same font paints the PNG,
//! and the SVG states the width of each text, so that a viewer with another font keeps to the
//! layout. The same data therefore give the same bytes on every machine. Colours are roles
//! ([`Ink`]), which a page can restyle for a dark screen.
//!
//! ```text
//! chart/      from data to a scene: one file for each kind of chart
//! axis        round tick values on linear and logarithmic scales
//! scene       the picture as plain data
//! font        widths and outlines of texts
//! svg, raster paint a scene
//! page/       HTML pages: blocks, contents, style
//! ```
//!
//! This is code of our own although libraries exist. One [`Scene`] holds plots, pressure maps and
//! technical drawings, all laid out with measured texts. `plotters` leaves the room for labels to
//! its caller. `kuva` measures texts but has charts only, so drawings would need a second library.
//! `resvg` could paint the same SVG as PNG, but with its texts and images it brings 41 more crates
//! and 38 processor seconds, a ninth of the whole first build.
//!
//! This crate knows no sensor and computes no results.

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
