//! What is unknown about a bench, fitted to training presses: the tip's radius, the height at which it touches, the true stiffness of the gel.

mod bench_estimate;
mod estimate;
mod learned;
mod places;
mod port_correction;
mod problem;
mod search;
mod simulated;
mod smooth_factor;
mod widths;

pub use bench_estimate::{BenchEstimate, BenchSettings, PortEstimate};
pub use estimate::Estimate;
pub(crate) use learned::LearnedBench;
pub(crate) use places::deepest_pose;
pub use places::{PlaceSettings, Places};
pub use port_correction::PortCorrection;
pub(crate) use problem::radius_weights;
pub use search::{fit_bench, refine_bench};
pub(crate) use search::{fit_radius, in_order};
pub use simulated::features;
pub(crate) use simulated::{curves, features_along};
pub use smooth_factor::SmoothFactor;
