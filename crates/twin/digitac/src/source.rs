//! Where simulated presses come from.

use twintac_shape::Pose;
use twintac_simulate::Sweep;

use crate::DigitacError;

/// What a source of sweeps may fail with.
pub type SourceError = Box<dyn std::error::Error + Send + Sync>;

/// One place to simulate.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepRequest {
    /// Name of the indenter in the sensor description.
    pub indenter: String,
    /// The indenter where it first touches, as [`SweepSource::touch`] gives it.
    pub gel_from_indenter_at_touch: Pose,
    /// Depth below first touch to reach, mm.
    pub max_depth_mm: f64,
    /// Force that is enough, N: the sweep may end where it is reached. Always there for presses of prescribed force.
    pub enough_force_n: Option<f64>,
    /// Radius of a spherical tip in place of the described one, mm. The indenter's origin stays where it
    /// touches first.
    pub tip_radius_mm: Option<f64>,
}

/// Simulates presses; implemented over a finite-element gel, a cache of one, or a formula.
pub trait SweepSource {
    /// Lowers the described indenter, at a pose whose z is ignored, until it touches the undeformed gel.
    fn touch(&self, indenter: &str, above: &Pose) -> Result<Pose, SourceError>;

    /// One table over depth for each request, in the order of the requests.
    fn sweeps(&self, requests: &[SweepRequest]) -> Result<Vec<Sweep>, SourceError>;
}

/// Asks for sweeps and checks that they answer.
pub(crate) fn request(
    source: &dyn SweepSource,
    requests: &[SweepRequest],
) -> Result<Vec<Sweep>, DigitacError> {
    let sweeps = source.sweeps(requests).map_err(DigitacError::Sweeps)?;
    if sweeps.len() != requests.len() {
        return Err(DigitacError::WrongSweep {
            index: sweeps.len().min(requests.len()),
            expected: format!("{} sweeps", requests.len()),
            found: format!("{} sweeps", sweeps.len()),
        });
    }
    Ok(sweeps)
}
