//! A sensor's gel, meshed and pressed by one of its indenters.
//!
//! [`Gel`] turns a sensor description into presses: [`Gel::depth_table`] tabulates one place over depth, [`Gel::press`] follows a
//! trajectory in time (for materials that relax), [`Gel::follow`] takes an indenter along any path, and a [`GelState`] is pressed frame by frame as poses
//! come.
//!
//! Each press gets a mesh of its own, fine under the indenter and mirrored about its axis: moving the press place moves the fine cells
//! along, so that results at neighbouring places do not differ by where nodes lie.

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
