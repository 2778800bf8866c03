//! Reads the TOML configuration files that people write. Every error names the file, the line and
//! the field.
//!
//! Input: a TOML text, or the path of a file. Output: a value of a serde type, or a [`ConfigError`]
//! that says what is wrong and what to do about it.
//!
//! - [`read`] and [`parse`] give a [`Document`]: the value, together with the text that it came
//!   from. [`read_over`] and [`parse_over`] read files that contain only what differs from a base
//!   value.
//! - [`Checked`] and [`Ranges`] state the allowed range of each number of a settings type.
//! - [`Document::error`] reports what later validation finds, at the line of the field:
//!
//! ```
//! #[derive(serde::Deserialize)]
//! struct Gel { height_mm: f64 }
//! let document = twintac_config::parse::<Gel>("gel.toml", "# a comment\nheight_mm = -1.0\n").unwrap();
//! let error = document.error("height_mm", "is -1 mm", "give a height above zero");
//! assert_eq!(error.to_string(), "gel.toml:2: `height_mm` is -1 mm; give a height above zero");
//! ```
//!
//! # How it works
//!
//! A text is parsed twice: once into a tree that keeps the position (span) of each key and value,
//! and once by serde into the type. When serde reports an error, its position is looked up in the
//! tree, which gives the dotted path of the field and its line. Numbers that are not finite (`nan`,
//! `inf`, `1e999`) are rejected before serde sees them. Names that fields had before are replaced
//! by those of today.
//!
//! Values that parse can still be unusable. A settings type therefore implements [`Checked`]: it
//! passes each of its numbers to [`Ranges`] together with the range in which the number makes
//! sense. [`Document::checked`] reports the first number outside of its range. Tests use
//! [`with_each_number`], which changes one number of a text after the other, to check that each
//! number has a range.
//!
//! This crate depends on no other crate of the workspace: it does not know what the files are
//! about.

mod checked;
mod former;
mod place;
mod tried;

use std::borrow::Cow;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::de::DeTable;

pub use checked::{Checked, Number, Problem, Ranges};
pub use tried::with_each_number;

/// A parsed file together with its text, so that a later error can name the line.
#[derive(Clone, Debug)]
pub struct Document<T> {
    /// The parsed value.
    pub value: T,
    /// The name of the file, as the user gave it.
    pub file: String,
    text: String,
}

/// An error in a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: {}{problem}; {hint}", self.place(), self.subject())]
pub struct ConfigError {
    /// The file, as the user named it.
    pub file: String,
    /// Line, from 1; 0 if the file as a whole could not be read.
    pub line: usize,
    /// Dotted path of the field, with array indices from 0: `taxels[3].x_mm`. For text that is not
    /// TOML, the line itself. Empty if the file as a whole could not be read.
    pub field: String,
    /// What is wrong: the end of a sentence that begins with the field's name.
    pub problem: String,
    /// What to do about it.
    pub hint: String,
}

impl ConfigError {
    fn place(&self) -> String {
        if self.line == 0 {
            self.file.clone()
        } else {
            format!("{}:{}", self.file, self.line)
        }
    }

    fn subject(&self) -> String {
        if self.field.is_empty() {
            String::new()
        } else {
            format!("`{}` ", self.field)
        }
    }
}

/// Parses a TOML text; errors call it `file`.
///
/// # Errors
/// Text that is not TOML, unknown and missing fields, wrong types, and numbers that are not finite
/// (`nan`, `inf`, `1e999`).
pub fn parse<T: DeserializeOwned>(file: &str, text: &str) -> Result<Document<T>, ConfigError> {
    let error = |line: usize, field: String, problem: String, hint: &str| ConfigError {
        file: file.to_owned(),
        line,
        field,
        problem,
        hint: hint.to_owned(),
    };
    let table = DeTable::parse(text).map_err(|found| {
        let start = found.span().map_or(0, |span| span.start);
        let line = place::line_of(text, start);
        let source = text.lines().nth(line - 1).unwrap_or_default().trim().to_owned();
        error(
            line,
            source,
            format!("is not TOML: {}", found.message()),
            "correct the line",
        )
    })?;
    if let Cow::Owned(renamed) = former::renamed(text, table.get_ref()) {
        return parse(file, &renamed);
    }
    if let Some((span, field, number)) = place::not_finite(table.get_ref()) {
        let line = place::line_of(text, span.start);
        return Err(error(line, field, format!("is {number}"), "give a finite number"));
    }
    let value = toml::from_str::<T>(text).map_err(|found| {
        let (line, field) = place::of_serde_error(text, table.get_ref(), &found);
        error(
            line,
            field,
            format!("does not fit: {}", found.message()),
            "correct the name or the value",
        )
    })?;
    Ok(Document {
        value,
        file: file.to_owned(),
        text: text.to_owned(),
    })
}

