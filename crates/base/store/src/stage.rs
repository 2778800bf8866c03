//! Folders that are made once, each from all inputs that it depends on.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::{Deserialize, Serialize, Serializer};

use crate::folder::remove;
use crate::{Digest, MadeFrom, NotCurrent, PartialFolder, StoreError, read_json, write_json};

/// The file that records what a folder was made from.
const RECORD: &str = "stage.json";

/// How a folder is made. The fields of the struct are all inputs that its files depend on:
/// [`make`](Self::make) gets nothing else, and all fields are in the key. So no field may be left
/// out when the struct is serialized. An earlier stage is a field of type [`Finished`].
pub trait Stage: Serialize {
    /// Name of the folder.
    const NAME: &'static str;
    /// What a user runs to make the stage, such as `twintac train`.
    const MADE_BY: &'static str;
    /// Receives the progress of the work.
    type Follower: ?Sized;
    /// What can go wrong.
    type Error: From<StoreError>;

    /// Fills the folder. It may already contain what a killed program made from the same inputs.
    ///
    /// # Errors
    /// Those of the work.
    fn make(&self, folder: &Path, follower: &Self::Follower) -> Result<(), Self::Error>;
}

/// Whether a stage ran or already existed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It ran: its inputs had changed, or it had never run.
    Ran,
    /// It existed.
    Kept,
}

/// What a finished stage was made from, and its output files; written as `stage.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Record {
    made_from: MadeFrom,
    /// The digest of each output file.
    outputs: BTreeMap<String, Digest>,
    /// Duration of the work, s. It differs from run to run, and is not an input of anything.
    wall_time_s: f64,
}

/// A stage whose folder is complete. It serializes as the digests of its files, so that it can be
/// an input of another stage.
#[derive(Clone, Debug)]
pub struct Finished {
    folder: PathBuf,
    record: Record,
}

impl Finished {
    /// Path of a file of the stage.
    #[must_use]
    pub fn file(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// What the stage was made from.
    #[must_use]
    pub fn made_from(&self) -> &MadeFrom {
        &self.record.made_from
    }

    /// Duration of the work, s.
    #[must_use]
    pub fn wall_time_s(&self) -> f64 {
        self.record.wall_time_s
    }
}

impl Serialize for Finished {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.record.outputs.serialize(serializer)
    }
}

/// The stages of a folder, made by one build of a program.
#[derive(Clone, Copy, Debug)]
pub struct Stages<'a> {
    /// The folder that contains a folder for each stage.
    pub root: &'a Path,
    /// Text that distinguishes one build from another, because each may compute something else.
    pub program: &'a str,
}

impl Stages<'_> {
    /// Makes a stage unless it exists. The stage is made in `<name>.partial`, which is renamed when
    /// complete. No other program may work in the folder: see [`Owner`](crate::Owner).
    ///
    /// # Errors
    /// Those of the stage; a file cannot be read or written.
    pub fn run<S: Stage>(&self, stage: &S, follower: &S::Follower) -> Result<(Outcome, Finished), S::Error> {
        let made_from = MadeFrom::of(self.program, stage)?;
        if let Ok(finished) = self.finished_from::<S>(&made_from) {
            return Ok((Outcome::Kept, finished));
        }
        let started = Instant::now();
        let folder = self.root.join(S::NAME);
        let partial = PartialFolder::take_up(&folder);
        let mut record = Record {
            made_from,
            outputs: BTreeMap::new(),
            wall_time_s: 0.0,
        };
        let record_file = partial.path().join(RECORD);
        let earlier = read_json::<Record>(&record_file);
        if !earlier.is_ok_and(|earlier| earlier.made_from == record.made_from) {
            remove(partial.path())?;
        }
        write_json(&record_file, &record)?;
        stage.make(partial.path(), follower)?;
        record.outputs = digests(partial.path())?;
        record.wall_time_s = started.elapsed().as_secs_f64();
        write_json(&record_file, &record)?;
        partial.finish()?;
        Ok((Outcome::Ran, Finished { folder, record }))
    }

    /// The existing stage, if this program made it from these inputs.
    ///
    /// # Errors
    /// [`StoreError::NotCurrent`] names the inputs that differ; or the inputs cannot be written as
    /// JSON.
    pub fn current<S: Stage>(&self, stage: &S) -> Result<Finished, StoreError> {
        Ok(self.finished_from::<S>(&MadeFrom::of(self.program, stage)?)?)
    }

    /// An existing stage whose files are as it left them, whatever it was made from.
    ///
    /// # Errors
    /// [`NotCurrent`]: there is no such stage, or its files were changed.
    pub fn finished(&self, name: &str, made_by: &'static str) -> Result<Finished, NotCurrent> {
        let folder = self.root.join(name);
        let not_current = |why: &str| NotCurrent {
            folder: folder.clone(),
            why: why.to_owned(),
            made_by,
        };
        if !folder.exists() {
            return Err(not_current("was not made yet"));
        }
        let record: Record = read_json(&folder.join(RECORD)).map_err(|_| not_current("is incomplete"))?;
        if !digests(&folder).is_ok_and(|files| files == record.outputs) {
            return Err(not_current("has files that were changed since it was made"));
        }
        Ok(Finished { folder, record })
    }

    fn finished_from<S: Stage>(&self, made_from: &MadeFrom) -> Result<Finished, NotCurrent> {
        let finished = self.finished(S::NAME, S::MADE_BY)?;
        let differences = finished.record.made_from.differences(made_from);
        if differences.is_empty() {
            return Ok(finished);
        }
        Err(NotCurrent {
            folder: finished.folder,
            why: format!("was made from another {}", differences.join(", ")),
            made_by: S::MADE_BY,
        })
    }
}

