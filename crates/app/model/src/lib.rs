//! A trained twin in use: evaluation on other recordings, prediction, contact estimation,
//! adaptation, and sensor variation.
//!
//! All functions start from a model folder that a run has made. Readings are in kPa above zero,
//! locations and depths in mm, forces in N, times in s.
//!
//! - [`evaluate_elsewhere`] evaluates a twin on other recordings of its sensor and returns an
//!   [`UnseenEvaluation`].
//! - A [`Predictor`] predicts the readings along a path or a protocol ([`Predicted`]), with 90 %
//!   intervals and an OOD score where the model has them.
//! - A [`Locator`] estimates from readings where and how deep the gel is touched, and by which
//!   indenter ([`Located`]); a [`LocatorTracker`] does it frame by frame.
//! - [`adapt_model`] adapts a twin to another sensor from a few presses.
//! - [`find_variation`] estimates how far sensors of a kind vary (gains, positions, contact
//!   heights, read-out), for simulated imperfect sensors.
//!
//! # How it works
//!
//! - Unseen presses: the model keeps a checksum of every press that it was trained on
//!   ([`press_checksum`]: times and readings, not names or formats). Such presses are refused in
//!   evaluation and adaptation, and marked in contact estimation. For a file that the model has not
//!   seen, the contact height is fitted to its first presses, at most 0.3 mm; these are not scored.
//! - Prediction along a path solves the gel frame by frame, sliding and tilting included, and steps
//!   the twin with the pressures at the ports. Prediction of a protocol reads tables over depth.
//!   The FEM solution is elastic, as in the tables of the training: the twin has learned the
//!   behaviour over time.
//! - Contact estimation: the readings' viscoelastic part is removed, frame by frame; what remains
//!   depends on the present press alone. It is compared with a table of the twin's elastic readings
//!   at locations within 1.5 gel heights of the taxels (nodes 0.5 mm apart, 0.05 mm in depth), by
//!   the estimator of `crates/twin/inverse`. While nothing touches, the zero follows the sensor
//!   within 1 s.
//! - Adaptation fits gains, contact heights, stiffness, static nonlinearity and relaxation to the
//!   new presses, with regularization towards the values of the original twin
//!   (`crates/twin/digitac`). [`NewGel`] holds the simulated locations of the new sensor's presses.
//!
//! The crate reads no environment variable and no argument, prints nothing, and does not depend on
//! `crates/app/run`.

mod adapt;
mod figures;
mod gel;
mod locate;
mod new_gel;
mod predict;
mod press_checksum;
mod taxels;
mod temperature;
mod unseen;
mod variation;

pub use adapt::{AdaptationPlan, AdaptedModel, adapt_model};
pub use figures::{BaselineFigures, Figures, TwinFigures, names};
pub use gel::{gel_like, gel_of};
pub use locate::{Located, LocatedFrame, LocatedPress, LocationErrors, Locator, LocatorTracker};
pub use new_gel::NewGel;
pub use predict::{Predicted, Predictor};
pub use press_checksum::press_checksum;
pub use taxels::{left_out, ports_mm, taxels};
pub use temperature::compensate;
pub use unseen::{UnseenEvaluation, evaluate_elsewhere};
pub use variation::{FoundVariation, VariationSources, find_variation, sensor_of_model};
