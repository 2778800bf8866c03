//! Simulated presses as tables over depth: force and pressures at one location, and their
//! interpolation.
//!
//! In: for one location of an indenter, a [`DepthTable`], which a [`DepthTableSource`] delivers.
//! Its frames have depth (mm), force (N), the pressure at each taxel's port and its derivatives
//! (kPa, kPa/mm), and the stress feature of the TwinTac paper (kPa/mm). Out: the same quantities at
//! any depth, any force and any location between those that were simulated.
//!
//! - [`DepthCurves`] interpolates one table over depth, or reads it by force, with
//!   [`MonotoneCubic`]s.
//! - [`Lattice`] interpolates tables over a regular lattice of locations. [`DepthTable::blend`]
//!   makes the weighted sum of tables.
//! - [`DepthTableSource`] is the trait of whatever makes tables: a finite-element gel, stored
//!   tables of one, or a formula.
//!
//! This crate depends neither on a solver nor on recordings, so that a twin can read tables without
//! the finite-element code.
//!
//! # How it works
//!
//! The state of an elastic gel without friction depends on the depth alone, not on what happened
//! before. A location is therefore simulated once, as a table over depth, and every press at that
//! location is interpolated from the table, whatever its speed and its holds. Force-controlled,
//! static data read the same table by force instead of by depth. With friction, a table holds for
//! loading only; a path has to be simulated with its history (crate `twintac-simulate`). The
//! viscoelastic relaxation of real gels and ports is not in the table: the twin learns it (crate
//! `digitac`).
//!
//! Curves run over depth to the power with which the force begins to grow (3/2 under a ball, 1
//! under a flat punch), because force and pressures begin as straight lines over it. A table of ten
//! depths is then as accurate as one of fifty.
//!
//! Where more locations are pressed than a lattice over them has nodes, only the lattice is
//! simulated and interpolated by cubic splines. Its nodes are at most a quarter of the gel's height
//! apart for locations along a line, and a third of it for locations over a plane. Pressures at a
//! port vary over distances of the gel's height, so the error of these splines is smaller than that
//! of the mesh.

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
