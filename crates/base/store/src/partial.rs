//! A file under a temporary name.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file that is being written as `<name>.partial`; dropped before [`finish`](PartialFile::finish), it is removed.
#[derive(Debug)]
pub struct PartialFile {
    /// `None` once it is renamed.
    file: Option<File>,
    partial: PathBuf,
    path: PathBuf,
}

impl PartialFile {
    /// Starts a file that will be called `path`.
    ///
    /// # Errors
    /// What the system says.
    pub fn create(path: &Path) -> io::Result<Self> {
        let partial = partial_path(path);
        Ok(Self {
            file: Some(File::create(&partial)?),
            partial,
            path: path.to_owned(),
        })
    }

    /// Gives the file its name, in place of what had it before.
    ///
    /// # Errors
    /// What the system says; the partial file is then removed.
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

/// A partial file that cannot be removed does no harm: it never has the name of a whole one.
fn remove(partial: &Path) {
    let _ = std::fs::remove_file(partial);
}

/// `<name>.partial` beside `path`: what a file or a folder is called until it is complete.
pub(crate) fn partial_path(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".partial");
    path.with_file_name(name)
}
