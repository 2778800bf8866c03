//! A gel as a source of tables over depth.

use glam::DQuat;
use twintac_depth_table::{DepthTable, DepthTableRequest, DepthTableSource, SourceError};
use twintac_shape::{Pose, Shape, Underside};

use crate::{Gel, PressPlace, SimulateError};

impl Gel {
    /// The press that a request describes.
    ///
    /// # Errors
    /// [`SimulateError::NoIndenter`].
    pub fn requested(&self, request: &DepthTableRequest) -> Result<PressPlace, SimulateError> {
        let shape = match (self.shape(&request.indenter)?, request.tip_radius_mm) {
            (Shape::Sphere { .. }, Some(radius_mm)) => Shape::Sphere { radius_mm },
            (shape, _) => shape.clone(),
        };
        let at = request.gel_from_indenter_at_touch;
        Ok(PressPlace {
            indenter: request.indenter.clone(),
            shape,
            x_mm: at.position_mm.x,
            y_mm: at.position_mm.y,
            rotation: at.rotation,
            depth_mm: request.max_depth_mm,
            enough_force_n: request.enough_force_n,
        })
    }

    /// The underside (contact geometry) of a shape, rotated as it presses.
    ///
    /// # Errors
    /// A surface that is not in the sensor's description.
    pub fn underside(&self, shape: &Shape, rotation: DQuat) -> Result<Underside, SimulateError> {
        let shape = shape.signed_distance_field(&self.sensor().surfaces)?;
        Ok(Underside::of(shape.as_ref(), rotation))
    }

    /// The shape of one of the sensor's indenters.
    ///
    /// # Errors
    /// [`SimulateError::NoIndenter`].
    pub fn shape(&self, indenter: &str) -> Result<&Shape, SimulateError> {
        let sensor = self.sensor();
        sensor
            .indenter(indenter)
            .map(|described| &described.shape)
            .ok_or_else(|| SimulateError::NoIndenter {
                asked_for: indenter.to_owned(),
                described: sensor
                    .indenters
                    .iter()
                    .map(|described| described.name.clone())
                    .collect(),
            })
    }
}

/// Simulates one table after another.
impl DepthTableSource for Gel {
    fn touch(&self, indenter: &str, above: &Pose) -> Result<Pose, SourceError> {
        Ok(Self::touch(self, self.shape(indenter)?, above)?)
    }

    fn underside(&self, request: &DepthTableRequest) -> Result<Underside, SourceError> {
        let pressed = self.requested(request)?;
        Ok(Self::underside(self, &pressed.shape, pressed.rotation)?)
    }

    fn depth_tables(&self, requests: &[DepthTableRequest]) -> Result<Vec<DepthTable>, SourceError> {
        let simulate = |request| Ok(self.depth_table(&self.requested(request)?)?);
        requests.iter().map(simulate).collect()
    }
}
