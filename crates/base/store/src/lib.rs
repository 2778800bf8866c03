//! Keeps computed values in files under a key of everything that they were made from, and writes
//! files and folders that appear complete or not at all.
//!
//! Input: a folder, and a recipe, which is a struct with the inputs of a computation. Output: the
//! value, read from its file if the same inputs were used before, computed and written otherwise.
//!
//! - [`Store`]: values, one file each. A [`Recipe`] makes a value: it is a struct whose fields are
//!   all inputs that the value depends on, and a method that gets nothing else.
//! - [`Stages`]: folders that are made in the same way, by a [`Stage`] each. A stage reads an
//!   earlier one through a [`Finished`], which exists only for a complete stage whose files are
//!   unchanged.
//! - [`Keyed`]: an input together with its digest, and [`MadeFrom`]: the digests of all inputs of a
//!   value.
//! - [`write_whole`] and [`PartialFile`]: a file is written as `<name>.partial` and renamed when it
//!   is complete. [`PartialFolder`] is the same for a folder.
//! - [`Owner`]: the lock of a folder, so that only one program at a time works in it.
//!
//! ```
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("metrics.json");
//! twintac_store::write_whole(&path, b"{}")?;
//! assert_eq!(std::fs::read(&path)?, b"{}");
//! # Ok::<(), std::io::Error>(())
//! ```
//!
//! # How it works
//!
//! A kept value is made by a struct, a [`Stage`] or a [`Recipe`], that has only its own fields to
//! make it from. The key of the value is what these fields serialize to, together with the version
//! of the program. An input that is not in the key therefore cannot be reached by the code that
//! makes the value. No field may be left out when the struct is serialized.
//!
//! A [`Keyed`] value stands for its content, by a SHA-256 digest: a sensor for its description and
//! the surfaces that it names, a gel for its sensor and settings, a file for its bytes, a finished
//! stage for its output files.
//!
//! A file or folder whose key differs from the expected one is made again, or is refused with an
//! error that names the inputs that differ. A kept value has the digest of its own text in its
//! file: a damaged file is noticed and made again. A stage has a `stage.json` with the digests of
//! its inputs and of its output files: a stage of which a file was changed is made again as well. A
//! stage that was killed continues, if the inputs are still the same, with what its partial folder
//! contains.
//!
//! If the program is killed while it writes a file, the previous file of that name is still there.
//! When it is killed while it replaces a folder, the new folder, the old one or neither is there,
//! but never a part of one. A power failure can still lose the last files, because nothing is
//! forced to the disk.
//!
//! This crate depends on no other crate of the workspace: it does not know what is in the files.

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
/// Those of the operating system: the folder does not exist, the disk is full. The file that had
/// the name before is left as it was.
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
