//! Training presses and test presses for the surrogate of a gel (`twintac-fast`): random presses of
//! a sensor's gel, solved by finite elements (FEM).
//!
//! A [`FemPresses`] takes a sensor's description and the locations of the gel's base at which the
//! pressure is evaluated, mm. It returns one press for each seed and number, as a `FemPress` of
//! `twintac-fast`: frames with the indenter's pose, force, N, torque, N mm, and the pressure at
//! each location, kPa. The same seed and number give the same press, as in earlier versions, whose
//! names the random streams still have. All presses are `simulated`.
//!
//! - [`FemPresses::training_press`]: a training press. [`FemPresses::own_training_press`]: one with
//!   an indenter of the sensor.
//! - [`FemPresses::test_press`], [`FemPresses::slide`], [`FemPresses::own_test_press`]: test
//!   presses, of shapes that are not trained on, sliding, or with an indenter of the sensor.
//! - [`FemPresses::ood_press`]: an out-of-distribution (OOD) press of a given kind ([`OodKind`]),
//!   to test the OOD score.
//! - [`test_surfaces`]: the random meshes that test presses use.
//!
//! # How it works
//!
//! ```text
//! draw                 which shape, where, how deep, on how fine a mesh
//! out_of_distribution  the same for OOD presses
//! random_mesh          random meshes: closed surfaces with bumps
//! press                the FEM solution of a press, frame by frame
//! ```
//!
//! The pressure is evaluated at locations all over the gel's base, not only at the ports. The
//! effect of a shape on a location depends on where the shape presses *relative* to it, so each
//! press trains as much as a hundred presses with eight ports alone.
//!
//! Training presses use balls, cylinders, boxes, rings and wedges, alone or two or three together,
//! at random locations, tilts and depths. Their meshes are from coarse to fine. Coarse meshes are
//! cheap and give too low pressures. The network has an input that says how much longer than the
//! finest the edges are, and is evaluated at the finest. The finest edges are a fourteenth of the
//! gel's height, or 3 % of its width where that is less: shapes are drawn in proportion to the
//! width, and their rims need edges that short.
//!
//! The pressure where the gel's side meets its base has no limit as meshes get finer. For a sensor
//! with a port there, all edges of a mesh have one length, so that the pressure at that port
//! depends on this length by a factor and not on where the press is.
//!
//! Test presses have shapes that are not trained on (crosses, triangles, random meshes), on the
//! finest meshes. Each pose of a sliding press is reached from rest, on a mesh of its own. Without
//! friction the state of the gel does not depend on the path, but the mesh of an FEM solution stays
//! caught in front of sharp edges that push it along, and such a solution loses up to a third of
//! the force.
//!
//! The crate does not depend on the emulated bench, on recordings or on the twin: a surrogate needs
//! nothing but the sensor's description.

mod draw;
mod out_of_distribution;
mod press;
mod random_mesh;

pub use out_of_distribution::OodKind;
pub use press::{FemPressError, FemPresses};
pub use random_mesh::test_surfaces;
