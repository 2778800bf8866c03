//! A trained twin in use: [`evaluate_elsewhere`] judges it on other recordings, a [`Predictor`] takes it along a path or a protocol, a [`Locator`] finds
//! what touches by it, [`adapt_model`] adapts it to another sensor, [`find_imperfection`] finds how far sensors of its kind are from perfect.

mod adapt;
mod figures;
mod gel;
mod imperfection;
mod locate;
mod new_gel;
mod predict;
mod press_checksum;
mod taxels;
mod temperature;
mod unseen;

pub use adapt::{AdaptationPlan, AdaptedModel, adapt_model};
pub use figures::{BaselineFigures, Figures, TwinFigures, names};
pub use gel::{gel_like, gel_of};
pub use imperfection::{FoundImperfection, ImperfectionSources, find_imperfection, sensor_of_model};
pub use locate::{Located, LocatedFrame, LocatedPress, LocationErrors, Locator, LocatorTracker};
pub use new_gel::NewGel;
pub use predict::{Predicted, Predictor};
pub use press_checksum::press_checksum;
pub use taxels::{left_out, ports_mm, taxels};
pub use temperature::compensate;
pub use unseen::{UnseenEvaluation, evaluate_elsewhere};
