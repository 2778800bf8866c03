//! Simulated presses as tables over depth: force and pressures at one position, and their interpolation.
//!
//! The state of an elastic gel without friction depends on the depth alone, not on the path of the indenter. So each place is simulated
//! once, as a [`DepthTable`], and every press there, at any speed and with any holds, is read from the table: [`DepthCurves`] interpolates it
//! over depth ([`MonotoneCubic`]), and a [`Lattice`] interpolates tables over places. A [`DepthTableSource`] delivers the tables; this crate
//! solves nothing.

mod blend;
mod depth_curves;
mod depth_table;
mod error;
mod lattice;
mod monotone_cubic;
mod source;

pub use depth_curves::DepthCurves;
pub use depth_table::{DepthTable, PressFrame, SolveQuality};
pub use error::DepthTableError;
pub use lattice::Lattice;
pub use monotone_cubic::MonotoneCubic;
pub use source::{DepthTableRequest, DepthTableSource, SourceError};
