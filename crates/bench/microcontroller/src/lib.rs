//! An emulated microcontroller: the firmware of real boards, run on an emulated I²C bus, in real or
//! in virtual time.
//!
//! The bus with all chips on it is emulated (`twintac-emulate`), with faults on demand. The
//! firmware is `twintac-firmware`, the same code as on a board. A [`Microcontroller`] takes the
//! bytes that a host sends ([`Microcontroller::hear`]), and returns the bytes that a board would
//! send, together with the readings of its taxels in Pa ([`Microcontroller::round`]). [`Setup`]
//! describes the board, its faults and the options with which the firmware is built.
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
//!
//! # How it works
//!
//! The emulated clock (`LabClock`) is the board's clock: the board was switched on at its zero.
//! Each call of [`Microcontroller::round`] waits until the next round is due, reads all chips and
//! encodes the result as the firmware does: as text lines or packets. The tool in front of the
//! sensor rests at [`Setup::tool_mm`], and a `Physics` of the caller gives the pressures there; a
//! physics may move its indenter by itself over time. If the bus hangs, the firmware frees it with
//! clocks, and with the switch's RESET line if that is wired.
//!
//! The crate depends on no solver, no twin, no emulated gel and no recording.

mod lab_time;
mod microcontroller;
mod setup;

pub use microcontroller::Microcontroller;
pub use setup::{N_TAXELS, Setup, SetupError};
