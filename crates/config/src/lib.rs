//! Reads the TOML files that people write; every error names the file, the line and the field.
//!
//! Parse once into a serde type, keep the [`Document`], and report what validation finds through [`Document::error`], which
//! looks up the line of the field:
//!
//! ```
//! #[derive(serde::Deserialize)]
//! struct Gel { height_mm: f64 }
//! let document = twintac_config::parse::<Gel>("gel.toml", "# a comment\nheight_mm = -1.0\n").unwrap();
//! let error = document.error("height_mm", "is -1 mm", "give a height above zero");
//! assert_eq!(error.to_string(), "gel.toml:2: `height_mm` is -1 mm; give a height above zero");
//! ```

use serde::de::DeserializeOwned;

/// A parsed file together with its text, so that later findings can name the line.
#[derive(Clone, Debug)]
pub struct Document<T> {
    /// What the file says.
    pub value: T,
    /// The name of the file, as the user gave it.
    pub file: String,
    text: String,
}

/// One thing wrong in one file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: `{field}` {problem}; {hint}")]
pub struct ConfigError {
    /// The file as the user named it.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Dotted path of the field, with array indices from 0: `taxels[3].x_mm`.
    pub field: String,
    /// What is wrong, read after the field's name.
    pub problem: String,
    /// What to do about it.
    pub hint: String,
}

/// Parses a TOML text. Unknown fields, wrong types and missing fields come back with their line.
pub fn parse<T: DeserializeOwned>(file: &str, text: &str) -> Result<Document<T>, ConfigError> {
    let _ = (file, text);
    unimplemented!("written by the owner of this crate")
}

impl<T> Document<T> {
    /// Reports a problem with a field at the field's own line (or its nearest existing parent's).
    pub fn error(&self, field: &str, problem: impl Into<String>, hint: impl Into<String>) -> ConfigError {
        let _ = (field, problem.into(), hint.into(), &self.text);
        unimplemented!("written by the owner of this crate")
    }
}
