//! Opens a file of any kind as a table.

use std::collections::BTreeSet;
use std::path::Path;

use super::bag::{ReadBag, Rows, table};
use super::cell::Kind;
use super::description::{Description, Split, TimeColumn};
use super::table::Table;
use crate::RecordingError;

/// Reads columns of a file: a bag, if a reader for bags is given and accepts it, or else a text
/// with the described layout. `time` is the time column of the file's rows.
pub(super) fn open(
    path: &Path,
    description: &Description,
    wanted: &BTreeSet<(&str, Kind)>,
    time: Option<&TimeColumn>,
    read_bag: Option<ReadBag>,
) -> Result<Table, RecordingError> {
    let file = path.display().to_string();
    let names: Vec<&str> = wanted.iter().map(|(name, _)| *name).collect();
    let Some(bag) = read_bag.and_then(|read| read(path, &names)) else {
        let has_time = time.is_some_and(|time| time.column.is_some());
        if !has_time && !matches!(description.presses, Split::Row) && path.is_file() {
            return Err(RecordingError::Bag {
                file,
                problem: "is not a bag (MCAP), and only a bag needs no `time`; name the column of the time"
                    .to_owned(),
            });
        }
        return Table::read(path, description, wanted);
    };
    let bag = bag?;
    if let Some(provenance) = bag.provenance.filter(|own| *own != description.provenance) {
        return Err(RecordingError::Bag {
            file,
            problem: format!(
                "the file says that its numbers are {provenance}, but the description has `provenance = \"{}\"`",
                description.provenance
            ),
        });
    }
    table(&file, bag, wanted, &Rows::of(description, time, wanted))
}
