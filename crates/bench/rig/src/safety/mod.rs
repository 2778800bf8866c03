//! The safety supervisor: decides in each servo period whether the next pose may be sent.

mod cause;
mod limits;
mod retreat;
mod speed;
mod supervisor;
mod watchdog;

pub use cause::Cause;
pub use limits::{Limits, Retreat, SensorLimits, Setup, Workspace};
pub use supervisor::{Decision, Observation, Start, Supervisor};
pub use watchdog::StreamId;
