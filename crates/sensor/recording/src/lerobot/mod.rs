//! Recordings as LeRobot data sets, version 3.0: presses are episodes, indenters are tasks.
//!
//! ```text
//! README.md                                     the data card
//! meta/info.json                                features, counts, frames a second
//! meta/stats.json                               minimum, maximum, mean, deviation and quantiles of
//!                                               each feature
//! meta/tasks.parquet                            what each press is for, with its number
//! meta/episodes/chunk-000/file-000.parquet      a row for each press: its length, where its frames
//!                                               are, its own statistics
//! data/chunk-000/file-000.parquet               a row for each frame
//! ```

mod card;
mod columns;
mod episode;
mod evenly;
mod features;
mod statistics;

pub use episode::LeRobotSummary;

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value, json};

use crate::{Press, Recording, RecordingError};
use columns::{LeRobotColumn, LeRobotValues, write_table};
use episode::Episode;
use evenly::{Even, evenly};
use features::{Feature, features};
use statistics::{Statistics, statistics};

/// The version of the format.
const VERSION: &str = "v3.0";

/// When a file reaches this size, LeRobot begins another.
const FILE_MB: u64 = 100;

/// Number of files in a folder.
const FILES_OF_CHUNK: usize = 1000;

/// Folder of frames.
const DATA: &str = "data";

/// Folder of episodes.
const EPISODES: &str = "meta/episodes";

impl Recording {
    /// Writes the recording as a LeRobot data set, version 3.0, into a folder that does not exist
    /// yet. The folder appears complete or not at all. `how_made` is a text for its card: how the
    /// presses were made.
    ///
    /// Features, as single-precision numbers: `observation.state`, the pose of the indenter (mm,
    /// quaternion); `observation.tactile`, a reading for each taxel (kPa); `observation.force` (N),
    /// if all presses have one; `action`, the pose of the next frame; `tactile_valid`, whether each
    /// reading is usable. `timestamp` counts from the start of each press, s. Tasks name the
    /// indenter.
    ///
    /// Frames have a whole rate, the nearest to the recording's own. If necessary they are
    /// interpolated; summary and card say so. A reading is usable if those beside it are.
    ///
    /// A missing reading is NaN. Statistics use only usable readings, and are null if there are
    /// none.
    ///
    /// # Errors
    /// The recording is inconsistent or has no presses; the folder exists already, or cannot be
    /// written.
    pub fn write_lerobot(&self, folder: &Path, how_made: &str) -> Result<LeRobotSummary, RecordingError> {
        self.check()?;
        if self.presses.is_empty() {
            return Err(RecordingError::Inconsistent {
                place: "recording".to_owned(),
                problem: "has no presses, which would be the episodes".to_owned(),
            });
        }
        let problem = |source| RecordingError::write(folder, source);
        if folder.exists() {
            let there = std::io::Error::new(
                std::io::ErrorKind::AlreadyExists,
                "it is there already, give another folder",
            );
            return Err(problem(there));
        }
        let above = folder.parent().filter(|above| !above.as_os_str().is_empty());
        let above = above.unwrap_or(Path::new("."));
        fs::create_dir_all(above).map_err(problem)?;
        let mut name = folder.file_name().unwrap_or_default().to_owned();
        name.push(".partial");
        let partial = above.join(name);
        let _ = fs::remove_dir_all(&partial); // left by a killed run
        let written = write_data_set(&evenly(self), &partial, how_made);
        match written {
            Ok(summary) => fs::rename(&partial, folder).map(|()| summary).map_err(problem),
            Err(error) => {
                let _ = fs::remove_dir_all(&partial);
                Err(error)
            }
        }
    }

