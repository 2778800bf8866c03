//! Carries out a press protocol on a bench.
//!
//! [`Motion`] turns one planned press into servo poses: travel above the gel, a slow approach until first touch, depth counted from
//! there, hold, retreat. [`Streams`] hears all devices, each on a thread of its own and stamped on one bench clock. [`Runner`] takes
//! press after press through one loop: what was heard goes to the log and to the [`Supervisor`](twintac_rig::Supervisor) first, and a pose goes
//! out only if that lets it. Each press is a log of its own, so that a run that ended goes on with the first press that is not done.
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
