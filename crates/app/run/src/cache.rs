//! Stages that are not run twice.
//!
//! A stage owns one folder of a run. It works in `<name>.partial` and is renamed to `<name>` when it is done, so a folder that exists is
//! whole. Its `stage.json` says from what it was made; asked for again with the same inputs by the same program, and with its files as it
//! left them, it is not run again. What a killed stage had put into its partial folder is there for the next try with the same inputs.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::files::{read_json, sha256, sha256_of_file, write_json};
use crate::{Outcome, RunError};

const RECORD: &str = "stage.json";

/// What a finished stage was made from, and what it left.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct StageRecord {
    /// Name and SHA-256 of each input; settings are inputs too.
    pub(crate) inputs: BTreeMap<String, String>,
    /// Name and SHA-256 of each file left.
    pub(crate) outputs: BTreeMap<String, String>,
    /// How long it took, s. Differs from run to run, and is no input to anything.
    pub(crate) wall_time_s: f64,
}

/// The inputs of a stage, gathered before it runs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Inputs(BTreeMap<String, String>);

impl Inputs {
    /// Starts with what identifies the program: another build may compute something else.
    pub(crate) fn new(program: &str) -> Self {
        Self(BTreeMap::from([("program".to_owned(), program.to_owned())]))
    }

    /// Adds settings.
    pub(crate) fn settings(mut self, name: &str, settings: &impl Serialize) -> Result<Self, RunError> {
        let text = serde_json::to_vec(settings).map_err(|source| RunError::Json {
            what: name.to_owned(),
            source,
        })?;
        self.0.insert(name.to_owned(), sha256(&text));
        Ok(self)
    }

    /// Adds a file by its content.
    pub(crate) fn file(mut self, path: &Path) -> Result<Self, RunError> {
        self.0.insert(path.display().to_string(), sha256_of_file(path)?);
        Ok(self)
    }

    /// Adds all that an earlier stage left.
    pub(crate) fn stage(mut self, folder: &Path) -> Result<Self, RunError> {
        let record = read_record(folder).map_err(|source| RunError::Unfinished {
            folder: folder.to_owned(),
            source: Box::new(source),
        })?;
        for (name, hash) in record.outputs {
            self.0.insert(format!("{}/{name}", folder.display()), hash);
        }
        Ok(self)
    }
}

/// Runs `work` unless `folder` already holds what it would make. `work` writes into the folder that it is given.
pub(crate) fn run(
    folder: &Path,
    inputs: Inputs,
    work: impl FnOnce(&Path) -> Result<(), RunError>,
) -> Result<Outcome, RunError> {
    if is_current(folder, &inputs) {
        return Ok(Outcome::Kept);
    }
    let started = Instant::now();
    let partial = partial_folder(folder);
    let mut record = StageRecord {
        inputs: inputs.0,
        outputs: BTreeMap::new(),
        wall_time_s: 0.0,
    };
    if partial.exists() && !read_record(&partial).is_ok_and(|earlier| earlier.inputs == record.inputs) {
        fs::remove_dir_all(&partial).map_err(RunError::file("removing the outdated", &partial))?;
    }
    write_json(&partial.join(RECORD), &record)?;
    work(&partial)?;
    record.outputs = hash_files(&partial)?;
    record.wall_time_s = started.elapsed().as_secs_f64();
    write_json(&partial.join(RECORD), &record)?;
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(RunError::file("removing the outdated", folder))?;
    }
    fs::rename(&partial, folder).map_err(RunError::file("renaming", &partial))?;
    Ok(Outcome::Ran)
}

/// The record of a finished stage.
pub(crate) fn read_record(folder: &Path) -> Result<StageRecord, RunError> {
    read_json(&folder.join(RECORD))
}

fn is_current(folder: &Path, inputs: &Inputs) -> bool {
    let Ok(record) = read_record(folder) else {
        return false;
    };
    record.inputs == inputs.0 && hash_files(folder).is_ok_and(|files| files == record.outputs)
}

/// Where a stage works: beside its folder.
fn partial_folder(folder: &Path) -> PathBuf {
    let mut name = folder.file_name().unwrap_or_default().to_owned();
    name.push(".partial");
    folder.with_file_name(name)
}

fn hash_files(folder: &Path) -> Result<BTreeMap<String, String>, RunError> {
    let mut files = BTreeMap::new();
    let mut pending = vec![folder.to_owned()];
    while let Some(next) = pending.pop() {
        for entry in fs::read_dir(&next).map_err(RunError::file("listing", &next))? {
            let path = entry.map_err(RunError::file("listing", &next))?.path();
            if path.is_dir() {
                pending.push(path);
                continue;
            }
            let name = path.strip_prefix(folder).unwrap_or(&path).display().to_string();
            if name != RECORD && !name.ends_with(".partial") {
                files.insert(name, sha256_of_file(&path)?);
            }
        }
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::write_file;

    fn inputs(text: &str) -> Inputs {
        Inputs(BTreeMap::from([("text".to_owned(), sha256(text.as_bytes()))]))
    }

    #[test]
    fn a_stage_runs_once_until_its_inputs_or_outputs_change() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("stage");
        let make = |text: &'static str| {
            run(&folder, inputs(text), |to| {
                write_file(&to.join("deep/out.txt"), text.as_bytes())
            })
            .unwrap()
        };
        assert_eq!(make("a"), Outcome::Ran);
        assert_eq!(make("a"), Outcome::Kept);
        assert_eq!(make("b"), Outcome::Ran);
        assert_eq!(fs::read_to_string(folder.join("deep/out.txt")).unwrap(), "b");
        fs::write(folder.join("deep/out.txt"), "meddled").unwrap();
        assert_eq!(make("b"), Outcome::Ran);
        assert_eq!(fs::read_to_string(folder.join("deep/out.txt")).unwrap(), "b");
    }

    #[test]
    fn a_failed_stage_leaves_no_folder_but_keeps_its_partial_work() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("stage");
        let failed = run(&folder, inputs("a"), |to| {
            write_file(&to.join("first"), b"1")?;
            Err(RunError::Input("killed".to_owned()))
        });
        assert!(failed.is_err() && !folder.exists());
        run(&folder, inputs("a"), |to| {
            assert!(to.join("first").exists());
            Ok(())
        })
        .unwrap();
        assert!(folder.join("first").exists());
    }
}
