//! Training presses and test presses for the surrogate of a gel (`twintac-fast`): random presses of
//! a sensor's gel, solved by finite elements (FEM).
//!
//! A [`Teacher`] takes a sensor's description and the locations of the gel's base at which the
//! pressure is evaluated, mm. It returns one press for each seed and number, as a `Lesson` of
//! `twintac-fast`: frames with the indenter's pose, force, N, torque, N mm, and the pressure at
//! each location, kPa. The same seed and number give the same press. All presses are `simulated`.
//!
//! - [`Teacher::lesson`]: a training press. [`Teacher::own_lesson`]: one with an indenter of the
//!   sensor.
//! - [`Teacher::exam`], [`Teacher::slide`], [`Teacher::own_exam`]: test presses, of shapes that are
//!   not trained on, sliding, or with an indenter of the sensor.
//! - [`Teacher::strange`]: an out-of-distribution (OOD) press of a given kind ([`Strange`]), to
//!   test the OOD score.
//! - [`exam_surfaces`]: the random meshes that test presses use.
//!
//! # How it works
//!
//! ```text
//! draw     which shape, where, how deep, on how fine a mesh
//! strange  the same for OOD presses
//! boulder  random meshes: closed surfaces with bumps
//! press    the FEM solution of a press, frame by frame
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

mod boulder;
mod draw;
mod press;
mod strange;

pub use boulder::exam_surfaces;
pub use press::{TeachError, Teacher};
pub use strange::Strange;
