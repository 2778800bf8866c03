//! Numerical methods that do not depend on what they are used for: a search in one dimension, and a robust linear fit.

mod golden_section;
mod least_absolute_deviations;

pub(crate) use golden_section::minimize;
pub(crate) use least_absolute_deviations::fit_nonnegative;
