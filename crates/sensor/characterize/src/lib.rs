//! What a sensor does, from recorded presses, or from readings alone: noise, detection limit, sensitivity, linearity, range, hysteresis, rise time, creep, cross-talk,
//! repeatability, zero, drift, the rate of frames, the step of readings and taxels that fail, each by the definition that stands in its file.
//!
//! [`characterize`] picks for each figure the presses that are suited for it, by what they are and not by what they are called: slow ones above a
//! taxel for sensitivity, fast ones for rise time, long ones for creep, weights for the smallest force. What the recordings do not give is
//! a [`Finding::NotGiven`] that says why. [`write_pages`] makes the report and the data sheet.

mod characterization;
mod condition;
mod creep;
mod cross_talk;
mod detection;
mod drift;
mod error;
mod finding;
mod hysteresis;
mod noise;
mod options;
mod page;
mod phases;
mod quantum;
mod range;
mod recorded;
mod repeatability;
mod rest;
mod rise;
mod sensitivity;
mod statistics;
#[cfg(test)]
mod synthetic;
mod timing;
mod untouched;
mod zero;

pub use characterization::{Characterization, characterize};
pub use condition::{Condition, Fate};
pub use creep::Creep;
pub use cross_talk::CrossTalk;
pub use detection::{DetectionLimit, KnownStep};
pub use drift::{TemperatureDrift, ZeroReturn};
pub use error::CharacterizeError;
pub use finding::Finding;
pub use hysteresis::Hysteresis;
pub use noise::Noise;
pub use options::CharacterizeOptions;
pub use page::{report, write_pages};
pub use quantum::Quantum;
pub use range::CoveredRange;
pub use repeatability::Repeatability;
pub use rise::RiseTime;
pub use sensitivity::{MeanSensitivity, Sensitivity};
pub use timing::FrameTiming;
pub use zero::ZeroOverTime;
