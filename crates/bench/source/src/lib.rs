//! Sources of frames of a tactile sensor.
//!
//! A [`TactileSource`] returns one frame after the other:
//!
//! - [`FrameReader`] reads the sensor's chips on an I²C bus.
//! - [`LineSource`] reads a line that a microcontroller writes: a serial port, datagrams, or any
//!   other [`Wire`].
//! - [`ReplaySource`] plays a log (MCAP) again.
//!
//! A [`FrameSource`] reads any of them on a separate thread and never waits for its user. A
//! [`Reading`] has the number of the frame, its time, and for each taxel its state, counts,
//! pressure and temperature. [`ports`] lists the ports of this computer to which a sensor may be
//! connected, and [`listen`] reports what arrives on one of them.
//!
//! Pressures are absolute, in Pa; times are in s of the bench clock; temperatures are in °C.
//!
//! # How it works
//!
//! **I²C bus.** [`power_on`] reads one frame in free air before anything else. It checks that more
//! than half of the taxels that can be read show the pressure of free air. Counts of chips that do
//! not know their own scale become pressures only after a person has confirmed the scale, in the
//! description of the sensor or in [`Known`]. A frame in free air gives a hint for the scale, but a
//! hint alone is not enough. After that each frame is screened: a saturated or frozen taxel keeps
//! its counts and has no pressure.
//!
//! **Line.** A description of the line says how frames are written. If a frame has a time of the
//! microcontroller's clock, this time is converted to the bench clock: the smallest delay between
//! reading and arrival gives the offset of the two clocks.
//!
//! **Thread.** [`FrameSource`] puts frames into a bounded channel. A frame that finds no room is
//! lost and counted ([`Tally`]), and the frame numbers show which frame it was. A sensor is given
//! up after 40 failures in a row, with 50 ms between them, or after 3 s of silence.
//!
//! # What it does not depend on
//!
//! No solver, no twin and no emulator: the crate only reads.

mod bus;
mod error;
mod line;
mod ports;
mod replay;
mod tactile_source;
mod thread;

pub use bus::{
    FrameReader, Known, PowerOn, confirmed_transfer, driver_settings, emulated_scale, full_scale_kpa,
    power_on,
};
#[cfg(target_os = "linux")]
pub use bus::{LinuxBus, LinuxPhysTac, open_linux};
pub use error::SourceError;
pub use line::{LineSource, SerialLine, Wire};
pub use ports::{Port, Sound, listen, ports, sound};
pub use replay::ReplaySource;
pub use tactile_source::{Reading, TactileSource};
pub use thread::{FrameSource, Tally};

/// Most taxels of a sensor that can be read.
pub const TAXELS: usize = twintac_sensor::MOST_TAXELS;

/// A clock that can be moved to another thread. It returns µs since a fixed moment.
pub type BoxedClock = Box<dyn Fn() -> u64 + Send>;
