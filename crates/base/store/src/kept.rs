//! Values in files, each under the key of everything that it is made from.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use crate::{Digest, MadeFrom, StoreError, write_file};

/// Largest number of characters of a label in the name of a file.
const LABEL_LENGTH: usize = 80;

/// How a value is made. The fields of the struct are all inputs that the value depends on:
/// [`make`](Self::make) gets nothing else, and all fields are in the key. So no field may be left
/// out when the struct is serialized.
pub trait Recipe: Serialize {
    /// The value that is made.
    type Value: Serialize + DeserializeOwned;
    /// What can go wrong.
    type Error: From<StoreError>;

    /// A few words about the value, which become part of the name of its file.
    fn label(&self) -> String;

    /// Makes the value.
    ///
    /// # Errors
    /// Those of the computation.
    fn make(&self) -> Result<Self::Value, Self::Error>;
}

/// A value that was read from its file or was made now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kept<T> {
    /// The value.
    pub value: T,
    /// Why the value was made again although there was a file, in words. The user should see it.
    pub made_again: Option<String>,
}

/// A folder of values. A value is made once for all programs of one build that ask for the same.
#[derive(Clone, Debug)]
pub struct Store {
    folder: PathBuf,
    program: String,
}

#[derive(Serialize)]
struct Written<'a, T> {
    made_from: &'a MadeFrom,
    /// Digest of the value's JSON text.
    sha256: Digest,
    value: &'a T,
}

#[derive(Deserialize)]
struct Read<'a> {
    made_from: MadeFrom,
    sha256: Digest,
    #[serde(borrow)]
    value: &'a RawValue,
}

impl Store {
    /// The values of one build of a program, in a folder that may not exist yet.
    #[must_use]
    pub fn new(folder: &Path, program: &str) -> Self {
        Self {
            folder: folder.to_owned(),
            program: program.to_owned(),
        }
    }

    /// The value of a recipe: read from its file, or made now and written to its file. If the file
    /// is damaged, the value is made again.
    ///
    /// # Errors
    /// Those of the recipe; the file cannot be read or written.
    pub fn get<R: Recipe>(&self, recipe: &R) -> Result<Kept<R::Value>, R::Error> {
        let made_from = MadeFrom::of(&self.program, recipe)?;
        let path = self.path(&recipe.label(), &made_from);
        let made_again = match fs::read(&path) {
            Ok(bytes) => match value_of(&bytes, &made_from) {
                Ok(value) => {
                    return Ok(Kept {
                        value,
                        made_again: None,
                    });
                }
                Err(why) => Some(format!("{} {why}: it is made again", path.display())),
            },
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => return Err(StoreError::file("reading", &path)(error).into()),
        };
        let value = recipe.make()?;
        let bytes = written(&value, &made_from).map_err(|source| StoreError::Json {
            what: path.display().to_string(),
            source,
        })?;
        write_file(&path, &bytes)?;
        Ok(Kept { value, made_again })
    }

    fn path(&self, label: &str, made_from: &MadeFrom) -> PathBuf {
        let plain = |letter: char| {
            let is_plain = letter.is_ascii_alphanumeric() || "+-._#".contains(letter);
            if is_plain { letter } else { '-' }
        };
        let label: String = label.chars().take(LABEL_LENGTH).map(plain).collect();
        self.folder
            .join(format!("{label}_{}.json", made_from.digest().short()))
    }
}

fn written(value: &impl Serialize, made_from: &MadeFrom) -> Result<Vec<u8>, serde_json::Error> {
    let value = serde_json::value::to_raw_value(value)?;
    serde_json::to_vec(&Written {
        made_from,
        sha256: Digest::of(value.get().as_bytes()),
        value: &value,
    })
}

/// The value in a file, or what is wrong with the file.
fn value_of<T: DeserializeOwned>(bytes: &[u8], made_from: &MadeFrom) -> Result<T, &'static str> {
    let damaged = "is damaged";
    let read: Read<'_> = serde_json::from_slice(bytes).map_err(|_| damaged)?;
    if read.made_from != *made_from {
        return Err("was made from other inputs than its name says");
    }
    if Digest::of(read.value.get().as_bytes()) != read.sha256 {
        return Err(damaged);
    }
    serde_json::from_str(read.value.get()).map_err(|_| "was made by another version of the program")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    static MADE: AtomicUsize = AtomicUsize::new(0);

    #[derive(Serialize)]
    struct Square {
        of: f64,
    }

    impl Recipe for Square {
        type Value = f64;
        type Error = StoreError;

        fn label(&self) -> String {
            format!("../of {}", self.of)
        }

        fn make(&self) -> Result<f64, StoreError> {
            MADE.fetch_add(1, Ordering::Relaxed);
            Ok(self.of * self.of)
        }
    }

    #[test]
    fn a_value_is_made_once_and_again_when_its_file_is_damaged() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::new(folder.path(), "this");
        let get = |of: f64| store.get(&Square { of }).unwrap();
        let n_made = || MADE.load(Ordering::Relaxed);
        assert_eq!((get(1.5).value, get(1.5).value, n_made()), (2.25, 2.25, 1));
        assert_eq!((get(2.5).value, n_made()), (6.25, 2));
        let other = Store::new(folder.path(), "another");
        assert_eq!(
            (other.get(&Square { of: 1.5 }).unwrap().value, n_made()),
            (2.25, 3)
        );

        let path = store.path("../of 1.5", &MadeFrom::of("this", &Square { of: 1.5 }).unwrap());
        assert!(path.starts_with(folder.path()) && path.exists());
        let whole = fs::read_to_string(&path).unwrap();
        for damaged in [
            whole.replace("2.25", "2.75"),
            whole[..whole.len() / 2].to_owned(),
            String::new(),
        ] {
            fs::write(&path, damaged).unwrap();
            let kept = get(1.5);
            assert!(kept.value == 2.25 && kept.made_again.unwrap().contains("damaged"));
            assert_eq!(fs::read_to_string(&path).unwrap(), whole);
        }
        let another = store.path("../of 2.5", &MadeFrom::of("this", &Square { of: 2.5 }).unwrap());
        fs::copy(&another, &path).unwrap();
        let kept = get(1.5);
        assert!(kept.value == 2.25 && kept.made_again.unwrap().contains("other inputs"));

        fs::remove_file(&path).unwrap();
        fs::create_dir(&path).unwrap();
        assert!(store.get(&Square { of: 1.5 }).is_err());
    }
}
