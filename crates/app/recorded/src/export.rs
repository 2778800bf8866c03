//! Frames of logs as tables, and logs for others.

use std::path::{Path, PathBuf};

use serde::Serialize;
use twintac_log::{Ending, LogError, TopicNames, export_bag, export_frames, recover};
use twintac_recording::LeRobotSummary;
use twintac_text::{fenced, markdown};
use twintac_work::{Progress, WorkError, read_text};

use crate::recorded::Recorded;

/// What was written of a log.
#[derive(Clone, Debug, Serialize)]
pub struct Exported {
    /// The log.
    pub log: PathBuf,
    /// Its table (Parquet).
    pub table: PathBuf,
    /// What the log has.
    #[serde(flatten)]
    pub found: LogFound,
}

/// What a log has that was written as something else.
#[derive(Clone, Debug, Serialize)]
pub struct LogFound {
    /// Tactile frames.
    pub frames: u64,
    /// Gaps in them, marked by the recorder or left by damage.
    pub gaps: u64,
    /// Time of the last frame, s.
    pub last_s: f64,
    /// Whether the log was whole and as it was written.
    pub is_whole: bool,
    /// What is wrong with a log that was cut or damaged, and what became of it, in words.
    #[serde(skip)]
    pub recovered: Option<String>,
}

/// Writes a log's frames as a Parquet table into `folder`, or beside the log. A log that was cut or damaged is made whole, in a file beside it.
///
/// # Errors
/// A file that is no log; a file that cannot be written.
pub fn export(log: &Path, folder: Option<&Path>) -> Result<Exported, WorkError> {
    let name = whole_name(log).with_extension("parquet");
    let table = match folder {
        Some(folder) => {
            std::fs::create_dir_all(folder).map_err(WorkError::file("creating", folder))?;
            folder.join(name.file_name().unwrap_or_default())
        }
        None => name,
    };
    let exported = export_frames(log, &table)?;
    Ok(Exported {
        log: log.to_owned(),
        table,
        found: found(log, exported)?,
    })
}

/// What was written of a log for ROS 2.
#[derive(Clone, Debug, Serialize)]
pub struct ExportedBag {
    /// The log.
    pub log: PathBuf,
    /// The bag (MCAP).
    pub bag: PathBuf,
    /// What the log has.
    #[serde(flatten)]
    pub found: LogFound,
}

/// Writes a log as a bag of ROS 2 with standard messages alone (MCAP), of the log's name, into `folder`. `topics` are what a topic holds and what it is to be
/// called, as for [`TopicNames::rename`]. A log that was cut or damaged is made whole, in a file beside it.
///
/// # Errors
/// A file that is no log; a bag that is there already or cannot be written; names that ROS does not take, or two topics of one.
pub fn export_ros(log: &Path, folder: &Path, topics: &[(String, String)]) -> Result<ExportedBag, WorkError> {
    let mut names = TopicNames::default();
    for (topic, name) in topics {
        names.rename(topic, name)?;
    }
    std::fs::create_dir_all(folder).map_err(WorkError::file("creating", folder))?;
    let bag = folder.join(whole_name(log).file_name().unwrap_or_default());
    let exported = export_bag(log, &bag, &names)?;
    Ok(ExportedBag {
        log: log.to_owned(),
        bag,
        found: found(log, exported)?,
    })
}

/// What was found in a log, and what becomes of it.
fn found(log: &Path, exported: twintac_log::Exported) -> Result<LogFound, WorkError> {
    Ok(LogFound {
        frames: exported.frames,
        gaps: exported.gaps,
        last_s: exported.last_s,
        is_whole: exported.ending == Ending::Whole,
        recovered: recovered(log, exported.ending)?,
    })
}

/// What is wrong with a log by its ending, and what becomes of it.
fn recovered(log: &Path, ending: Ending) -> Result<Option<String>, WorkError> {
    let problem = match ending {
        Ending::Whole => return Ok(None),
        Ending::Damaged => "is damaged: its bytes have changed since it was written",
        Ending::Cut => "was cut",
    };
    Ok(Some(format!("{problem}; {}", make_whole(log)?)))
}

/// A cut log's name when it is whole.
fn whole_name(log: &Path) -> PathBuf {
    match log.extension() {
        Some(extension) if extension == "partial" => log.with_extension(""),
        _ => log.to_owned(),
    }
}

/// Puts a whole log beside a cut one; how that went.
fn make_whole(log: &Path) -> Result<String, WorkError> {
    match recover(log) {
        Ok(recovered) => Ok(format!(
            "all that can be read stands in {}",
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
) -> Result<LeRobotSummary, WorkError> {
    let recording = Recorded::read(files, None, progress)?.recording;
    let mut how_made = String::from("Written by `twintac export --lerobot` from:\n\n");
    for file in files {
        let name = file.file_name().unwrap_or_default();
        how_made.push_str(&format!("- {}\n", markdown(&name.to_string_lossy())));
    }
    let beside = files.first().map(|first| first.with_file_name("dataset.toml"));
    if let Some(dataset) = beside.filter(|beside| beside.exists()) {
        let text = read_text(&dataset)?;
        let text = fenced("toml", &text);
        how_made.push_str(&format!(
            "\nThe presses were simulated by `twintac dataset`:\n\n{text}"
        ));
    }
    Ok(recording.write_lerobot(folder, &how_made)?)
}
