//! Finite-element solver, at finite strain and quasi-static, for a soft body that is pressed by
//! rigid shapes.
//!
//! Input: a mesh (`twintac_mesh::TetMesh`), a [`Material`], [`SolverSettings`], and poses of an
//! indenter, given by its signed distance. Output: for each step a [`Frame`] with forces and
//! torques, and the displacements, pressures and stresses of the nodes. Lengths are in mm, forces
//! in N and times in s. Stresses are in kPa at the interface, and in MPa = N/mm² inside of the
//! crate.
//!
//! - A [`SoftBody`] is built once from a mesh, a material and settings, and shared by many presses.
//! - Each press has a [`State`]. [`SoftBody::advance`] takes it from one pose of the indenter to
//!   the next and returns a [`Frame`]; [`SoftBody::advance_to_force`] presses with a given force
//!   ([`Push`]).
//! - [`SoftBody::pressure_kpa`], [`SoftBody::von_mises_kpa`] and [`SoftBody::bonded_forces_n`]
//!   evaluate a state.
//! - [`SoftBody::rest_with_sensitivities`] starts a press whose results are differentiated along
//!   [`Direction`]s.
//!
//! # How it works
//!
//! The tetrahedra have a linear pressure, and displacements of twice the resolution, so that nearly
//! incompressible gels do not lock and their pressure is accurate: each tetrahedron of the mesh is
//! cut into eight, on which the displacements are linear. In the layer that is bonded, and on
//! request everywhere, they are mostly quadratic ([`Element`]).
//!
//! ```text
//! build        makes a body from a mesh: numbering, elements, boundary, linear systems
//! advance/     a motion, in sub-steps; each starts where the last motion would lead
//! newton/      the minimum of the energy: evaluation, assembly, direction, line search,
//!              iteration, one file each
//! element/     quadrature points and shape functions; energy and forces (f64) and
//!              tangents (f32) of eight tetrahedra at a time
//! relaxation   the history variables of a viscoelastic material
//! contact/     signed distances at nodes and at quadrature points inside of triangles;
//!              multipliers, so that the contact stiffness does not change the result;
//!              friction; contact between rigid shapes
//! push         the position at which the indenter presses with a given force
//! linear/      conjugate gradients; Gauss-Seidel sweeps on the fine mesh, and between
//!              them triangular factors of the system on the coarse mesh
//! sensitivity/ how a press changes with its material
//! results      pressure, stress and reaction forces of a state
//! bonded       the pressure where the body is bonded, from the forces that hold it
//! ```
//!
//! ## Linear systems
//!
//! - Pressures are not unknowns of the linear system. At each node of the coarse mesh, `p = -κ g/m`
//!   holds, where `κ` is the modulus of the averaged volume change (for an isochoric law the bulk
//!   modulus), `g` the volume change of the node's surroundings and `m` their volume. The remaining
//!   system, `A + B D Bᵀ`, is positive definite, so that conjugate gradients can be used. The
//!   system on the coarse mesh keeps the pressures and has four unknowns for each node: its factors
//!   do not suffer from incompressibility, and the number of negative pivots shows whether the
//!   energy is convex.
//! - [`LinearSolver::Direct`] factorizes the whole system in double precision for every direction.
//!   It is the reference for the rest.
//! - Most of the time is spent reading matrices. An iteration reads the fine matrix twice, not
//!   three times: the next sweep also computes the product that conjugate gradients need
//!   (`linear/sweep`). The coarse factors are stored with sixteen bits for each number
//!   (`linear/factors`).
//! - Coarse factors are kept as long as conjugate gradients converge fast with them. Often these
//!   are the factors of the body at rest, which all of its presses share. The tangent matrix is
//!   kept, in this step and the next, as long as its directions lead to good steps.
//! - The tangent is taken at pressures that are updated as in a mixed formulation. The pressures
//!   that follow from volumes far from equilibrium are large and wrong.
//! - Threads do not share nodes: nodes are numbered as two halves that share no coarse node, and a
//!   separator between them. The bits of the results are the same for any number of threads.
//!
//! ## Contact
//!
//! - Contact is an augmented Lagrangian. Neighbouring nodes on the crest of a shape can alternately
//!   slip off it, so that updates of their multipliers do not converge: contacts that stay deep are
//!   made stiffer, and return to the usual stiffness with the next step.
//! - In a concave corner of a shape the direction to the nearest side jumps, and there is no
//!   equilibrium. Therefore the walls of a shell, the parts of a union and the bodies of a surface
//!   are separate contacts, and the concave corners of an X are rounded.
//! - With contact at nodes alone, a triangle could cut off the rim of a punch. Where the normals at
//!   the corners of a triangle differ by more than the rounding of the punch explains, quadrature
//!   points inside of the triangle are pushed out as well, by a penalty; they have no multipliers.
//!   The depth of an arc's chord is not penalized, so smooth shapes are not affected. The roundness
//!   of the arc is estimated from normals along the sides of the triangle: a long triangle across a
//!   sharp rim must not count as a wide arc.
//! - Triangles beside those at a rim have such points too. Otherwise a row of nodes slides around
//!   the rim within a step and leaves triangles across it that nothing holds, and a fifth of the
//!   force is missing at that equilibrium. The points are chosen when a step begins, and again at
//!   its equilibrium, at most three times, until they are in the same triangles. Otherwise a long
//!   step presses 2 % too hard, and its force falls while the shape is held.
//! - Friction grows to its limit without a kink, as `μ f (2t - t²)` over a short slip, with the
//!   coefficient `μ`, the normal force `f` and the fraction `t` of that slip. With a kink, Newton's
//!   method alternates between nodes that stick and nodes that slip, and often does not converge
//!   where the gel is nearly incompressible.
//! - A point only knows the nearest face of a shape. The forces can therefore balance although a
//!   thin wall has gone through a triangle or past a node. `contact/pierce` checks each solution
//!   afterwards: if a wall reaches through a triangle, or a node is on the other side, the step
//!   fails as if it had not converged. Smaller steps are tried first; if they fail as well, it is
//!   an error.
//!
//! ## Sensitivities
//!
//! `sensitivity` differentiates each equilibrium with the same tangent, along any constant of a
//! material or along the position of the indenter. It also differentiates what one step hands to
//! the next: the history variables and the multipliers. The unbalanced force that a constant causes
//! is a difference between two materials, so a law needs no code for its own constants.
//!
//! This crate knows no sensors and no files: it depends on the crates of materials, meshes and
//! shapes only.

#![allow(clippy::needless_range_loop)] // matrices are written with indices

mod advance;
mod body;
mod bonded;
mod build;
mod clock;
mod contact;
mod derivatives;
mod element;
mod error;
mod frame;
mod linear;
mod load;
mod newton;
mod nodal;
mod parallel;
mod push;
mod relaxation;
mod results;
mod sensitivity;
mod settings;
mod state;

pub use body::SoftBody;
pub use derivatives::DerivativeErrors;
pub use element::Element;
pub use error::{Blocker, SoftBodyError, SolveError};
pub use frame::{Cost, Frame};
pub use push::Push;
pub use sensitivity::Direction;
pub use settings::{LinearSolver, SolverSettings};
pub use state::State;
pub use twintac_material::{Material, Model, PronyTerm};

use twintac_material::wide;

/// kPa to MPa, the unit of stress inside of this crate.
pub(crate) const MPA_PER_KPA: f64 = 1e-3;
