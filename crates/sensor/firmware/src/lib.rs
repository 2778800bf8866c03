//! What the microcontroller of a tactile sensor does, without its pins: `no_std`, no allocation, no unsafe code.
//!
//! A [`Node`] reads all barometers in rounds through [`phystac`], frees a bus that hangs, and says in each [`Report`] what it could not read
//! and why. A [`Writer`] makes lines of text or packets of reports, which `twintac stream --serial` reads with the descriptions in
//! `firmware/lines`. A [`Firmware`] is both, and does what the host asks. A board's program only adds pins, clocks and a port: `firmware/pico2` and
//! `firmware/esp32c3` do.
//!
//! The node is asynchronous, over [`embedded_hal_async`]: while chips convert and bytes go over the bus, the same core serves USB, and a
//! transaction that never ends can be given up. A bus that blocks is one whose futures are ready at once
//! ([`phystac::AtOnce`]).
//!
//! Never run on a board: the tests run it on an emulated bus.

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
