//! The press protocol: which indenter, where, how deep, how fast.
//!
//! A protocol is a TOML file that people write; [`Protocol::plan`] turns it into presses. What is drawn at random in a press depends on the seed
//! and on the press's name only. A [`Load`] puts weights on the gel instead. A [`PressPath`] moves one indenter through given poses and forces.

mod load;
mod part;
mod path;
mod places;
mod plan;
mod protocol;
mod range;
mod target;

pub use load::{Load, LoadPlan};
pub use part::Part;
pub use path::{PathError, PathFrame, Point, PressPath, Waypoint, Zero};
pub use places::{Area, Places};
pub use plan::PressPlan;
pub use protocol::Protocol;
pub use range::Range;
pub use target::{AllWord, Indenters, PlanError, Target};
