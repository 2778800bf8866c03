//! Where tables over depth come from.

use serde::{Deserialize, Serialize};
use twintac_shape::{Pose, Underside};

use crate::DepthTable;

/// What a source of tables may fail with.
pub type SourceError = Box<dyn std::error::Error + Send + Sync>;

/// One place to simulate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DepthTableRequest {
    /// Name of the indenter in the sensor description.
    pub indenter: String,
    /// The indenter where it first touches, as [`DepthTableSource::touch`] gives it.
    pub gel_from_indenter_at_touch: Pose,
    /// Depth below first touch to reach, mm.
    pub max_depth_mm: f64,
    /// Force that is enough, N: the table may end where it is reached. Always there for presses of prescribed force.
    pub enough_force_n: Option<f64>,
    /// Radius of a spherical tip in place of the described one, mm. The indenter's origin stays where it
    /// touches first.
    pub tip_radius_mm: Option<f64>,
}

/// Simulates presses; implemented over a finite-element gel, a cache of one, or a formula.
pub trait DepthTableSource {
    /// Lowers the described indenter, at a pose whose z is ignored, until it touches the undeformed gel.
    ///
    /// # Errors
    /// An indenter that the sensor does not have, and a place where it misses the gel.
    fn touch(&self, indenter: &str, above: &Pose) -> Result<Pose, SourceError>;

    /// The underside of the indenter that a request presses with, turned as it presses.
    ///
    /// # Errors
    /// An indenter that the sensor does not have.
    fn underside(&self, request: &DepthTableRequest) -> Result<Underside, SourceError>;

    /// One table for each request, in the order of the requests.
    ///
    /// # Errors
    /// A request that can't be simulated.
    fn depth_tables(&self, requests: &[DepthTableRequest]) -> Result<Vec<DepthTable>, SourceError>;
}
