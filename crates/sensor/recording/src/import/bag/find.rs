//! Finds the topic and field of a bag's column, or lists what the bag has instead.

use super::{Bag, BagTopic};
use crate::RecordingError;

/// The field for the header times of a topic, s.
pub(super) const STAMP: &str = "stamp";

/// The field for the times at which a topic was recorded, s.
pub(super) const LOG_TIME: &str = "log_time";

/// Smallest number of names in a row that are shortened to the first and the last.
const SHORTENED: usize = 3;

/// Whether a column's name has the form of a bag's, `/topic:field`.
pub(in crate::import) fn is_bag_column(column: &str) -> bool {
    column.starts_with('/') && column.contains(':')
}

/// The topic of a column, and its field.
pub(super) fn find<'bag, 'name>(
    bag: &'bag Bag,
    file: &str,
    column: &'name str,
) -> Result<(&'bag BagTopic, &'name str), RecordingError> {
    let wrong = |problem: String| RecordingError::BagColumn {
        file: file.to_owned(),
        column: column.to_owned(),
        problem,
    };
    let Some((name, field)) = column.split_once(':') else {
        return Err(wrong(format!(
            "is not a column of a bag, which is `/topic:field`; the bag has {}",
            listed(bag)
        )));
    };
    let named = || bag.topics.iter().filter(|topic| topic.name == name);
    let has = |topic: &&BagTopic| match field {
        STAMP => !topic.stamp_ns.is_empty(),
        LOG_TIME => !topic.log_ns.is_empty(),
        _ => topic.columns.contains_key(field),
    };
    if let Some(topic) = named().find(has) {
        return Ok((topic, field));
    }
    Err(wrong(match named().next() {
        None => format!("is of an unknown topic; the bag has {}", listed(bag)),
        Some(topic) => missing(topic, field),
    }))
}

/// Why a topic does not have a field; it follows the column's name.
fn missing(topic: &BagTopic, field: &str) -> String {
    let BagTopic { kind, messages, .. } = topic;
    match &topic.fields {
        Err(why) => format!("is of a topic that cannot be read: {why}"),
        Ok(_) if *messages == 0 => "is of a topic without messages".to_owned(),
        Ok(_) if field == STAMP => {
            format!("is missing, as messages of type {kind} have no header; use `{LOG_TIME}`")
        }
        Ok(fields) => format!(
            "is in none of the {messages} messages of type {kind}, or means several fields; they have {}",
            shortened(fields)
        ),
    }
}

/// The topics of a bag, as text.
pub(in crate::import) fn listed(bag: &Bag) -> String {
    let described = |topic: &BagTopic| {
        let BagTopic {
            name, kind, messages, ..
        } = topic;
        let unread = topic
            .fields
            .as_ref()
            .err()
            .map_or_else(String::new, |why| format!(", cannot be read: {why}"));
        format!("{name} ({kind}, {messages} messages{unread})")
    };
    if bag.topics.is_empty() {
        return "no topics".to_owned();
    }
    let topics: Vec<String> = bag.topics.iter().map(described).collect();
    topics.join(", ")
}

/// Whether two names in a row are elements of one array: `data.0` and `data.1`.
pub(in crate::import) fn is_numbered_alike(one: &str, other: &str) -> bool {
    let stem = |name: &str| {
        name.trim_end_matches(|character: char| character.is_ascii_digit())
            .to_owned()
    };
    stem(one).len() < one.len() && stem(one) == stem(other)
}

/// Names as text. For names in a row that differ only in their last number, only the first and the
/// last are listed.
fn shortened(fields: &[String]) -> String {
    let runs = fields.chunk_by(|one, other| is_numbered_alike(one, other));
    let shown = runs.flat_map(|run| match run {
        [first, .., last] if run.len() >= SHORTENED => vec![format!("{first} to {last}")],
        few => few.to_vec(),
    });
    shown.collect::<Vec<String>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_a_row_are_shortened() {
        let names = ["force.x", "data.0", "data.1", "data.2", "a.0", "a.1", "b2"].map(str::to_owned);
        assert_eq!(shortened(&names), "force.x, data.0 to data.2, a.0, a.1, b2");
    }
}
