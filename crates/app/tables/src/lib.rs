//! Tables over depth of a gel: solved by finite elements and cached on disk, or read from a
//! surrogate.
//!
//! - [`DepthTableStore`] answers requests for tables (the trait `DepthTableSource` of
//!   `crates/twin/depth_table`): force in N, pressure at the ports in kPa and its slopes in kPa/mm,
//!   over depth in mm, for an indenter at a location on the gel.
//! - [`FastTables`] makes the same tables from the surrogate, a trained `FastGel` of
//!   `crates/twin/fast`, where nothing is solved.
//!
//! # How it works
//!
//! The response of an elastic gel without friction depends on the depth alone: one table over depth
//! serves all presses at a location, whatever their speed and holds. [`DepthTableStore`] computes
//! each table once. With [`DepthTableStore::kept_in`] it keeps it as a file; the key of the file
//! consists of the whole gel (sensor description, surfaces, settings), the location, the indenter's
//! shape and the build of the program, so a table with other inputs is never reused.
//!
//! Requests that differ in location and depth alone share a lattice of locations if it has fewer
//! points than there are different locations. The lattice is simulated, and the tables of the
//! locations are interpolated from it. Its spacing is a quarter of the gel's height for locations
//! along a line, and a third for locations over a plane, which needs many more points. Requests of
//! prescribed force are first pressed at the lattice's corners, where a gel is softest: the depths
//! that are needed there serve all points of the lattice. All solutions of one request run in
//! parallel, one press a thread.
//!
//! With a surrogate, slopes of the pressure and the mean over a port's opening come from finite
//! differences of 0.5 mm. The stress features of the table are zero: the surrogate does not compute
//! them. Such tables are not kept.
//!
//! The crate reads no environment variable and no argument, prints nothing, and does not depend on
//! `crates/app/run`.

mod fast;
mod store;

pub use fast::{FAST_GEL, FastTables};
pub use store::DepthTableStore;
