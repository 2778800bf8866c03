//! Connects the devices of a test setup (tactile sensor, robot arm, force sensor), real or
//! emulated, and carries presses out on them.
//!
//! [`OpenBench`] is a bench that is switched on: [`OpenBench::connect`] connects real devices,
//! [`OpenBench::emulate`] starts emulated ones on the same protocols. [`OpenBench::press`] carries
//! out planned presses (mm, mm/s, N) and writes one log (MCAP) a press into a folder. [`preview`]
//! shows where and how long presses would move, without a bench. [`read_faults`] reads faults for
//! the emulated bench.
//!
//! # How it works
//!
//! - To connect: the tactile sensor is checked in free air and started, then the force sensor's
//!   stream, then the robot's reports. The robot is enabled last. A real robot's tool settings are
//!   compared with the hardware configuration.
//! - The code above the wires is the same for real and emulated devices: drivers
//!   (`crates/sensor/phystac`, `crates/bench/source`), clients of robot and force sensor
//!   (`crates/bench/rig`), and the supervised loop (`crates/bench/press`). Only the provenance
//!   differs, `real` or `emulated`. The emulated gel answers from tables that are computed before
//!   the robot moves.
//! - A folder of logs belongs to one sensor, bench and placement; [`check_logs`] finds logs of
//!   another. Presses whose logs are complete are not carried out again.
//! - If the robot does not confirm a stop, it is told to stop over a second connection. If that
//!   fails too, the message asks to press the emergency stop.
//! - A dropped [`OpenBench`] stops its devices.
//!
//! The crate reads no environment variable and no argument, prints nothing, and does not depend on
//! `crates/app/run`.

mod lab;
mod open;
mod press;
mod preview;
mod real;

pub use lab::read_faults;
pub use open::OpenBench;
pub use press::{Attended, check_logs};
pub use preview::{Preview, preview};
