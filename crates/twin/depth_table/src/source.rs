//! Sources of tables over depth.

use serde::{Deserialize, Serialize};
use twintac_shape::{Pose, Underside};

use crate::DepthTable;

/// The error of a source of tables.
pub type SourceError = Box<dyn std::error::Error + Send + Sync>;

/// A table to simulate at one location.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DepthTableRequest {
    /// Name of the indenter in the sensor description.
    pub indenter: String,
    /// The indenter's pose at first touch, from [`DepthTableSource::touch`].
    pub gel_from_indenter_at_touch: Pose,
    /// Depth below first touch to reach, mm.
    pub max_depth_mm: f64,
    /// Force that is enough, N: the table may end where it is reached. It is always given for
    /// presses of prescribed force.
    pub enough_force_n: Option<f64>,
    /// Radius of a spherical tip in place of the described one, mm. The indenter's origin stays at
    /// the point of first touch.
    pub tip_radius_mm: Option<f64>,
}

/// Makes tables over depth. It is implemented for a finite-element gel, for stored tables of one,
/// or by a formula.
pub trait DepthTableSource {
    /// Lowers the described indenter, at a pose whose z is ignored, until it touches the undeformed
    /// gel.
    ///
    /// # Errors
    /// An indenter that the sensor does not have, or a location where it misses the gel.
    fn touch(&self, indenter: &str, above: &Pose) -> Result<Pose, SourceError>;

    /// The underside (contact geometry) of the requested indenter, rotated as it presses.
    ///
    /// # Errors
    /// An indenter that the sensor does not have.
    fn underside(&self, request: &DepthTableRequest) -> Result<Underside, SourceError>;

    /// Makes one table for each request, in the order of the requests.
    ///
    /// # Errors
    /// A request that can't be simulated.
    fn depth_tables(&self, requests: &[DepthTableRequest]) -> Result<Vec<DepthTable>, SourceError>;
}
