//! Clients of the devices of a real test setup (robot arm, force/torque sensor) and the safety
//! supervisor.
//!
//! The clients turn the bytes of the devices into poses, wrenches and reports, and commands into
//! bytes. The supervisor takes what the devices report and decides in each servo period whether the
//! next pose may be sent.
//!
//! - [`xarm`]: a UFACTORY xArm robot arm, by TCP. [`xarm::Client`] sends commands and servo poses,
//!   [`xarm::ReportReader`] reads reports.
//! - [`netft`]: an ATI Net F/T force/torque sensor. It streams records by UDP and describes its
//!   configuration by HTTP.
//! - [`WrenchSource`]: any source of forces and torques. It is implemented by [`NetFtSource`] (Net
//!   F/T), [`Analog`] (a measuring card with six gauge voltages) and [`Replay`] (a CSV file).
//! - [`Supervisor`]: limits, watchdogs and the latched stop of one press.
//! - [`BenchClock`]: the one clock on which every arrival is stamped.
//!
//! Lengths are in mm, forces in N, torques in N mm, angles in radians, times in seconds of the
//! [`BenchClock`]. Poses ([`TcpPose`]) are poses of the tool centre point (TCP) in the robot's base
//! frame.
//!
//! # How it works
//!
//! **Devices.** Each device has three parts: a codec without input and output, which turns bytes
//! into values and values into bytes (the emulator in `twintac-emulate` uses the same codec in the
//! other direction); the state that is kept between messages, such as incomplete frames and
//! counters of records; and a thin transport over `std::net`. Therefore tests need no hardware.
//!
//! **Bytes from a connection are never trusted.**
//!
//! - Every size has a bound.
//! - A byte stream that lost its framing stays lost: the connection must be opened anew
//!   ([`Splitter`]).
//! - A response names the request that it answers.
//! - Every state bit that a command does not tolerate becomes an error with the name of that state.
//! - Lost data are marked where they are missing.
//!
//! `cargo xtask fuzz` searches for bytes that break these rules. The inputs that it found are in
//! `fuzz/corpus`, and a test runs them.
//!
//! **Servo poses.** The client does not wait for responses to poses. It matches responses to
//! requests by their transaction numbers as they arrive. A missing response counts as silence, like
//! silence of any stream. A stop command is sent before the client waits for anything.
//!
//! **Supervisor.** [`Supervisor`] has no input, no output and no clock: the caller passes in each
//! event with its time. A pose is sent only if the decision is [`Decision::Go`]. The first cause to
//! stop is latched: later causes do not replace it, and no further goal is released. NaN counts as
//! beyond every limit. After a stop the supervisor may release a retreat, a straight way up from
//! the last goal ([`Decision::Retreat`]). It does so only while the force sensor is alive and its
//! force does not rise.
//!
//! **End of the program.** A client that is dropped in servo mode stops its robot. A program that
//! is ended by SIGKILL cannot stop the robot: the robot then holds its last pose.
//!
//! **Time.** Every arrival gets a [`Stamp`]: the time of the one bench clock, beside the time of
//! the source's own clock, which is never corrected.
//!
//! # What it does not depend on
//!
//! The crate moves a robot. It therefore depends on no solver, no twin, no emulator, and on no
//! description of the sensor or of what is pressed.

mod clock;
mod error;
mod pose;
mod safety;
mod splitter;
mod units;
mod wrench;

pub mod netft;
pub mod xarm;

pub use clock::{BenchClock, Stamp};
pub use error::{Device, RigError};
pub use pose::TcpPose;
pub use safety::{
    Cause, Decision, Limits, Observation, Retreat, SensorLimits, Setup, Start, StreamId, Supervisor,
    Workspace,
};
pub use splitter::Splitter;
pub use wrench::{
    Analog, AnalogCalibration, NetFtSource, Replay, VoltageSample, Wrench, WrenchSample, WrenchSource,
};
