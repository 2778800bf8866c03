//! A gel's material, fitted to measured presses.
//!
//! [`fit`] finds the constants of a gel's material, and what a bench leaves open (where the surface is, how a load cell or a taxel is scaled),
//! by least squares between measured [`Curve`]s and simulated ones. The derivatives come from the solver
//! ([`twintac_softbody::Direction`]): exact, and without a step to choose. A [`Fit`] says how well each unknown is known, and which ones the
//! data do not tell.

mod constants;
mod curve;
mod error;
mod fit;
mod frames;
mod least_squares;
mod matrix;
mod parameter;
mod problem;
mod scale;
mod statistics;
mod unknown;

pub use curve::{Curve, Quantity, Signal};
pub use error::CalibrateError;
pub use fit::{Correlation, Fit, FittedSignal, FittedUnknown, fit};
pub use parameter::Parameter;
pub use problem::FitSettings;
pub use twintac_softbody::{Material, Model, PronyTerm};
