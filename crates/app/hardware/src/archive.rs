//! ZIP archives without dates, so that the same files give the same bytes.

use std::io::{Cursor, Write};

use anyhow::{Context, Result};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// An archive of files by their names. All have the earliest date of the format.
pub(crate) fn of(files: &[(String, Vec<u8>)]) -> Result<Vec<u8>> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default());
    for (name, content) in files {
        archive
            .start_file(name, options)
            .with_context(|| format!("{name} in an archive"))?;
        archive.write_all(content)?;
    }
    Ok(archive.finish()?.into_inner())
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::*;

    #[test]
    fn the_same_files_give_the_same_archive_and_come_back() {
        let files = [("a/b.txt", "text ".repeat(1000)), ("c", String::new())];
        let files = files.map(|(name, text)| (name.to_owned(), text.into_bytes()));
        let bytes = of(&files).unwrap();
        assert_eq!(bytes, of(&files).unwrap());
        assert!(bytes.len() < 1000, "it is compressed");
        let mut found = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
        for (name, content) in &files {
            let mut file = found.by_name(name).unwrap();
            assert_eq!(file.last_modified().unwrap().year(), 1980);
            let mut read = Vec::new();
            file.read_to_end(&mut read).unwrap();
            assert_eq!(read, *content);
        }
    }
}
