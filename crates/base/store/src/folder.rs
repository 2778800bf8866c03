//! A folder that is filled under a temporary name.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::StoreError;
use crate::partial::partial_path;

/// A folder that is being filled as `<name>.partial`. Nobody else may fill it at the same time: see
/// [`Owner`](crate::Owner).
#[derive(Debug)]
pub struct PartialFolder {
    partial: PathBuf,
    path: PathBuf,
}

impl PartialFolder {
    /// Starts a folder that will be called `path`. What a killed program left of it is removed.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn create(path: &Path) -> Result<Self, StoreError> {
        let folder = Self::take_up(path);
        remove(&folder.partial)?;
        fs::create_dir_all(&folder.partial).map_err(StoreError::file("creating", &folder.partial))?;
        Ok(folder)
    }

    /// The folder that will be called `path`, including what a killed program left of it.
    pub(crate) fn take_up(path: &Path) -> Self {
        Self {
            partial: partial_path(path),
            path: path.to_owned(),
        }
    }

    /// The path of the partial folder: where to write.
    #[must_use]
    #[allow(clippy::misnamed_getters)] // this is where to write
    pub fn path(&self) -> &Path {
        &self.partial
    }

    /// Gives the folder its name, in place of the folder that had the name before. If the program
    /// is killed during this, the new folder, the old one or neither is there.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn finish(self) -> Result<(), StoreError> {
        // A folder cannot be renamed onto one that has files, so the old one is renamed first.
        let old = self.path.with_added_extension("old");
        remove(&old)?;
        match fs::rename(&self.path, &old) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                return Err(StoreError::file("replacing", &self.path)(error));
            }
            _ => (),
        }
        fs::rename(&self.partial, &self.path).map_err(StoreError::file("renaming", &self.partial))?;
        remove(&old)
    }
}

/// Removes a folder, or a file of that name, if it exists.
pub(crate) fn remove(path: &Path) -> Result<(), StoreError> {
    let removed = match fs::symlink_metadata(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        Ok(about) if !about.is_dir() => fs::remove_file(path),
        _ => fs::remove_dir_all(path),
    };
    removed.map_err(StoreError::file("removing the outdated", path))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
    use super::*;

    fn fill(path: &Path, text: &str) {
        let folder = PartialFolder::create(path).unwrap();
        fs::write(folder.path().join("a"), text).unwrap();
        folder.finish().unwrap();
    }

    #[test]
    fn a_folder_replaces_another_wherever_a_program_was_killed() {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join("model");
        fill(&path, "one");
        // The program was killed while it filled the folder, and while it removed the old one.
        fs::create_dir_all(root.path().join("model.partial/half")).unwrap();
        fs::create_dir_all(root.path().join("model.old/half")).unwrap();
        fill(&path, "two");
        assert_eq!(fs::read_to_string(path.join("a")).unwrap(), "two");
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1);
        // The program was killed between the two renames.
        fs::rename(&path, root.path().join("model.old")).unwrap();
        fill(&path, "three");
        assert_eq!(fs::read_to_string(path.join("a")).unwrap(), "three");
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1);
    }
}
