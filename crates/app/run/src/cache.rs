//! Stages that are not run twice.
//!
//! A stage owns one folder of a run. It works in `<name>.partial` and is renamed to `<name>` when it is done, so a folder that exists is
//! whole. Its `stage.json` says from what it was made; asked for again with the same inputs by the same program, and with its files as it
//! left them, it is not run again. What a killed stage had put into its partial folder is there for the next try with the same inputs.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Instant;

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

const RECORD: &str = "stage.json";

/// What a finished stage was made from, and what it left.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StageRecord {
    /// Name and SHA-256 of each input; settings are inputs too.
    pub inputs: BTreeMap<String, String>,
    /// Name and SHA-256 of each file left.
    pub outputs: BTreeMap<String, String>,
    /// How long it took, s. Differs from run to run, and is no input to anything.
    pub wall_time_s: f64,
}

/// The inputs of a stage, gathered before it runs.
#[derive(Clone, Debug, Default)]
pub struct Inputs(BTreeMap<String, String>);

impl Inputs {
    /// Starts with the program itself: another build may compute something else.
    pub fn new() -> Result<Self> {
        static PROGRAM: OnceLock<String> = OnceLock::new();
        let hash = match PROGRAM.get() {
            Some(hash) => hash,
            None => {
                let path = std::env::current_exe().context("finding this program's own file")?;
                let hash = sha256_of_file(&path)?;
                PROGRAM.get_or_init(|| hash)
            }
        };
        Ok(Self(BTreeMap::from([("program".to_owned(), hash.clone())])))
    }

    /// Adds settings.
    pub fn settings(mut self, name: &str, settings: &impl Serialize) -> Result<Self> {
        let text =
            serde_json::to_vec(settings).with_context(|| format!("writing down the settings of {name}"))?;
        self.0.insert(name.to_owned(), sha256(&text));
        Ok(self)
    }

    /// Adds a file by its content.
    pub fn file(mut self, path: &Path) -> Result<Self> {
        self.0.insert(path.display().to_string(), sha256_of_file(path)?);
        Ok(self)
    }

    /// Adds all that an earlier stage left.
    pub fn stage(mut self, folder: &Path) -> Result<Self> {
        let record = read_record(folder).with_context(|| {
            format!(
                "{} is not a finished stage: run the command that makes it first",
                folder.display()
            )
        })?;
        for (name, hash) in record.outputs {
            self.0.insert(format!("{}/{name}", folder.display()), hash);
        }
        Ok(self)
    }
}

/// Whether a stage ran or was already there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Its inputs had changed, or it had never run.
    Ran,
    /// It was there.
    Kept,
}

/// Runs `work` unless `folder` already holds what it would make. `work` writes into the folder that it is given.
pub fn run(folder: &Path, inputs: Inputs, work: impl FnOnce(&Path) -> Result<()>) -> Result<Outcome> {
    if is_current(folder, &inputs) {
        return Ok(Outcome::Kept);
    }
    let started = Instant::now();
    let partial = partial_folder(folder)?;
    let mut record = StageRecord {
        inputs: inputs.0,
        outputs: BTreeMap::new(),
        wall_time_s: 0.0,
    };
    if partial.exists() && !read_record(&partial).is_ok_and(|earlier| earlier.inputs == record.inputs) {
        fs::remove_dir_all(&partial)
            .with_context(|| format!("removing the outdated {}", partial.display()))?;
    }
    write_json(&partial.join(RECORD), &record)?;
    work(&partial)?;
    record.outputs = hash_files(&partial)?;
    record.wall_time_s = started.elapsed().as_secs_f64();
    write_json(&partial.join(RECORD), &record)?;
    if folder.exists() {
        fs::remove_dir_all(folder).with_context(|| format!("removing the outdated {}", folder.display()))?;
    }
    fs::rename(&partial, folder)
        .with_context(|| format!("renaming {} to its final name", partial.display()))?;
    Ok(Outcome::Ran)
}

/// The record of a finished stage.
pub fn read_record(folder: &Path) -> Result<StageRecord> {
    read_json(&folder.join(RECORD))
}

/// Reads a JSON file; the error names it.
pub fn read_json<T: for<'de> Deserialize<'de>>(path: &Path) -> Result<T> {
    let bytes = fs::read(path).with_context(|| format!("reading {}", path.display()))?;
    serde_json::from_slice(&bytes).with_context(|| format!("{} is damaged", path.display()))
}

/// Writes a JSON file under a temporary name and renames it.
pub fn write_json(path: &Path, value: &impl Serialize) -> Result<()> {
    let mut bytes =
        serde_json::to_vec_pretty(value).with_context(|| format!("writing {}", path.display()))?;
    bytes.push(b'\n');
    write_file(path, &bytes)
}

/// Writes a file under a temporary name and renames it.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder {
        fs::create_dir_all(folder).with_context(|| format!("creating {}", folder.display()))?;
    }
    let mut temporary = path.as_os_str().to_owned();
    temporary.push(".tmp");
    let temporary = PathBuf::from(temporary);
    fs::write(&temporary, bytes).with_context(|| format!("writing {}", temporary.display()))?;
    fs::rename(&temporary, path).with_context(|| format!("renaming {}", temporary.display()))
}

/// SHA-256 as hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    use std::fmt::Write as _;
    let mut text = String::with_capacity(64);
    for byte in Sha256::digest(bytes) {
        let _ = write!(text, "{byte:02x}");
    }
    text
}

fn sha256_of_file(path: &Path) -> Result<String> {
    Ok(sha256(
        &fs::read(path).with_context(|| format!("reading {}", path.display()))?,
    ))
}

fn is_current(folder: &Path, inputs: &Inputs) -> bool {
    let Ok(record) = read_record(folder) else {
        return false;
    };
    record.inputs == inputs.0 && hash_files(folder).is_ok_and(|files| files == record.outputs)
}

fn partial_folder(folder: &Path) -> Result<PathBuf> {
    let name = folder
        .file_name()
        .with_context(|| format!("{} is no folder's name", folder.display()))?;
    let mut partial = name.to_owned();
    partial.push(".partial");
    Ok(folder.with_file_name(partial))
}

fn hash_files(folder: &Path) -> Result<BTreeMap<String, String>> {
    let mut files = BTreeMap::new();
    let mut pending = vec![folder.to_owned()];
    while let Some(next) = pending.pop() {
        for entry in fs::read_dir(&next).with_context(|| format!("listing {}", next.display()))? {
            let path = entry?.path();
            if path.is_dir() {
                pending.push(path);
                continue;
            }
            let name = path.strip_prefix(folder).unwrap_or(&path).display().to_string();
            if name != RECORD && !name.ends_with(".tmp") {
                files.insert(name, sha256_of_file(&path)?);
            }
        }
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

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
            anyhow::bail!("killed")
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
