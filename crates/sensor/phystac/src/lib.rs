#![doc = include_str!("../README.md")]
//!
//! ## How it works
//!
//! Input is a [`Wiring`] (which chip each taxel is, and where) within [`Settings`], an I²C bus, a
//! delay and a [`Clock`]. Output is a [`Frame`]: for each taxel a [`Sample`] or a [`Fault`], and
//! the times of trigger and reads in µs. Pressures are in Pa, temperatures in °C.
//!
//! The protocol is written once, as `async` functions in [`asynch`]; the compiler makes the state
//! machines. On a blocking bus all futures are ready at once, so the blocking drivers ([`PhysTac`],
//! [`Tca9548a`]) poll each future once ([`now`]). The bytes of each chip are encoded and decoded in
//! the chip's own file in `src/chip`. No code there can produce the command that would burn the
//! one-time programmable memory of a CPS135B.
//!
//! - The driver does not rely on a stored state of the switch. It writes the mask before each use.
//!   After an error, or after a future was dropped half-way, the next call starts over: it opens
//!   one channel at a time first, and several at once after that.
//! - An error becomes the fault of one taxel only if the bus works again once that taxel's channel
//!   is closed. A channel that hangs the bus twice in a row stays closed until it is tried again.
//! - Times come from the clock, limits come from counting polls ([`Patience`]): a broken clock
//!   cannot make a call endless.
//! - A barometer is triggered only after its last conversion has ended, and read only after its new
//!   conversion has ended. The samples of a frame therefore belong to the frame's trigger.
//! - A CPS135B that lost power reads as zeros, which count as no sample. A part that failed is
//!   asked before the next trigger. It is left out of that frame if it fails again, because it may
//!   return an old sample.
//! - The driver cannot detect one case: a single part misses a write to several channels, and
//!   answers again right after it.
//! - [`Health`] finds what only many frames or the rated range show: frozen and saturated taxels.
//!   `Screening` in the crate `twintac-live` applies it to everything that is streamed or recorded.
//!
//! ```text
//! asynch/    the driver: frames, the switch, what a failed transaction means
//! blocking/  the same drivers over a blocking bus
//! chip/      the table of chips, one file each with data and driver
//! wiring, settings, channels   what is connected, and where
//! conversion, scale            from counts to pressures
//! frame, fault, taxel_state, error   results and failures
//! health     faults that only many frames show
//! recovery   frees a hung bus with the pins
//! budget     the frame rate that a bus allows
//! ```
//!
//! The crate depends on no other crate of this workspace, and on no files, threads, network or
//! system clock, so that a microcontroller can use it alone.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod asynch;
mod blocking;
mod budget;
mod channels;
mod chip;
mod clock;
mod conversion;
mod error;
mod fault;
mod frame;
mod health;
mod line;
mod patience;
pub mod recovery;
mod scale;
mod settings;
mod taxel_state;
mod taxels;
mod wiring;

pub use blocking::{AtOnce, PhysTac, Tca9548a, now};
pub use budget::Budget;
pub use channels::{Channels, SwitchAddress};
pub use chip::{Chip, ChipData, Speed};
pub use clock::Clock;
pub use conversion::{Counts, Pressure, Sample, Transfer};
pub use error::Error;
pub use fault::Fault;
pub use frame::Frame;
pub use health::{Drift, Health, Thresholds};
pub use patience::Patience;
pub use scale::{FreeAir, SCALES_PER_PA, ScaleError, ScaleHint, scale_hint};
pub use settings::Settings;
pub use taxel_state::TaxelState;
pub use wiring::{Wired, Wiring, WiringError};
