//! Errors of a twin and of the baselines, and the repeatability of measured presses.

mod baseline;
mod evaluate;
mod kernel;
pub(crate) mod metric;
mod recalibrate;
mod repeatability;

pub(crate) use baseline::StaticPolynomial;
pub use evaluate::{Baselines, Evaluation, PressEvaluation, evaluate};
pub(crate) use evaluate::{predict_some, score_some};
pub(crate) use kernel::Kernel;
pub(crate) use metric::score;
pub use metric::{Errors, Mean, Scale, Score};
pub use recalibrate::{Recalibration, recalibrate};
pub use repeatability::{Repeatability, repeatability};
