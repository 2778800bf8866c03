//! A microcontroller, emulated: the firmware that boards run, on the emulated bus, in real or in virtual time.
//!
//! What is emulated is the bus with all that is on it (`twintac-emulate`), with faults on demand. What runs is `twintac-firmware`, as on a
//! board: a [`Microcontroller`] takes the bytes that a host sends, and gives those that a board would.
//!
//! ```
//! use phystac::Chip;
//! use twintac_emulate::{Hertz, LabClock};
//! use twintac_microcontroller::{Microcontroller, Setup};
//!
//! let mut board = Microcontroller::new(LabClock::virtual_time(), Hertz::default(), &Setup::of(Chip::Ms5837_02Ba))?;
//! board.hear(b"rate 50\n");
//! let (report, bytes) = board.round();
//! assert!(report.taxels.iter().all(|taxel| taxel.pressure_pa.is_some()));
//! assert!(String::from_utf8_lossy(&bytes).contains("# rate 50\r\n0,"));
//! # Ok::<(), twintac_microcontroller::SetupError>(())
//! ```

mod lab_time;
mod microcontroller;
mod setup;

pub use microcontroller::Microcontroller;
pub use setup::{N_TAXELS, Setup, SetupError};
