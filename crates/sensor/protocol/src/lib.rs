//! The press protocol: which indenter presses, where, how deep and how fast.
//!
//! Input is a TOML file and a [`Target`]: the names of a sensor's indenters, and its taxels'
//! positions. Output is a list of planned presses. Lengths are in mm, speeds in mm/s, times in s,
//! forces in N, angles in radians.
//!
//! - [`Protocol`]: presses to a depth ([`Part`]), and weights put on the gel ([`Load`]).
//!   [`Protocol::plan`] turns it into [`PressPlan`]s, and [`Protocol::loads`] into [`LoadPlan`]s.
//! - [`PressPath`]: one indenter moves through given poses and forces.
//!
//! # How it works
//!
//! A [`Part`] has a list of locations ([`Places`]): a grid, random locations, or locations above
//! taxels. The whole list is pressed with each indenter, as often as the part repeats it. Depth,
//! speed, hold, yaw (`yaw_rad`) and tilt are a number, a range or a choice ([`Range`]). Random
//! values of a press depend only on the seed and on the press's name, so a press stays the same
//! when other presses are added or left out. [`PressPlan::trajectory`] gives depth over time,
//! [`LoadPlan::course`] force over time, and [`PressPath::frames`] poses over time.
//!
//! Every error in a file names file, line and field.
//!
//! The crate does not depend on what carries a press out: robot, emulator and simulation use the
//! same plans.

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
