//! A first import description of a file that nobody has described: a guess for each field, and what it was guessed from.

mod column;
mod fields;
mod layout;
mod roles;
mod unit;

use std::path::Path;

use layout::Layout;
use roles::Roles;

use super::text::Text;
use crate::RecordingError;

/// The text of an import description for a file. It can be read as it is; what is not in the file is marked with TODO.
///
/// # Errors
/// The file cannot be read, or nothing in it looks like rows of numbers.
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
    let name = path
        .file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    Ok(fields::write(&name, &layout, &columns, &Roles::new(&columns)))
}
