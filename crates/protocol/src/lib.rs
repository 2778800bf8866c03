//! The press protocol: which indenter, where, how deep, how fast.
//!
//! A protocol is a TOML file that people write; [`Protocol::plan`] turns it into presses. What is drawn at
//! random in a press depends on the seed and the press's number alone. A [`PressPath`] takes one indenter through given poses
//! and forces.

mod path;
mod plan;
mod protocol;

pub use path::{PathFrame, Point, PressPath, Waypoint, Zero};
pub use plan::PressPlan;
pub use protocol::{Area, Indenters, Places, PlanError, Protocol, Range};
