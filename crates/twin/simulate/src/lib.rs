//! A sensor's gel as a finite-element model, meshed for one press and pressed by one of the
//! sensor's indenters.
//!
//! In: a sensor description and [`SimulateSettings`], which together make a [`Gel`]. Out: the force
//! of the indenter (N), and at each taxel the hydrostatic pressure averaged over the port (kPa),
//! its derivatives with respect to the location and the radius of the port (kPa/mm), and the stress
//! feature of the TwinTac paper (kPa/mm). Depths and positions are in mm, times in s.
//!
//! - [`Gel::depth_table`] presses one location to increasing depths and gives a table over depth.
//! - [`Gel::press`] follows a trajectory in time, for materials that relax, and gives a
//!   [`PressHistory`].
//! - [`Gel::follow`] takes an indenter along any path and gives [`FollowedFrame`]s.
//! - [`Gel::state_along`] gives a [`GelState`], which is pressed frame by frame as poses come.
//! - [`Gel::press_with_rates`] also gives the derivatives of a press with respect to constants of
//!   the material.
//!
//! The crate does not depend on recordings, on learning or on the emulated bench: a twin and the
//! emulator share the solver, but neither settings, nor material, nor mesh.
//!
//! # How it works
//!
//! **Tables over depth.** The state of an elastic gel without friction depends on the depth alone,
//! not on what happened before. A location is therefore simulated once, as a table over depth
//! (crate `twintac-depth-table`). Every press at that location is interpolated from the table,
//! whatever its speed and its holds. Force-controlled, static data read the same table by force
//! instead of by depth. With friction, a table holds for loading only; a path ([`Gel::follow`])
//! keeps the history. What real gels and ports do over time is not simulated here: the twin learns
//! it (crate `digitac`).
//!
//! **One mesh for each press.** The mesh is fine under the indenter and mirrored about the
//! indenter's axis. When the location of the press moves, the fine cells move along. Results at
//! neighbouring locations then differ by physics and not by the positions of nodes. A path that
//! slides is meshed finely all along. A punch (an indenter with a rim) is meshed finely at its rim,
//! where its force arises: for tables, which are many, about half as finely as for a path. If the
//! edges of a path's mesh resolve a straight rim, the mesh has a line where the rim begins. By
//! default a path may have about 20,000 nodes ([`SimulateSettings::max_path_nodes`]); in real time
//! on two cores it can have about 7,000.
//!
//! **Elements.** The pressure is linear on a coarse mesh. Displacements are linear on the mesh that
//! results when each coarse tetrahedron is cut into eight (P1-iso-P2/P1), and mostly quadratic in
//! the layer that is bonded, or everywhere for a path of an indenter with a rim. With plain linear
//! tetrahedra, the pressure of a nearly incompressible gel is wrong by a factor of two to five, and
//! this pressure is what a barometer reads. Ports in the bonded surface read the pressure that
//! follows from the forces that hold the gel there; the coarse mesh still has to be fine where
//! pressures are read.
//!
//! **What is rigid.** Chips in the gel are bonded to it. Each wall of a shell around the gel is an
//! obstacle of its own.
//!
//! **Where tables end.** A table or a path that cannot be solved to its end is not an error: it
//! ends at the last converged frame and gives the reason. A table also ends before the force falls
//! below [`FORCE_MAY_FALL_TO`] of its largest value, because there the gel slides off the indenter.
//!
//! ```text
//! gel       a sensor's gel: first touch, mesh, tables over depth, presses in time
//! follow    an indenter along a path; walk: from one frame to the next, by pose or by force
//! state     a gel that is pressed frame by frame
//! rates     a press with its derivatives
//! touch     the pose of first touch, and the radius of the contact
//! rounding  the radii of an indenter's edges and where its flats end: edges and lines of the mesh
//! shell     the rigid walls around a gel
//! readout   pressures at ports, and the stress feature
//! history   the result of a press in time, and where it ends
//! source    a gel as a source of tables over depth
//! ```

mod error;
mod follow;
mod gel;
mod history;
mod rates;
mod readout;
mod rounding;
mod settings;
mod shell;
mod source;
mod state;
mod touch;
mod walk;

pub use error::SimulateError;
pub use follow::{Followed, FollowedFrame};
pub use gel::{Fields, Gel, GelMesh, Keyframe, PressPlace};
pub use history::{FORCE_MAY_FALL_TO, PressHistory};
pub use rates::RatedFrame;
pub use readout::PortReadout;
pub use settings::SimulateSettings;
pub use state::GelState;
