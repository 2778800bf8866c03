//! A lock that lets one program at a time work in a folder.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{Read as _, Seek as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use crate::StoreError;

/// The file whose lock marks the folder as in use.
const FILE: &str = ".in-use";

/// Folders that this process owns.
static OWNED: Mutex<BTreeMap<PathBuf, Weak<Lock>>> = Mutex::new(BTreeMap::new());

/// The right to work in a folder, for as long as the value exists. Another process that asks for it
/// meanwhile gets an error. When a process is killed, the operating system releases the lock.
/// Within one process, all owners of a folder share the lock and take turns.
#[derive(Clone, Debug)]
pub struct Owner(Arc<Lock>);

#[derive(Debug)]
struct Lock {
    /// The lock is released when the file is closed.
    _file: File,
    turn: Mutex<()>,
}

impl Owner {
    /// Takes the lock of a folder, which is created if it does not exist.
    ///
    /// # Errors
    /// [`StoreError::InUse`]; or the folder cannot be written.
    pub fn of(folder: &Path) -> Result<Self, StoreError> {
        fs::create_dir_all(folder).map_err(StoreError::file("creating", folder))?;
        let known_as = folder
            .canonicalize()
            .map_err(StoreError::file("opening", folder))?;
        let mut owned = OWNED.lock().unwrap_or_else(PoisonError::into_inner);
        owned.retain(|_, lock| lock.strong_count() > 0);
        if let Some(lock) = owned.get(&known_as).and_then(Weak::upgrade) {
            return Ok(Self(lock));
        }
        let path = folder.join(FILE);
        let open = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path);
        let mut file = open.map_err(StoreError::file("opening", &path))?;
        match file.try_lock() {
            Ok(()) => (),
            Err(TryLockError::WouldBlock) => {
                return Err(StoreError::InUse {
                    folder: folder.to_owned(),
                    by: whose(&mut file),
                });
            }
            Err(TryLockError::Error(source)) => return Err(StoreError::file("locking", &path)(source)),
        }
        let say = file
            .set_len(0)
            .and_then(|()| file.rewind())
            .and_then(|()| write!(file, "{}", std::process::id()));
        say.map_err(StoreError::file("writing", &path))?;
        let lock = Arc::new(Lock {
            _file: file,
            turn: Mutex::new(()),
        });
        owned.insert(known_as, Arc::downgrade(&lock));
        Ok(Self(lock))
    }

    /// Waits until no other thread of this process works in the folder.
    pub fn turn(&self) -> MutexGuard<'_, ()> {
        self.0.turn.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The process that works in the folder, according to its own entry.
fn whose(file: &mut File) -> String {
    let mut text = String::new();
    match file.read_to_string(&mut text) {
        Ok(_) if !text.trim().is_empty() => format!(" (process {})", text.trim()),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
    use super::*;

    #[test]
    fn another_process_is_refused_and_this_one_shares() {
        let folder = tempfile::tempdir().unwrap();
        // A file that is opened again has a lock of its own, like one of another process.
        let open = || {
            OpenOptions::new()
                .create(true)
                .truncate(false)
                .write(true)
                .open(folder.path().join(FILE))
        };
        let other = open().unwrap();
        other.lock().unwrap();
        fs::write(folder.path().join(FILE), "12").unwrap();
        let error = Owner::of(folder.path()).unwrap_err().to_string();
        assert!(
            error.contains("in use by another program (process 12)"),
            "{error}"
        );
        drop(other);

        let (one, two) = (
            Owner::of(folder.path()).unwrap(),
            Owner::of(folder.path()).unwrap(),
        );
        drop(one);
        assert!(open().unwrap().try_lock().is_err());
        drop(two);
        open().unwrap().try_lock().unwrap();
    }
}
