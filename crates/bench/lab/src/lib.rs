//! An emulated bench with physics and imperfections of its own.
//!
//! The lab stands in for a sensor, a robot and a force sensor that nobody has at hand. It knows nothing of the digital twin that is judged
//! against it, and differs from it on purpose: a finer mesh, another material law with a memory, taxels that sit and amplify a little
//! differently from the drawing, noise, quantization, late and jittery clocks, a robot that misses its place. All of that is in a
//! [`Reality`], read from a TOML file. What it records is marked `emulated`.
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
mod port;
mod reality;

pub use error::LabError;
pub use lab::Lab;
pub use live::{LiveGel, LiveTable, Selector};
pub use reality::{ClimateReality, GelReality, ReadoutReality, Reality, Relaxation, RobotReality};
