//! The clients of a real bench: robot arm, force/torque sensor, other sources of wrenches, and the safety supervisor.
//!
//! Each device has three parts: a codec without input and output, which turns bytes into values and values into bytes and which
//! emulators use as well; the state that must be kept between messages; and a thin transport over `std::net`. The [`Supervisor`] has no input
//! and output either: it is told what the devices say and when, and it decides in each servo period whether the next pose may be sent. NaN
//! counts as beyond every limit.
//!
//! Lengths are in mm, forces in N, torques in N mm, angles in radians, times in seconds of the [`BenchClock`].

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
