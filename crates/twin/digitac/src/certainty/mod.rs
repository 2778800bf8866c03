//! How sure a twin is: a 90 % interval for every reading, and how unlike a contact is to what taught it.
//!
//! The twin is made again several times, each time without some of the presses that taught it (`calibrate`). What it then errs by on these presses says how wide
//! intervals have to be (`spread`): split-conformal prediction (Lei et al., JASA 113, 2018), scaled by what is known before anything is measured. A contact that is
//! unlike what taught (`taught`) widens them, as fast as errors grew on the deepest and the outermost presses when these were left out.

mod calibrate;
mod certain;
mod judge;
mod spread;
mod taught;
#[cfg(test)]
mod tests;

pub use calibrate::{Lessons, calibrate};
pub use certain::{Certainty, PressCertainty};
pub use judge::{CertaintyScore, area_under_curve, score_certainty};
pub use taught::Contact;
pub(crate) use taught::Taught;
