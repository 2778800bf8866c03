//! A sensor's gel, meshed and pressed by one of its indenters.
//!
//! [`Gel`] turns a sensor description into presses: [`Gel::sweep`] tabulates one place over depth, [`Gel::press`] follows a
//! trajectory in time (for materials that remember). A [`Lattice`] of sweeps answers for every place between its nodes.
//!
//! Each press gets a mesh of its own, fine under the indenter and mirrored about its axis: moving the press place moves the fine cells
//! along, so that neighbouring places differ by physics and not by where nodes happen to lie.

mod error;
mod follow;
mod gel;
mod lattice;
mod pchip;
mod rates;
mod readout;
mod rounding;
mod settings;
mod shell;
mod sweep;
mod touch;

pub use error::SimulateError;
pub use follow::{Followed, FollowedFrame};
pub use gel::{Fields, Gel, GelMesh, Keyframe, PressPlace};
pub use lattice::Lattice;
pub use pchip::Pchip;
pub use rates::RatedFrame;
pub use readout::PortReadout;
pub use settings::SimulateSettings;
pub use sweep::{Honesty, Sweep, SweepFrame};
