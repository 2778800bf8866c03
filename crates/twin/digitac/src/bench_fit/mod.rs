//! Setup calibration: the unknowns of a test setup (the radius of the tip, the height at which it
//! touches, the true stiffness of the gel), fitted to training presses.

mod bench_estimate;
mod estimate;
mod learned;
mod places;
mod port_correction;
mod problem;
mod search;
mod settings;
mod simulated;
mod smooth_factor;
mod widths;

pub use bench_estimate::{BenchEstimate, PortEstimate};
pub use estimate::Estimate;
pub(crate) use learned::LearnedBench;
pub use places::{PlaceSettings, Places};
pub(crate) use places::{deepest_pose, n_places};
pub use port_correction::PortCorrection;
pub(crate) use problem::radius_weights;
pub use search::{fit_bench, refine_bench};
pub(crate) use search::{fit_radius, in_order};
pub use settings::{BenchSettings, Taxels};
pub use simulated::features;
pub(crate) use simulated::{curves, features_along};
pub(crate) use smooth_factor::N_TERMS as N_SMOOTH_TERMS;
pub use smooth_factor::SmoothFactor;
