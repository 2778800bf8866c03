//! A file that is written under a temporary name.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file that is being written as `<name>.partial`. It is removed if it is dropped before
/// [`finish`](PartialFile::finish).
#[derive(Debug)]
pub struct PartialFile {
    /// `None` after it was renamed.
    file: Option<File>,
    partial: PathBuf,
    path: PathBuf,
}

impl PartialFile {
    /// Starts a file that will be called `path`.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn create(path: &Path) -> io::Result<Self> {
        let partial = partial_path(path);
        Ok(Self {
            file: Some(File::create(&partial)?),
            partial,
            path: path.to_owned(),
        })
    }

    /// Gives the file its name, in place of the file that had the name before.
    ///
    /// # Errors
    /// Those of the operating system; the partial file is then removed.
    pub fn finish(mut self) -> io::Result<()> {
        drop(self.file.take());
        std::fs::rename(&self.partial, &self.path).inspect_err(|_| remove(&self.partial))
    }
}

impl Write for PartialFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.file {
            Some(file) => file.write(bytes),
            None => Err(io::ErrorKind::BrokenPipe.into()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), File::flush)
    }
}

impl Drop for PartialFile {
    fn drop(&mut self) {
        if self.file.take().is_some() {
            remove(&self.partial);
        }
    }
}

/// An error is ignored: a partial file that stays does no harm, as it never has the name of a
/// complete one.
fn remove(partial: &Path) {
    let _ = std::fs::remove_file(partial);
}

/// `<name>.partial` beside `path`: the name of a file or folder until it is complete.
pub(crate) fn partial_path(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".partial");
    path.with_file_name(name)
}