/// Reads and parses a TOML file; errors name it by its path.
///
/// # Errors
/// Those of [`parse`], and a file that cannot be read or is not UTF-8 (with line 0).
pub fn read<T: DeserializeOwned>(path: impl AsRef<Path>) -> Result<Document<T>, ConfigError> {
    let path = path.as_ref();
    let file = path.display().to_string();
    match std::fs::read_to_string(path) {
        Ok(text) => parse(&file, &text),
        Err(found) => Err(ConfigError {
            file,
            line: 0,
            field: String::new(),
            problem: format!("cannot be read: {found}"),
            hint: "give the path of a readable TOML file".to_owned(),
        }),
    }
}

/// Reads a TOML file that contains only what differs from `base`, in tables of any depth.
///
/// # Errors
/// Those of [`read`].
pub fn read_over<T: DeserializeOwned + Serialize>(
    path: impl AsRef<Path>,
    base: &T,
) -> Result<Document<T>, ConfigError> {
    over(read::<T>(path)?, base)
}

/// Parses a TOML text that contains only what differs from `base`, in tables of any depth; errors
/// call it `file`.
///
/// # Errors
/// Those of [`parse`].
pub fn parse_over<T: DeserializeOwned + Serialize>(
    file: &str,
    text: &str,
    base: &T,
) -> Result<Document<T>, ConfigError> {
    over(parse::<T>(file, text)?, base)
}

fn over<T: DeserializeOwned + Serialize>(
    document: Document<T>,
    base: &T,
) -> Result<Document<T>, ConfigError> {
    let failed = |problem: String| ConfigError {
        file: document.file.clone(),
        line: 0,
        field: String::new(),
        problem: format!("does not fit: {problem}"),
        hint: "correct the file".to_owned(),
    };
    let mut merged = toml::Table::try_from(base).map_err(|found| failed(found.to_string()))?;
    let own = document
        .text
        .parse::<toml::Table>()
        .map_err(|found| failed(found.to_string()))?;
    merge(&mut merged, own);
    let value = merged
        .try_into::<T>()
        .map_err(|found| failed(found.to_string()))?;
    Ok(Document { value, ..document })
}

/// Writes the values of `own` over those of the same name in `base`, table by table.
fn merge(base: &mut toml::Table, own: toml::Table) {
    for (name, value) in own {
        match (base.get_mut(&name), value) {
            (Some(toml::Value::Table(base)), toml::Value::Table(own)) => merge(base, own),
            (_, value) => {
                base.insert(name, value);
            }
        }
    }
}

impl<T> Document<T> {
    /// An error about a field, at the line of the field, or of its nearest parent that the file
    /// contains.
    pub fn error(&self, field: &str, problem: impl Into<String>, hint: impl Into<String>) -> ConfigError {
        let start = DeTable::parse(&self.text)
            .ok()
            .and_then(|table| place::of_field(table.get_ref(), field).0);
        ConfigError {
            file: self.file.clone(),
            line: place::line_of(&self.text, start.unwrap_or(0)),
            field: field.to_owned(),
            problem: problem.into(),
            hint: hint.into(),
        }
    }

    /// Whether the file itself contains this field; a field that takes its default value is not in
    /// the file.
    #[must_use]
    pub fn has(&self, field: &str) -> bool {
        DeTable::parse(&self.text).is_ok_and(|table| place::of_field(table.get_ref(), field).1)
    }
}
