//! The devices of a bench, emulated at the level of their protocols, with faults on demand.
//!
//! There are a sensor's barometers behind their I²C switches ([`i2c`]), a robot arm that listens on TCP ([`robot`]), and a force/torque
//! sensor that streams by UDP ([`force`]). They share one [`LabClock`] and one [`Workcell`]. The workcell moves the robot's tool and asks a
//! [`Physics`], which the caller provides, what the sensors feel there. [`EmulatedBench`] connects all of them.
//!
//! What devices report depends only on times of the lab's clock and on seeds, and not on how often or in which order they are asked.
//! In virtual time the whole bench therefore repeats itself bit for bit, if requests come at the same times of that clock.
//!
//! ```
//! use embedded_hal::i2c::I2c;
//! use twintac_emulate::{EmulatedBench, EmulatedBenchSettings, Hertz, LabClock};
//!
//! let clock = LabClock::virtual_time();
//! let bench = EmulatedBench::start(clock.clone(), Hertz::default(), &EmulatedBenchSettings::default())?;
//! println!("robot at {}, force sensor at {}", bench.robot.commands(), bench.force.requests());
//! bench.board.bus().write(0x70, &[0xFF]).unwrap(); // opens all channels
//! assert_eq!(clock.now_us(), 50); // 20 clocks at 400 kHz
//! # Ok::<(), twintac_emulate::EmulateError>(())
//! ```
//!
//! Lengths are in mm, forces in N, torques in N mm, pressures in kPa (absolute, as barometers read them), angles in radians.

mod clock;
mod emulated_bench;
mod error;
mod fault;
mod hertz;
mod mix;
mod physics;
mod schedule;
mod workcell;
mod worker;

pub mod force;
pub mod i2c;
pub mod robot;

pub use clock::LabClock;
pub use emulated_bench::{EmulatedBench, EmulatedBenchSettings};
pub use error::EmulateError;
pub use fault::{FaultKind, Moment, ScheduledFault, check_faults};
pub use hertz::Hertz;
pub use physics::{MOST_TAXELS, Physics, Sensed};
pub use workcell::{Situation, Workcell};
