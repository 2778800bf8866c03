//! The report and the data sheet, as HTML pages.

mod parts;
mod plots;
mod read_out;
mod report;
mod sheet;
mod words;

use std::path::Path;

use twintac_recording::Recording;
use twintac_sensor::Sensor;

use sheet::data_sheet;

use crate::{Characterization, CharacterizeError};

pub use report::report;

/// Writes `report.html` and `datasheet.html` into a folder.
///
/// # Errors
/// The folder or a file cannot be written.
pub fn write_pages(
    folder: &Path,
    found: &Characterization,
    recording: &Recording,
    sensor: &Sensor,
) -> Result<(), CharacterizeError> {
    std::fs::create_dir_all(folder).map_err(|source| CharacterizeError::Folder {
        path: folder.to_owned(),
        source,
    })?;
    report(found, recording, sensor).write(&folder.join("report.html"))?;
    data_sheet(found, recording, sensor).write(&folder.join("datasheet.html"))?;
    Ok(())
}
