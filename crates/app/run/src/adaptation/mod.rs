//! A model adapted to another sensor of the same kind from a few presses, and how its error falls with their number.

mod curve;
mod model;
mod new_gel;

pub use curve::{AdaptationCurve, AdaptationPoint, CurvePlan, adaptation_curve};
pub use model::{AdaptationPlan, AdaptedModel, adapt_model};
