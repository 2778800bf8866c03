//! A first import description for a file without one: a guess for each field, and what it was
//! guessed from.

mod bag;
mod column;
mod fields;
mod layout;
mod roles;
mod unit;

use std::path::Path;

use bag::Guessed;
use layout::Layout;
use roles::Roles;

use super::bag::ReadBag;
use super::text::Text;
use crate::RecordingError;

/// The text of an import description for a text file with columns. It can be used as it is. Fields
/// that cannot be found in the file are marked with TODO.
///
/// # Errors
/// The file cannot be read, or has no rows of numbers.
pub fn guess_import(path: &Path) -> Result<String, RecordingError> {
    let text = Text::read(path, 0)?;
    let layout = Layout::find(text.rest()).ok_or_else(|| RecordingError::Line {
        file: path.display().to_string(),
        line: 1,
        problem:
            "no rows of numbers with the same separator were found; name the columns in an import description"
                .to_owned(),
    })?;
    let columns = layout.columns(text.rest());
    let roles = Roles::new(&columns);
    Ok(fields::write(&file_name(path), Some(&layout), &columns, &roles))
}

/// Like [`guess_import`], for a bag that `read_bag` reads. `None` if the file is not a bag.
///
/// # Errors
/// The bag cannot be read, or no topic looks like readings of taxels.
pub fn guess_bag_import(path: &Path, read_bag: ReadBag) -> Option<Result<String, RecordingError>> {
    let bag = read_bag(path, &[])?;
    let guess = bag
        .and_then(|bag| Guessed::new(path, &bag, read_bag))
        .map(|guessed| fields::write(&file_name(path), None, &[], &guessed.roles()));
    Some(guess)
}

fn file_name(path: &Path) -> String {
    path.file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}
