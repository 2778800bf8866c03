#![doc = include_str!("../README.md")]
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
