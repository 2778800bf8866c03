//! Emulator of the devices of a test setup at the level of their protocols, with faults on demand.
//!
//! The emulated devices are a sensor's barometers behind their I²C switches ([`i2c`]), a robot arm
//! that listens on TCP ([`robot`]), and a force/torque sensor that streams by UDP ([`force`]). They
//! share one [`LabClock`] and one [`Workcell`]. The workcell moves the robot's tool and asks a
//! [`Physics`], which the caller provides, for the pressures and the wrench at the tool's pose.
//! [`EmulatedBench`] connects all of them. [`Hertz`] is a physics in closed form for tests. A
//! [`ScheduledFault`] says what goes wrong, and when.
//!
//! What devices report depends only on times of the emulator's clock and on seeds, and not on how
//! often or in which order they are read. In virtual time the whole setup therefore repeats itself
//! bit for bit, if requests come at the same times of that clock.
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
//! Lengths are in mm, forces in N, torques in N mm, pressures in kPa (absolute, as barometers read
//! them), angles in radians.
//!
//! # How it works
//!
//! - The emulation follows the protocol and not the driver: registers and frames are made from the
//!   documents of the manufacturers. The drivers, the clients and the robot manufacturer's own
//!   client (`crates/bench/emulate/tests/manufacturers_client.py`) are tested against it.
//! - The core of each device has no input and output: bytes go in, bytes come out, with the time of
//!   its [`LabClock`]. The sockets and threads around it are thin, and end when the value that owns
//!   them is dropped.
//! - [`Workcell`] moves the arm and asks the physics in equal time steps on a fixed grid, each step
//!   once and in order. A physics may therefore depend on its history. Devices read between the
//!   steps by linear interpolation. What a device reads does not depend on who else has read.
//! - In virtual time the clock stands still until somebody waits. The I²C bus waits for each of its
//!   clock periods. In real time the same calls take as long as they state.
//! - A [`ScheduledFault`] is one entry of a file: what goes wrong, from when on (a time, or an
//!   event on its connection), and for how long.
//!
//! # What it does not depend on
//!
//! No solver, no twin and not the emulated gel (`twintac-lab`): what the sensors feel comes through
//! the trait [`Physics`].

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
