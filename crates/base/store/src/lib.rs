//! Values that are kept in files by all that they are made from, and files and folders that appear whole or not at all.
//!
//! - [`write_whole`] and [`PartialFile`]: a file under `<name>.partial`, renamed when it is complete. If the program is killed meanwhile, what had the name
//!   before is still there. A power cut may still lose the last files: nothing is forced to the disk.
//! - [`PartialFolder`]: the same with a folder.
//! - [`Store`]: values, a file each. What makes one is a [`Recipe`]: a struct whose fields are all that the value depends on, and a method that has
//!   nothing but these. The key of the file is made of all fields, so an input that is not in the key cannot be used.
//! - [`Stages`]: folders that are made in the same way, a [`Stage`] each. A stage reads an earlier one through a [`Finished`], which is to be had only of a
//!   stage that is as its inputs say.
//! - [`Owner`]: one program at a time works in a folder.
//!
//! ```
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("metrics.json");
//! twintac_store::write_whole(&path, b"{}")?;
//! assert_eq!(std::fs::read(&path)?, b"{}");
//! # Ok::<(), std::io::Error>(())
//! ```

mod digest;
mod error;
mod folder;
mod json;
mod kept;
mod keyed;
mod made_from;
mod owner;
mod partial;
mod stage;

use std::io::{self, Write as _};
use std::path::Path;

pub use digest::Digest;
pub use error::{NotCurrent, StoreError};
pub use folder::PartialFolder;
pub use json::{read_json, write_file, write_json};
pub use kept::{Kept, Recipe, Store};
pub use keyed::Keyed;
pub use made_from::MadeFrom;
pub use owner::Owner;
pub use partial::PartialFile;
pub use stage::{Finished, Outcome, Stage, Stages};

/// Writes a file under a temporary name and renames it.
///
/// # Errors
/// What the system says: the folder does not exist, the disk is full. The file that had the name before is left as it was.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = PartialFile::create(path)?;
    file.write_all(bytes)?;
    file.finish()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
    use super::*;

    #[test]
    fn a_file_is_replaced_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.html");
        write_whole(&path, b"one").unwrap();
        write_whole(&path, b"two").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_file_that_is_given_up_leaves_the_one_before() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.html");
        write_whole(&path, b"one").unwrap();
        let mut file = PartialFile::create(&path).unwrap();
        file.write_all(b"half of").unwrap();
        drop(file);
        assert_eq!(std::fs::read(&path).unwrap(), b"one");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_missing_folder_is_an_error() {
        let error = write_whole(Path::new("/no/such/folder/a.html"), b"x").unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::NotFound);
    }
}
