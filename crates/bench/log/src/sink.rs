//! Targets to which a log is written.

use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::LogError;

/// A target of a log.
pub trait Sink: Write {
    /// Waits until what was written survives a power cut.
    ///
    /// # Errors
    /// What the operating system says.
    fn sync(&mut self) -> io::Result<()>;

    /// The log is complete: a file gets its final name.
    ///
    /// # Errors
    /// What the operating system says.
    fn complete(&mut self) -> io::Result<()>;

    /// Its name in errors.
    fn name(&self) -> String;
}

/// Memory needs no waiting.
impl Sink for Vec<u8> {
    fn sync(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn complete(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn name(&self) -> String {
        "memory".to_owned()
    }
}

/// A file that gets its final name only when it is complete. Until then its name ends in
/// `.partial`.
#[derive(Debug)]
pub struct LogFile {
    file: File,
    path: PathBuf,
    partial: PathBuf,
    /// Whether it can be made again from another file. Then only the complete file must survive a
    /// power cut, and an incomplete one is worthless.
    is_remade: bool,
}

impl LogFile {
    /// A new file, with the temporary name `<path>.partial`.
    ///
    /// # Errors
    /// One of the two names is in use ([`recover`](crate::recover) completes a partial file), or
    /// the file cannot be created.
    pub fn create(path: &Path) -> Result<Self, LogError> {
        let partial = with_suffix(path, ".partial");
        for taken in [path, &partial] {
            if taken.exists() {
                let file = taken.display().to_string();
                return Err(LogError::Exists { file });
            }
        }
        let file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&partial)
            .map_err(|source| LogError::write(&partial, source))?;
        let path = path.to_owned();
        sync_folder(&path);
        Ok(Self {
            file,
            path,
            partial,
            is_remade: false,
        })
    }

    /// A file that is made from another file and can be made again, with the temporary name
    /// `<path>.recovering`.
    pub(crate) fn remake(path: &Path) -> Result<Self, LogError> {
        if path.exists() {
            let file = path.display().to_string();
            return Err(LogError::Exists { file });
        }
        let partial = with_suffix(path, ".recovering");
        Ok(Self {
            file: File::create(&partial).map_err(|source| LogError::write(&partial, source))?,
            path: path.to_owned(),
            partial,
            is_remade: true,
        })
    }
}

impl Write for LogFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Sink for LogFile {
    fn sync(&mut self) -> io::Result<()> {
        if !self.is_remade {
            self.file.sync_data()?;
        }
        Ok(())
    }

    fn complete(&mut self) -> io::Result<()> {
        self.file.sync_all()?;
        std::fs::rename(&self.partial, &self.path)?;
        sync_folder(&self.path);
        Ok(())
    }

    fn name(&self) -> String {
        self.partial.display().to_string()
    }
}

/// A partial file is kept, unless it can be made again.
impl Drop for LogFile {
    fn drop(&mut self) {
        if self.is_remade {
            let _ = std::fs::remove_file(&self.partial); // a complete file has its final name already
        }
    }
}

fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(suffix);
    PathBuf::from(name)
}

/// Makes a file's name survive a power cut, where folders can be synced.
fn sync_folder(file: &Path) {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Ok(folder) = File::open(folder.unwrap_or(Path::new("."))) {
        let _ = folder.sync_all();
    }
}
