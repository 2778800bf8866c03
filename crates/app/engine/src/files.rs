//! Files that a description names. A page has no folders, so they are stored by name.

use std::collections::BTreeMap;
use std::io::{Error, ErrorKind};

/// The stored files, by their full names and by their names without folders.
#[derive(Default)]
pub(crate) struct Files(BTreeMap<String, Vec<u8>>);

impl Files {
    /// Stores a file; it replaces one of the same name.
    pub(crate) fn keep(&mut self, name: &str, bytes: &[u8]) {
        for name in [name, base_name(name)] {
            self.0.insert(name.to_owned(), bytes.to_owned());
        }
    }

    /// The bytes of the file at a path, or else of the stored file with whose name the path ends.
    pub(crate) fn load(&self, path: &str) -> std::io::Result<Vec<u8>> {
        let found = self.0.get(path).or_else(|| self.0.get(base_name(path))).cloned();
        let missing = || {
            Error::new(
                ErrorKind::NotFound,
                format!("drop `{}` on the page as well", base_name(path)),
            )
        };
        found.ok_or_else(missing)
    }
}

fn base_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}
