//! The errors of a twin, those of the baselines it is compared with, and how well measured presses repeat.

mod baseline;
mod evaluate;
pub(crate) mod metric;
mod recalibrate;
mod repeatability;

pub use baseline::StaticPolynomial;
pub use evaluate::{Evaluation, PressEvaluation, evaluate};
pub use metric::{Errors, Mean, Scale, Score, score};
pub use recalibrate::{Recalibration, recalibrate};
pub use repeatability::{Repeatability, repeatability};
