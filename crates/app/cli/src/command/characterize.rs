//! `twintac characterize`: measures a sensor's properties in recorded presses.

use anyhow::Result;
use twintac_recorded::{COMPENSATION, Recorded};
use twintac_run::read_import;
use twintac_sensor::SensorFile;

use super::files::expand;
use crate::arguments::Characterize;
use crate::output::print;
use crate::progress::Bars;

/// Characterizes, and prints or writes the result.
pub(crate) fn run(arguments: &Characterize) -> Result<()> {
    let sensor = SensorFile::read(&arguments.sensor)?.sensor;
    let import = arguments.import.as_deref().map(read_import).transpose()?;
    let files = expand(&arguments.recordings)?;
    let recorded = Recorded::read(&files, import.as_ref(), &Bars::default())?;
    let found = recorded.characterize(&sensor)?;
    if let Some(folder) = &arguments.out {
        recorded.write(&found, &sensor, folder)?;
    }
    if arguments.json {
        return print(&serde_json::to_string_pretty(&found)?);
    }
    for [name, value, condition] in found.rows(&sensor) {
        print(&format!("{name:<26} {value:<28} {condition}"))?;
    }
    if let Some(folder) = &arguments.out {
        print(&format!("report  {}", folder.join("report.html").display()))?;
        if found.compensation().is_some() {
            print(&format!(
                "zeros over temperature  {}",
                folder.join(COMPENSATION).display()
            ))?;
        }
    }
    Ok(())
}
