//! Carries out a press protocol on a test setup: robot arm, force/torque sensor and tactile sensor,
//! real or emulated.
//!
//! In: checked settings ([`PressSettings`], read from a hardware configuration in `rigs/`), planned
//! presses, and a [`Bench`] with the connected devices. Out: one log for each press in the folder
//! of the run, and a [`RunSummary`]. Lengths are in mm, forces in N, times in s of the bench clock.
//!
//! - [`Motion`] turns one planned press into servo poses: travel above the gel, a slow approach
//!   until first touch, the depth counted from there, hold, and return.
//! - [`Streams`] listens to all devices, each on a separate thread, and gives every message a time
//!   of the one bench clock.
//! - [`Runner`] carries out press after press. Each press has its own log, so a run that was
//!   stopped continues with the first press that is not done.
//! - [`Operator`] is the person who mounts indenters.
//! - [`dry_run`] computes what a run would do, and how long it would take.
//!
//! # How it works
//!
//! ```text
//! streams     every device on a separate thread, stamped on the bench clock; one queue
//! motion      a planned press as servo poses; it has no clock, so a late period never makes a step
//!             larger
//! press       one servo period: what was heard goes to the supervisor first, then to the log; at
//!             most one pose is sent
//! runner      press after press; folder: one log each, and which presses are done; audit: what a
//!             log lacks, found by reading it again
//! ```
//!
//! **Servo loop.** In each servo period everything that was heard goes first to the
//! [`Supervisor`](twintac_rig::Supervisor). A pose is sent only if the supervisor's decision is
//! [`Decision::Go`](twintac_rig::Decision::Go). In the period in which a cause to stop appears, no
//! pose is sent, and the robot holds its last pose. Then the robot moves back as long as that is
//! safe, and is stopped. A person must enable it again. If a way back could not be supervised, the
//! robot is stopped in the period of the cause. If a robot does not confirm its stop,
//! [`RunSummary::is_stop_confirmed`] is false, and `crates/app/station` sends the stop over a
//! second connection.
//!
//! **Limits.** The limits of force, depth, position and speed belong to this crate. No caller can
//! press without limits that were checked against the sensor's own: [`Runner::new`] refuses
//! settings that are not valid, and a real setup whose devices may be silent for too long.
//!
//! **Indenters.** An [`Operator`] mounts indenters. It is asked again and again, so that the
//! devices are heard and Ctrl-C works meanwhile. No answer means that no indenter is mounted.
//!
//! **Start of a press.** A press begins with the indenter above the gel and without force.
//! Otherwise an existing load would be subtracted as a tare, or be taken for the first touch. The
//! depth counts from the first touch, but the depth limit counts from the described surface: a
//! touch that is detected late does not lead to a deeper press.
//!
//! **Real and emulated.** `twintac record` connects this crate to the devices that the settings
//! name, or to the devices of `twintac-emulate` with the emulated gel (`twintac-lab`) behind them.
//! Only the provenance in the log differs. Tables of the emulated gel are computed before the robot
//! moves, so nothing is solved in real time.
//!
//! **Interruption.** A press that was stopped is recorded to its end. Its log is renamed and kept,
//! and the next run does the press again.
//!
//! # What it does not depend on
//!
//! The crate moves a robot. It therefore depends on no solver, no twin and no emulator.

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
