//! Fits a gel's material to measured presses, by nonlinear least squares.
//!
//! In: measured presses as [`Curve`]s, each with the shape and the location of its indenter, depth
//! (mm) over time (s), and the measured force (N) or readings of taxels (kPa) as [`Signal`]s; a gel
//! (crate `twintac-simulate`) whose material is the initial guess; and the [`Parameter`]s to find.
//! Out: a [`Fit`] with the material found, a 95 % confidence interval for each unknown, the
//! correlations between unknowns, warnings, and the fitted signals.
//!
//! - [`fit()`] makes the fit, with [`FitSettings`]. The command `twintac calibrate` uses it.
//! - [`Parameter`]: constants of the material by the names that files have for them, Poisson's
//!   ratio, friction, an offset of depth and of force for each curve, and the scale of the force
//!   sensor. Where readings are fitted, each taxel also has a gain.
//!
//! The crate does not depend on files, on recordings, on learning or on the emulated bench: its
//! caller hands in curves and a gel.
//!
//! # How it works
//!
//! Measured curves are compared with simulated ones at the measured samples. About
//! [`FitSettings::most_frames`] frames of each curve are simulated; samples between them are
//! interpolated. Residuals are divided by the largest force of a curve, or by the largest reading
//! of all curves.
//!
//! **Derivatives.** The solver differentiates each equilibrium with its own tangent, exactly and
//! without a step size to choose, along any constant of the material and along the depth of the
//! indenter. The dependence of a material on its constants is a difference between two materials,
//! so a new material law needs no code here: its constants are found by the names of its fields. A
//! press with friction cannot be differentiated. Its forces and pressures are simulated with
//! friction, its derivatives are those of the same press without friction, and the coefficient of
//! friction itself has a difference quotient.
//!
//! **Search.** It is the method of Levenberg and Marquardt within bounds (crate `twintac-fit`).
//! Each unknown is sought on a scale on which a step of one is large: the logarithm for values of
//! one sign, the logit for weights of a Prony series. With friction, the derivatives are inexact
//! and expensive; steps correct them along their way (Broyden's method), also steps that are
//! rejected. The search therefore needs every step, which `twintac-fit` hands over.
//!
//! **Friction matters.** In the experiments of the TwinTac paper on the emulated bench, the gel and
//! its friction are fitted to forces together. When the gel was fitted without friction, it came
//! out too stiff at large strain, and flat shapes were mistaken for each other.
//!
//! **Identifiability.** Confidence intervals are those of the linearized model, and are right if
//! the residuals are independent noise of one variance. Unknowns that the data do not determine get
//! an infinite interval and a warning. Further warnings tell that residuals are correlated or too
//! large, that two unknowns are correlated by more than 0.98, that a value is at a bound of the
//! search, or that the search did not converge.
//!
//! ```text
//! curve          measured presses
//! parameter      what can be fitted; unknown: its range and scale (scale); constants: constants of
//!                a material by name
//! frames         which samples of a press are simulated
//! problem        residuals and their derivatives
//! least_squares  the search
//! statistics     covariance, and which unknowns the data determine
//! fit            the fit and its result
//! ```

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
