//! Temperature compensation of recordings.

use std::borrow::Cow;

use digitac::ModelRecord;
use twintac_recording::Recording;
use twintac_temperature::Compensation;
use twintac_work::{Progress, WorkError};

/// Removes the drift of the zeros with temperature, where a recording has temperatures, and notes
/// how large it was.
///
/// # Errors
/// A compensation of another sensor, or without one of its taxels.
pub fn compensate(
    recording: &mut Recording,
    compensation: &Compensation,
    progress: &dyn Progress,
) -> Result<(), WorkError> {
    let done = compensation
        .apply(recording)
        .map_err(|error| WorkError::Input(error.to_string()))?;
    if done.n_without > 0 {
        progress.note(&format!(
            "{} of {} presses have no temperatures and are not compensated",
            done.n_without,
            done.n_presses + done.n_without
        ));
    }
    if done.largest_kpa > 0.0 {
        progress.note(&format!(
            "the drift of the zeros with temperature, up to {:.3} kPa within a press, is compensated",
            done.largest_kpa
        ));
    }
    done.remarks.iter().for_each(|remark| progress.note(remark));
    Ok(())
}

/// A recording, compensated like those that a model was trained on.
pub(crate) fn as_in_training<'r>(
    recording: &'r Recording,
    record: &ModelRecord,
    progress: &dyn Progress,
) -> Result<Cow<'r, Recording>, WorkError> {
    let Some(compensation) = record
        .temperature
        .as_ref()
        .filter(|_| recording.has_temperatures())
    else {
        return Ok(Cow::Borrowed(recording));
    };
    let mut recording = recording.clone();
    compensate(&mut recording, compensation, progress)?;
    Ok(Cow::Owned(recording))
}
