//! Searches and fits that know nothing of gels.

mod golden_section;
mod least_absolute_deviations;

pub(crate) use golden_section::minimize;
pub(crate) use least_absolute_deviations::fit_nonnegative;
