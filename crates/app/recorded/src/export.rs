//! Export of logs: frames as tables, and files of other formats.

use std::path::{Path, PathBuf};

use serde::Serialize;
use twintac_log::{Ending, LogError, TopicNames, export_bag, export_frames, recover};
use twintac_recording::LeRobotSummary;
use twintac_text::{fenced, markdown};
use twintac_work::{Progress, WorkError, read_text};

use crate::recorded::Recorded;

/// The result of exporting a log as a table.
#[derive(Clone, Debug, Serialize)]
pub struct Exported {
    /// The log.
    pub log: PathBuf,
    /// The table (Parquet).
    pub table: PathBuf,
    /// The content of the log.
    #[serde(flatten)]
    pub found: LogFound,
}

/// The content of an exported log.
#[derive(Clone, Debug, Serialize)]
pub struct LogFound {
    /// Tactile frames.
    pub frames: u64,
    /// Gaps in the frames, marked by the recorder or caused by damage.
    pub gaps: u64,
    /// Time of the last frame, s.
    pub last_s: f64,
    /// Whether the log was complete and unchanged.
    pub is_whole: bool,
    /// For a log that was cut or damaged: what is wrong, and where its recovered copy is, in words.
    #[serde(skip)]
    pub recovered: Option<String>,
}

/// Writes a log's frames as a Parquet table into `folder`, or beside the log. If the log was cut or
/// damaged, a recovered copy is written beside it.
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

/// The result of exporting a log for ROS 2.
#[derive(Clone, Debug, Serialize)]
pub struct ExportedBag {
    /// The log.
    pub log: PathBuf,
    /// The bag (MCAP).
    pub bag: PathBuf,
    /// The content of the log.
    #[serde(flatten)]
    pub found: LogFound,
}

/// Writes a log as a ROS 2 bag (MCAP) with standard messages alone, of the log's name, into
/// `folder`. Each entry of `topics` is the content of a topic and its new name, as for
/// [`TopicNames::rename`]. If the log was cut or damaged, a recovered copy is written beside it.
///
/// # Errors
/// A file that is no log; a bag that exists already or cannot be written; names that ROS does not
/// allow, or two topics of one name.
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

/// The content of a log; a cut or damaged one is recovered.
fn found(log: &Path, exported: twintac_log::Exported) -> Result<LogFound, WorkError> {
    Ok(LogFound {
        frames: exported.frames,
        gaps: exported.gaps,
        last_s: exported.last_s,
        is_whole: exported.ending == Ending::Whole,
        recovered: recovered(log, exported.ending)?,
    })
}

/// What is wrong with a log by its ending, and where its recovered copy is.
fn recovered(log: &Path, ending: Ending) -> Result<Option<String>, WorkError> {
    let problem = match ending {
        Ending::Whole => return Ok(None),
        Ending::Damaged => "is damaged: its bytes have changed since it was written",
        Ending::Cut => "is truncated",
    };
    Ok(Some(format!("{problem}; {}", make_whole(log)?)))
}

/// The name of a cut log's recovered copy.
fn whole_name(log: &Path) -> PathBuf {
    match log.extension() {
        Some(extension) if extension == "partial" => log.with_extension(""),
        _ => log.to_owned(),
    }
}

/// Writes the recovered copy of a cut log beside it, and describes the result.
fn make_whole(log: &Path) -> Result<String, WorkError> {
    match recover(log) {
        Ok(recovered) => Ok(format!(
            "everything that can be read is in {}",
            recovered.path.display()
        )),
        Err(LogError::Exists { file }) => Ok(format!("{file} exists already")),
        Err(error) => Err(error.into()),
    }
}

/// Writes recorded presses, of Parquet files and MCAP logs, as one LeRobot data set into a new
/// folder. The data set's card names the source files and, for a data set of `twintac dataset`, its
/// inputs.
///
/// # Errors
/// A file of another format, or one that cannot be read; recordings that do not belong together; a
/// folder that exists already.
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
