//! An emulated bench with physics and imperfections of its own.
//!
//! The lab takes the place of a sensor, a robot and a force sensor that nobody has at hand. It does not know the digital twin that is judged
//! against it, and differs from it on purpose: a finer mesh, another material law with relaxation, taxels whose places and gains differ
//! a little from the drawing, noise, quantization, clocks with delay and jitter, a robot that misses its place. All of that is in a
//! [`Reality`], read from a TOML file. What the lab records is marked `emulated`.
//!
//! [`Lab::press`] records a planned press at once, [`Lab::load`] a weight put on the gel. [`Lab::live`] is the physics of emulated devices
//! (`twintac-emulate`) while a robot moves.

mod chain;
mod course;
mod error;
mod frames;
mod keyframes;
mod lab;
mod live;
mod load;
mod mounting;
mod port;
mod reality;
mod ways;

pub use error::LabError;
pub use lab::Lab;
pub use live::{LiveGel, LiveTable, Selector};
pub use reality::{
    ClimateReality, GelReality, MountingReality, ReadoutReality, Reality, Relaxation, RobotReality,
};
