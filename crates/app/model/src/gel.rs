//! The gel that a trained twin was trained with.

use std::path::Path;
use std::sync::Arc;

use digitac::Model;
use twintac_config::Checked;
use twintac_sensor::SensorFile;
use twintac_simulate::{Gel, SimulateSettings};
use twintac_store::StoreError;
use twintac_work::{At, WorkError};

/// The gel of a model's sensor, with the simulation settings of the training.
pub fn gel_of(model: &Model, folder: &Path) -> Result<Gel, WorkError> {
    let sensor = SensorFile::parse(&folder.join("twin.json"), &model.record.sensor)?;
    gel_like(model, folder, &sensor)
}

/// The gel of another sensor, with the same simulation settings.
pub fn gel_like(model: &Model, folder: &Path, sensor: &SensorFile) -> Result<Gel, WorkError> {
    let settings: SimulateSettings =
        serde_json::from_value(model.record.simulation.clone()).map_err(|source| StoreError::Damaged {
            path: folder.join("twin.json"),
            source,
        })?;
    let path = folder.join("twin.json");
    settings
        .checked()
        .at(|| format!("{}, simulation", path.display()))?;
    let taxels = sensor.sensor.taxels.iter().map(|taxel| &taxel.name);
    if !taxels.eq(&model.record.taxels) {
        return Err(WorkError::Input(format!(
            "the twin in {} reads the taxels {}, which are not those of the sensor `{}`",
            folder.display(),
            model.record.taxels.join(", "),
            sensor.sensor.name
        )));
    }
    Ok(Gel::new(Arc::clone(&sensor.sensor), settings))
}