    /// The presses as episodes, divided among files.
    fn episodes<'a>(&'a self, features: &[Feature], tasks: &[&str]) -> Vec<Episode<'a>> {
        let bytes_of_row: u64 = features.iter().map(Feature::bytes).sum();
        let rows_of_file = FILE_MB * 1024 * 1024 / bytes_of_row;
        let (mut first, mut file, mut rows) = (0, 0, 0);
        let episode = |press: &'a Press| {
            let n_frames = press.time_s.len();
            if rows > 0 && rows + n_frames as u64 > rows_of_file {
                (file, rows) = (file + 1, 0);
            }
            let episode = Episode {
                press,
                task: tasks
                    .iter()
                    .position(|task| *task == press.indenter)
                    .expect("each indenter is a task"),
                first,
                file,
            };
            first += n_frames;
            rows += n_frames as u64;
            episode
        };
        self.presses.iter().map(episode).collect()
    }
}

fn write_data_set(even: &Even<'_>, folder: &Path, how_made: &str) -> Result<LeRobotSummary, RecordingError> {
    let recording = &*even.recording;
    let features = features(recording);
    let mut tasks: Vec<&str> = Vec::new();
    for press in &recording.presses {
        if !tasks.contains(&press.indenter.as_str()) {
            tasks.push(&press.indenter);
        }
    }
    let episodes = recording.episodes(&features, &tasks);
    let n_frames = episodes.iter().map(|episode| episode.press.time_s.len()).sum();
    let summary = LeRobotSummary {
        episodes: episodes.len(),
        frames: n_frames,
        tasks: tasks.len(),
        fps: even.fps,
        resampled_from_hz: even.from_hz,
    };
    write_frames(folder, &features, &episodes)?;
    write_episodes(folder, &features, &episodes, &tasks)?;
    let task_texts: Vec<String> = tasks.iter().map(|indenter| task_text(indenter)).collect();
    write_tasks(folder, &task_texts)?;
    let info = info(recording, &features, &summary);
    write_json(&folder.join("meta/info.json"), &info)?;
    let mut of_all = Map::new();
    for (number, feature) in features.iter().enumerate() {
        let rows: Vec<Vec<f64>> = episodes
            .iter()
            .enumerate()
            .flat_map(|(index, episode)| features[number].usable_rows(episode, index))
            .collect();
        of_all.insert(feature.name.clone(), statistics(&rows).json());
    }
    write_json(&folder.join("meta/stats.json"), &Value::Object(of_all))?;
    let card = card::card(recording, &features, &summary, how_made);
    write(&folder.join("README.md"), card.as_bytes())?;
    Ok(summary)
}

/// The text of the task for an indenter.
fn task_text(indenter: &str) -> String {
    format!("press the sensor with the indenter {indenter}")
}

/// The path of a file in a folder of chunks.
fn numbered(folder: &Path, kind: &str, file: usize) -> PathBuf {
    let (chunk, file) = (file / FILES_OF_CHUNK, file % FILES_OF_CHUNK);
    folder
        .join(kind)
        .join(format!("chunk-{chunk:03}/file-{file:03}.parquet"))
}

fn write_frames(folder: &Path, features: &[Feature], episodes: &[Episode]) -> Result<(), RecordingError> {
    let mut start = 0;
    for of_file in episodes.chunk_by(|a, b| a.file == b.file) {
        let columns: Vec<LeRobotColumn> = features
            .iter()
            .map(|feature| {
                let rows = of_file
                    .iter()
                    .enumerate()
                    .flat_map(|(index, episode)| feature.rows(episode, start + index));
                feature.column(rows)
            })
            .collect();
        start += of_file.len();
        write_table(&numbered(folder, DATA, of_file[0].file), &columns, None)?;
    }
    Ok(())
}