/// The digest of each file of a folder, except for the record.
fn digests(folder: &Path) -> Result<BTreeMap<String, Digest>, StoreError> {
    let mut files = BTreeMap::new();
    let mut pending = vec![folder.to_owned()];
    while let Some(next) = pending.pop() {
        for entry in fs::read_dir(&next).map_err(StoreError::file("listing", &next))? {
            let path = entry.map_err(StoreError::file("listing", &next))?.path();
            if path.is_dir() {
                pending.push(path);
                continue;
            }
            let name = path.strip_prefix(folder).unwrap_or(&path).display().to_string();
            if name != RECORD && !name.ends_with(".partial") {
                files.insert(name, Digest::of_file(&path)?);
            }
        }
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
    use std::sync::atomic::{AtomicBool, Ordering};

    use super::*;
    use crate::write_file;

    #[derive(Serialize)]
    struct First {
        text: &'static str,
    }

    impl Stage for First {
        const NAME: &'static str = "first";
        const MADE_BY: &'static str = "program first";
        type Follower = AtomicBool;
        type Error = StoreError;

        /// Fails half-way if `fails` is set.
        fn make(&self, folder: &Path, fails: &AtomicBool) -> Result<(), StoreError> {
            if !folder.join("begun").exists() {
                write_file(&folder.join("begun"), self.text.as_bytes())?;
            }
            if fails.load(Ordering::Relaxed) {
                return Err(StoreError::file("writing", folder)(
                    std::io::ErrorKind::StorageFull.into(),
                ));
            }
            write_file(&folder.join("deep/out.txt"), self.text.as_bytes())
        }
    }

    #[derive(Serialize)]
    struct Second {
        first: Finished,
    }

    impl Stage for Second {
        const NAME: &'static str = "second";
        const MADE_BY: &'static str = "program second";
        type Follower = ();
        type Error = StoreError;

        fn make(&self, folder: &Path, (): &()) -> Result<(), StoreError> {
            let text = fs::read(self.first.file("deep/out.txt"));
            let text = text.map_err(StoreError::file("reading", folder))?;
            write_file(&folder.join("out.txt"), &text)
        }
    }

    fn stages(root: &Path) -> Stages<'_> {
        Stages {
            root,
            program: "this",
        }
    }

    #[test]
    fn a_stage_runs_once_until_inputs_program_or_files_change() {
        let root = tempfile::tempdir().unwrap();
        let make = |text: &'static str, program: &str| {
            let stages = Stages {
                root: root.path(),
                program,
            };
            let (outcome, finished) = stages.run(&First { text }, &AtomicBool::new(false)).unwrap();
            let found = fs::read_to_string(finished.file("deep/out.txt")).unwrap();
            assert_eq!(found, text);
            outcome
        };
        assert_eq!(make("a", "this"), Outcome::Ran);
        assert_eq!(make("a", "this"), Outcome::Kept);
        assert_eq!(make("b", "this"), Outcome::Ran);
        assert_eq!(make("b", "other"), Outcome::Ran);
        fs::write(root.path().join("first/deep/out.txt"), "meddled").unwrap();
        assert_eq!(make("b", "other"), Outcome::Ran);
        fs::write(root.path().join("first/more"), "more").unwrap();
        assert_eq!(make("b", "other"), Outcome::Ran);
    }

    #[test]
    fn what_a_killed_stage_had_is_taken_up_from_the_same_inputs_alone() {
        let root = tempfile::tempdir().unwrap();
        let stages = stages(root.path());
        let (fails, works) = (AtomicBool::new(true), AtomicBool::new(false));
        assert!(stages.run(&First { text: "a" }, &fails).is_err());
        assert!(!root.path().join("first").exists());
        fs::write(root.path().join("first.partial/begun"), "half").unwrap();
        let (_, finished) = stages.run(&First { text: "a" }, &works).unwrap();
        assert_eq!(fs::read_to_string(finished.file("begun")).unwrap(), "half");
        assert!(stages.run(&First { text: "b" }, &fails).is_err());
        let (_, finished) = stages.run(&First { text: "c" }, &works).unwrap();
        assert_eq!(fs::read_to_string(finished.file("begun")).unwrap(), "c");
    }

    #[test]
    fn a_later_stage_needs_an_earlier_one_that_is_current_and_a_moved_folder_is_the_same() {
        let root = tempfile::tempdir().unwrap();
        let old = root.path().join("old");
        let works = AtomicBool::new(false);
        let missing = stages(&old)
            .current(&First { text: "a" })
            .unwrap_err()
            .to_string();
        assert!(
            missing.contains("not made yet") && missing.contains("`program first`"),
            "{missing}"
        );
        let (_, first) = stages(&old).run(&First { text: "a" }, &works).unwrap();
        assert_eq!(stages(&old).run(&Second { first }, &()).unwrap().0, Outcome::Ran);
        let other = stages(&old)
            .current(&First { text: "b" })
            .unwrap_err()
            .to_string();
        assert!(other.contains("another text"), "{other}");

        let new = root.path().join("new");
        fs::rename(&old, &new).unwrap();
        let first = stages(&new).current(&First { text: "a" }).unwrap();
        assert_eq!(stages(&new).run(&Second { first }, &()).unwrap().0, Outcome::Kept);
        fs::write(new.join("first/begun"), "meddled").unwrap();
        let changed = stages(&new)
            .current(&First { text: "a" })
            .unwrap_err()
            .to_string();
        assert!(changed.contains("changed since"), "{changed}");
    }
}
