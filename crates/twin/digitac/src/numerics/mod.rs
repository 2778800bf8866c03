//! Numerical methods that are independent of their use: searches, robust fits, and small linear
//! systems.

mod dot;
mod golden_section;
mod least_absolute_deviations;
mod levenberg_marquardt;
mod median;
mod splines;
mod symmetric;

pub(crate) use dot::dot;
pub(crate) use golden_section::minimize;
pub(crate) use least_absolute_deviations::fit_nonnegative;
pub(crate) use levenberg_marquardt::{Unknown, minimize_robust};
pub(crate) use median::median;
pub(crate) use splines::mirrored_splines;
pub(crate) use symmetric::inverse_symmetric;
