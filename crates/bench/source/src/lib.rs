//! Where frames of a tactile sensor come from.
//!
//! A [`TactileSource`] gives one frame after the other, from an I²C bus ([`FrameReader`]), from a line that a microcontroller writes
//! ([`LineSource`]: a serial port, datagrams, a pipe), or from a log that is played again ([`ReplaySource`]). A [`FrameSource`] reads any of
//! them on a thread of its own and waits for nobody.
//!
//! Pressures are in Pa, absolute; times in s of the bench's clock.

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

/// Taxels that a sensor can have that is read here.
pub const TAXELS: usize = twintac_sensor::MOST_TAXELS;

/// A clock that may go to another thread: µs since a moment that stays the same.
pub type BoxedClock = Box<dyn Fn() -> u64 + Send>;
