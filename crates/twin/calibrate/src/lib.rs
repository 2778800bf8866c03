//! A gel's material, fitted to measured presses.
//!
//! [`fit`] finds the constants of a gel's material, and unknowns of the bench (the height of the surface, friction, the scale of a load cell or a taxel),
//! by least squares between measured [`Curve`]s and simulated ones. The derivatives come from the solver
//! ([`twintac_softbody::Direction`]): exact, and without a step size to choose, but for the coefficient of friction. A [`Fit`] gives a confidence interval for each unknown, and says which ones the
//! data do not determine.

mod constants;
mod curve;
mod error;
mod fit;
mod frames;
mod least_squares;
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
