//! `twintac sensor show`.

use anyhow::Result;
use twintac_sensor::SensorFile;

use crate::arguments::SensorShow;
use crate::output::print;

/// Prints a description with units, and draws it.
pub(crate) fn show(arguments: &SensorShow) -> Result<()> {
    let sensor = SensorFile::read(&arguments.file)?.sensor;
    print(sensor.describe().trim_end())?;
    if let Some(path) = &arguments.draw {
        twintac_drawing::drawing(&sensor).write(path)?;
    }
    Ok(())
}
