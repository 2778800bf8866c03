//! Characterization of a sensor from recorded presses or from readings alone: noise, detection
//! limit, sensitivity, linearity, range, hysteresis, rise time, creep, cross-talk, repeatability,
//! zero, drift, frame rate, resolution, and taxels that fail.
//!
//! Input is a `Recording` of presses, or `Frames` outside of presses in which nothing touches the
//! sensor, or both (types of the crate `twintac-recording`), and the sensor's description. Output
//! is a [`Characterization`]: forces in N, pressures in kPa, times in s, temperatures in °C.
//! [`write_pages`] writes it as a report and a data sheet.
//!
//! # How it works
//!
//! [`characterize`] selects suitable presses for each figure by their properties, not by their
//! names: slow presses above a taxel for sensitivity, fast ones for rise time, long ones for creep,
//! known weights for the smallest force. [`CharacterizeOptions`] sets what counts as above, slow,
//! fast and long.
//!
//! Each press is cut into rest, loading, hold, unloading and rest (module `phases`). The cuts
//! follow the depth, or for weights, the force.
//!
//! Each figure is a file with its definition at the top: a function of presses that returns
//! [`Finding::Found`], or [`Finding::NotGiven`] with the reason. No figure is estimated from
//! presses that do not show it.
//!
//! - Drift with temperature is computed from frames outside of presses, that is from logs and
//!   tables of frames; presses are not used for it. The coefficients can be saved for compensating
//!   readings ([`Characterization::compensation`]).
//! - The frames in which nothing touches (module `rest`) are found from the force. If no force was
//!   measured, they are found from the pose: noise, zeros, resolution, frame rate and failing
//!   taxels therefore need no force.
//!
//! The crate depends on no solver, no device and no emulator: recorded readings and the sensor's
//! description are all that it uses.

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
