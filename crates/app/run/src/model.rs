//! A trained twin's folder, and the gel that it was trained with.

use std::path::Path;

use digitac::Model;
use twintac_simulate::{Gel, SimulateSettings};

use crate::{RunError, SensorFile};

/// The gel of a model's sensor, simulated as it was for training.
pub(crate) fn gel_of(model: &Model, folder: &Path) -> Result<Gel, RunError> {
    let path = folder.join("twin.json");
    let sensor = SensorFile::parse(&path, &model.record.sensor)?.sensor;
    let settings: SimulateSettings = serde_json::from_value(model.record.simulation.clone())
        .map_err(|source| RunError::Damaged { path, source })?;
    Ok(Gel::new(sensor, settings))
}