fn write_episodes(
    folder: &Path,
    features: &[Feature],
    episodes: &[Episode],
    tasks: &[&str],
) -> Result<(), RecordingError> {
    let whole = |name: &str, value: &dyn Fn(usize, &Episode) -> usize| {
        let numbers = episodes.iter().enumerate();
        let numbers = numbers.map(|(index, episode)| value(index, episode) as i64);
        LeRobotColumn::single(name, LeRobotValues::Whole(numbers.collect()))
    };
    let texts = episodes
        .iter()
        .map(|episode| vec![task_text(tasks[episode.task])]);
    let mut columns = vec![
        whole("episode_index", &|index, _| index),
        LeRobotColumn::lists("tasks", texts.map(LeRobotValues::Text)),
        whole("length", &|_, episode| episode.press.time_s.len()),
        whole("data/chunk_index", &|_, episode| episode.file / FILES_OF_CHUNK),
        whole("data/file_index", &|_, episode| episode.file % FILES_OF_CHUNK),
        whole("dataset_from_index", &|_, episode| episode.first),
        whole("dataset_to_index", &|_, episode| {
            episode.first + episode.press.time_s.len()
        }),
    ];
    for feature in features {
        let of_episodes = episodes.iter().enumerate();
        let of_episodes = of_episodes
            .map(|(index, episode)| statistics(&feature.usable_rows(episode, index).collect::<Vec<_>>()));
        columns.extend(Statistics::columns(
            &feature.name,
            &of_episodes.collect::<Vec<_>>(),
        ));
    }
    columns.push(whole("meta/episodes/chunk_index", &|_, _| 0));
    columns.push(whole("meta/episodes/file_index", &|_, _| 0));
    write_table(&numbered(folder, EPISODES, 0), &columns, None)
}

/// The tasks are the index of a pandas table; the table's metadata says so.
fn write_tasks(folder: &Path, tasks: &[String]) -> Result<(), RecordingError> {
    const INDEX: &str = "__index_level_0__";
    let numbers = (0..tasks.len()).map(|task| task as i64);
    let columns = [
        LeRobotColumn::single("task_index", LeRobotValues::Whole(numbers.collect())),
        LeRobotColumn::single(INDEX, LeRobotValues::Text(tasks.to_vec())),
    ];
    let column = |name: Value, field: &str, pandas: &str, numpy: &str| json!({"name": name, "field_name": field, "pandas_type": pandas, "numpy_type": numpy, "metadata": null});
    let pandas = json!({
        "index_columns": [INDEX],
        "column_indexes": [],
        "columns": [
            column("task_index".into(), "task_index", "int64", "int64"),
            column(Value::Null, INDEX, "unicode", "object"),
        ],
        "creator": {"library": "twintac", "version": env!("CARGO_PKG_VERSION")},
        "pandas_version": "2.0.0",
    });
    write_table(
        &folder.join("meta/tasks.parquet"),
        &columns,
        Some(("pandas", &pandas.to_string())),
    )
}

fn info(recording: &Recording, features: &[Feature], summary: &LeRobotSummary) -> Value {
    let described: Map<String, Value> = features
        .iter()
        .map(|feature| (feature.name.clone(), feature.info()))
        .collect();
    json!({
        "codebase_version": VERSION,
        "robot_type": recording.sensor,
        "total_episodes": summary.episodes,
        "total_frames": summary.frames,
        "total_tasks": summary.tasks,
        "chunks_size": FILES_OF_CHUNK,
        "data_files_size_in_mb": FILE_MB,
        "video_files_size_in_mb": 200,
        "fps": summary.fps,
        "resampled_from_hz": summary.resampled_from_hz,
        "splits": {"train": format!("0:{}", summary.episodes)},
        "data_path": "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet",
        "video_path": null,
        "features": described,
        "provenance": recording.provenance,
    })
}

fn write_json(path: &Path, value: &Value) -> Result<(), RecordingError> {
    write(path, format!("{value:#}\n").as_bytes())
}

/// Writes a file, and creates its folder if necessary.
fn write(path: &Path, bytes: &[u8]) -> Result<(), RecordingError> {
    let problem = |source| RecordingError::write(path, source);
    fs::create_dir_all(path.parent().unwrap_or(Path::new(""))).map_err(problem)?;
    fs::write(path, bytes).map_err(problem)
}
