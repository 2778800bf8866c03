//! Contact of a boundary with rigid shapes that are given by their signed distance: at its nodes,
//! and at quadrature points inside of its triangles.
//!
//! A point with the gap `g` and the multiplier `c`, a depth, adds about `κ (c - g)²/2` to the
//! energy where `g < c`, and is pushed along the outward normal of the shape with about
//! `κ (c - g)`. At the end of every step the multipliers are updated: `c` becomes `c - g`, so that
//! the force is there without any penetration (augmented Lagrangian; Hestenes, J. Optim. Theory
//! Appl. 4, 1969). The penetration that remains comes from the last step alone.
//!
//! In a concave corner of a shape the direction to the nearest side jumps, and no equilibrium can
//! be found. Walls that meet should be given as separate shapes: a node in the corner then touches
//! two.

mod all;
mod away;
mod bend;
mod boundary;
mod clash;
mod friction;
mod pierce;
mod point;
mod rigid_body;
mod room;
mod state;
mod touch;
mod triangle;

pub(crate) use all::for_each_contact;
pub(crate) use boundary::Boundary;
pub(crate) use clash::clash;
pub(crate) use pierce::{PassedThrough, Pulled};
pub(crate) use point::ContactPoint;
pub(crate) use rigid_body::RigidBody;
pub(crate) use state::Contact;
pub(crate) use triangle::BoundaryTriangle;
