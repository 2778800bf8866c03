//! The firmware of a tactile sensor's microcontroller, without its pins: `no_std`, no allocation,
//! no unsafe code.
//!
//! Input is an asynchronous I²C bus ([`embedded_hal_async`]) with the sensor's chips
//! ([`NodeSettings`]), a clock, and the bytes that the host sends ([`Command`]). Output is bytes
//! for a serial line: text or packets, with pressures in Pa, temperatures in °C and times in µs.
//!
//! - [`Node`] reads all barometers in rounds with the driver [`phystac`]. It frees a bus that
//!   hangs. Each [`Report`] says which taxels could not be read, and why.
//! - [`Writer`] writes reports as lines of text or as packets ([`Form`]). `twintac stream --serial`
//!   reads them with the descriptions in `firmware/lines`.
//! - [`Firmware`] combines both and executes the host's commands. A board's program only adds pins,
//!   clocks and a port, as `firmware/pico2` and `firmware/esp32c3` do.
//!
//! # How it works
//!
//! The node is asynchronous. While chips convert and bytes go over the bus, the same core serves
//! USB, and a transaction that does not end can be given up. A blocking bus is one whose futures
//! are ready at once ([`phystac::AtOnce`]).
//!
//! A round triggers all chips, waits for their conversions, reads each chip and makes a report. A
//! fault of one taxel is reported with that taxel, and the others have their readings. If the whole
//! round fails, the report says why ([`Trouble`]). If the bus hangs, the node calls [`rescue()`],
//! which clocks the bus and resets the switches. Waits between failures in a row grow from 10 ms to
//! 1 s. A value that was not read is never sent as a number.
//!
//! [`LineBudget`] computes how many reports per second a line carries.
//!
//! The crate uses no files, threads or network, and no recording or device of this workspace. It
//! was never run on a board; the tests run it on an emulated bus.

#![no_std]
#![forbid(unsafe_code)]

mod back_off;
mod bounded;
mod budget;
mod buffer;
mod cobs;
mod command;
mod csv;
mod firmware;
mod node;
mod pace;
mod packet;
mod remarks;
mod report;
mod rescue;
mod settings;
mod trouble;
mod writer;

pub use budget::LineBudget;
pub use buffer::Buffer;
pub use command::{Command, CommandError, Rate};
pub use firmware::{Answer, Firmware};
pub use node::Node;
pub use report::{Report, Taxel};
pub use rescue::rescue;
pub use settings::{NodeSettings, chip_named, scale_of};
pub use trouble::Trouble;
pub use writer::{Form, Writer, longest};
