//! The folder of a run.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use twintac_protocol::PressPlan;

use crate::PressError;

const PROGRESS: &str = "progress.json";

/// The logs of the finished presses in a run's folder, in the order of the plans.
///
/// # Errors
/// A folder of another run.
pub fn done_logs(folder: &Path, plans: &[PressPlan]) -> Result<Vec<PathBuf>, PressError> {
    Ok(Folder::open(folder, plans)?.done())
}

/// Checks that a folder does not belong to another run. Nothing is written.
///
/// # Errors
/// As for [`done_logs`].
pub fn check_folder(folder: &Path, plans: &[PressPlan]) -> Result<(), PressError> {
    State::read(folder, plans).map(|_| ())
}

/// A run's folder: one log for each press, and which presses are done.
#[derive(Debug)]
pub(crate) struct Folder {
    path: PathBuf,
    state: State,
}

#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct State {
    plans: Vec<PressPlan>,
    /// Whether each press is done.
    done: Vec<bool>,
}

impl State {
    /// Reads the state of a folder. In a folder without a state nothing is done.
    fn read(folder: &Path, plans: &[PressPlan]) -> Result<Self, PressError> {
        let file = folder.join(PROGRESS);
        let other = |problem: String| PressError::OtherRun {
            folder: folder.display().to_string(),
            problem,
        };
        let text = match fs::read_to_string(&file) {
            Ok(text) => text,
            Err(found) if found.kind() == std::io::ErrorKind::NotFound => {
                return Ok(Self {
                    plans: plans.to_vec(),
                    done: vec![false; plans.len()],
                });
            }
            Err(source) => return Err(PressError::file(&file, source)),
        };
        let state: Self =
            serde_json::from_str(&text).map_err(|found| other(format!("{PROGRESS}: {found}")))?;
        if state.plans != plans || state.done.len() != plans.len() {
            return Err(other(format!("{PROGRESS} lists {}", state.plans.len())));
        }
        Ok(state)
    }
}

impl Folder {
    /// Opens the folder of these presses, or creates it.
    pub(crate) fn open(path: &Path, plans: &[PressPlan]) -> Result<Self, PressError> {
        let state = State::read(path, plans)?;
        fs::create_dir_all(path).map_err(|source| PressError::file(path, source))?;
        let folder = Self {
            path: path.to_owned(),
            state,
        };
        folder.store()?;
        Ok(folder)
    }

    pub(crate) fn is_done(&self, index: usize) -> bool {
        self.state.done.get(index).copied().unwrap_or(false)
    }

    /// The path of the log of a press. A log of an earlier attempt is renamed.
    pub(crate) fn log(&self, index: usize) -> Result<PathBuf, PressError> {
        let log = self.path_of(index);
        self.set_aside(&log)?;
        self.set_aside(&log.with_extension("mcap.partial"))?;
        Ok(log)
    }

    /// Renames a file if it exists, because no recording is ever deleted. Returns its new name.
    pub(crate) fn set_aside(&self, file: &Path) -> Result<PathBuf, PressError> {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let stem = name.split('.').next().unwrap_or_default();
        let end = name.strip_prefix(stem).unwrap_or_default();
        let free = (1..)
            .map(|number| self.path.join(format!("{stem}.try-{number}{end}")))
            .find(|path| !path.exists())
            .unwrap_or_default();
        match fs::rename(file, &free) {
            Ok(()) => Ok(free),
            Err(found) if found.kind() == std::io::ErrorKind::NotFound => Ok(free),
            Err(source) => Err(PressError::file(file, source)),
        }
    }

    /// The logs of the finished presses, in order.
    fn done(&self) -> Vec<PathBuf> {
        (0..self.state.plans.len())
            .filter(|index| self.is_done(*index))
            .map(|index| self.path_of(index))
            .collect()
    }

    fn path_of(&self, index: usize) -> PathBuf {
        self.path.join(format!("press-{:04}.mcap", index + 1))
    }

    pub(crate) fn set_done(&mut self, index: usize) -> Result<(), PressError> {
        self.state.done[index] = true;
        self.store()
    }

    fn store(&self) -> Result<(), PressError> {
        let file = self.path.join(PROGRESS);
        let partial = self.path.join(format!("{PROGRESS}.partial"));
        let text = serde_json::to_string_pretty(&self.state)
            .map_err(|found| PressError::file(&file, std::io::Error::other(found)))?;
        let stored = || -> std::io::Result<()> {
            let mut written = fs::File::create(&partial)?;
            written.write_all(text.as_bytes())?;
            written.write_all(b"\n")?;
            // A press that is stored as done stays so after a power cut.
            written.sync_all()?;
            fs::rename(&partial, &file)?;
            fs::File::open(&self.path)?.sync_all()
        };
        stored().map_err(|source| PressError::file(&file, source))
    }
}
