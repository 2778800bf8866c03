//! Frames of logs as tables.

use std::path::{Path, PathBuf};

use serde::Serialize;
use twintac_log::{Ending, LogError, export_frames, recover};
use twintac_recording::LeRobotSummary;

use crate::characterization::Recorded;
use crate::files::read_text;
use crate::{Progress, RunError};

/// What was written of a log.
#[derive(Clone, Debug, Serialize)]
pub struct Exported {
    /// The log.
    pub log: PathBuf,
    /// Its table (Parquet).
    pub table: PathBuf,
    /// Rows of the table.
    pub frames: u64,
    /// Marked gaps between them.
    pub gaps: u64,
    /// Time of the last frame, s.
    pub last_s: f64,
    /// Whether the log was whole.
    pub is_whole: bool,
    /// What became of a log that was cut, in words.
    #[serde(skip)]
    pub recovered: Option<String>,
}

/// Writes a log's frames as a Parquet table into `folder`, or beside the log. A log that was cut is made whole, in a file beside it.
///
/// # Errors
/// A file that is no log; a file that cannot be written.
pub fn export(log: &Path, folder: Option<&Path>) -> Result<Exported, RunError> {
    let name = whole_name(log).with_extension("parquet");
    let table = match folder {
        Some(folder) => {
            std::fs::create_dir_all(folder).map_err(RunError::file("creating", folder))?;
            folder.join(name.file_name().unwrap_or_default())
        }
        None => name,
    };
    let exported = export_frames(log, &table)?;
    let is_whole = exported.ending == Ending::Whole;
    Ok(Exported {
        log: log.to_owned(),
        table,
        frames: exported.frames,
        gaps: exported.gaps,
        last_s: exported.last_s,
        is_whole,
        recovered: if is_whole { None } else { Some(make_whole(log)?) },
    })
}

/// A cut log's name when it is whole.
fn whole_name(log: &Path) -> PathBuf {
    match log.extension() {
        Some(extension) if extension == "partial" => log.with_extension(""),
        _ => log.to_owned(),
    }
}

/// Puts a whole log beside a cut one; how that went.
fn make_whole(log: &Path) -> Result<String, RunError> {
    match recover(log) {
        Ok(recovered) => Ok(format!(
            "all that was flushed stands in {}",
            recovered.path.display()
        )),
        Err(LogError::Exists { file }) => Ok(format!("{file} is there already")),
        Err(error) => Err(error.into()),
    }
}

/// Writes recorded presses, Parquet files and MCAP logs, as one LeRobot data set into a folder that is not there yet. Its card says from which files it is made, and of a data
/// set of `twintac dataset` what that is made from.
///
/// # Errors
/// A file that is neither, or cannot be read; recordings that do not belong together; a folder that is there already.
pub fn export_lerobot(
    files: &[PathBuf],
    folder: &Path,
    progress: &dyn Progress,
) -> Result<LeRobotSummary, RunError> {
    let recording = Recorded::read(files, progress)?.recording;
    let mut how_made = String::from("Written by `twintac export --lerobot` from:\n\n");
    for file in files {
        let name = file.file_name().unwrap_or_default();
        how_made.push_str(&format!("- `{}`\n", name.display()));
    }
    let beside = files.first().map(|first| first.with_file_name("dataset.toml"));
    if let Some(dataset) = beside.filter(|beside| beside.exists()) {
        let text = read_text(&dataset)?;
        how_made.push_str(&format!(
            "\nThe presses were simulated by `twintac dataset`:\n\n```toml\n{text}```\n"
        ));
    }
    Ok(recording.write_lerobot(folder, &how_made)?)
}
