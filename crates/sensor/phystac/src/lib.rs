#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod asynch;
mod blocking;
mod budget;
mod channels;
mod clock;
mod conversion;
mod error;
mod fault;
mod frame;
mod health;
pub mod recovery;
mod register;
mod scale;
mod settings;

pub use blocking::{Cps135b, PhysTac, Tca9548a};
pub use budget::Budget;
pub use channels::{Channels, SwitchAddress, Wiring};
pub use clock::Clock;
pub use conversion::{Counts, Sample, Transfer};
pub use error::Error;
pub use fault::Fault;
pub use frame::Frame;
pub use health::{Drift, Health, Thresholds};
pub use register::Oversampling;
pub use scale::{FreeAir, SCALES_PER_PA, ScaleError, ScaleHint, scale_hint};
pub use settings::{Patience, Settings};
