//! Files that appear whole or not at all.
//!
//! A file is written under the name `<name>.partial` and renamed when it is complete, so that a reader never meets
//! half of it. If the program is killed meanwhile, what had the name before is still there. A power cut may still lose
//! the last files: nothing is forced to the disk.
//!
//! ```
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("metrics.json");
//! twintac_files::write_whole(&path, b"{}")?;
//! assert_eq!(std::fs::read(&path)?, b"{}");
//! # Ok::<(), std::io::Error>(())
//! ```

mod partial;

use std::io::{self, Write as _};
use std::path::Path;

pub use partial::PartialFile;

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
