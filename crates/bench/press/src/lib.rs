//! Carries out a press protocol on a bench.
//!
//! [`Motion`] turns one planned press into servo poses: travel above the gel, a slow approach until first touch, the depth counted from
//! there, hold, and return. [`Streams`] hears all devices, each on a thread of its own, and gives every message a time of one bench clock.
//! [`Runner`] carries out press after press. In each servo period, what was heard goes to the log and to the
//! [`Supervisor`](twintac_rig::Supervisor) first, and a pose is sent only if the supervisor allows it. There is no runner without checked
//! limits: [`Runner::new`] refuses settings that make no sense, and a real bench whose devices may be silent for too long.
//! Each press has a log of its own, so that a run that was stopped continues with the first press that is not done.
//! [`dry_run`] says what would be done, and how long it would take.

mod arm;
mod audit;
mod dry_run;
mod error;
mod folder;
mod journal;
mod motion;
mod operator;
mod placement;
mod press;
mod rest;
mod runner;
mod safety;
mod settings;
mod streams;
mod touch;

pub use arm::Arm;
pub use dry_run::{DryRun, PlannedPose, PlannedPress, dry_run};
pub use error::PressError;
pub use folder::{check_folder, done_logs};
pub use motion::{Motion, Phase};
pub use operator::{Mounting, Operator};
pub use placement::Placement;
pub use runner::{Bench, RunSummary, Runner};
pub use safety::sensor_limits;
pub use settings::{Devices, PressSettings};
pub use streams::{Heard, Source, StreamEvent, Streams};
