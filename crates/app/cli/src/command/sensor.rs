//! `twintac sensor show`.

use anyhow::Result;

use crate::arguments::SensorShow;
use twintac_run::sensor_file::read_sensor;

/// Prints a description with units, and draws it.
pub(crate) fn show(arguments: &SensorShow) -> Result<()> {
    let sensor = read_sensor(&arguments.file)?.sensor;
    super::print(sensor.describe().trim_end())?;
    if let Some(path) = &arguments.draw {
        twintac_drawing::drawing(&sensor).write(path)?;
    }
    Ok(())
}
