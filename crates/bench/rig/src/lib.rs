//! The clients of a real bench: robot arm, force/torque sensor, wrench sources and the safety supervisor.
//!
//! Each device is a codec without input and output (bytes in, values out, and back: an emulator uses the same), what
//! must be remembered between messages, and a thin transport over `std::net`. The [`Supervisor`] is pure as well: it is
//! told what the devices say and when, and decides in each servo period whether the next pose may go out.
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
