//! Settings by which the driver finds a sensor's taxels.

use phystac::Settings;
use twintac_sensor::Sensor;

use crate::{SourceError, TAXELS};

/// Settings by which the driver finds a sensor's taxels.
///
/// # Errors
/// Fails if the sensor cannot be read by this driver.
pub fn driver_settings(sensor: &Sensor) -> Result<Settings<TAXELS>, SourceError> {
    let problem = |problem: String| SourceError::Sensor {
        sensor: sensor.name.clone(),
        problem,
    };
    if !sensor.is_wired() {
        let advice = "its description does not say how its taxels are wired: give each the `channel` of its switch, and `chip` under [readout]";
        return Err(problem(advice.to_owned()));
    }
    let wiring = sensor.wiring().map_err(|error| problem(error.to_string()))?;
    Ok(Settings::new(wiring))
}
