//! Former names of fields and tables, which are still read.

use std::borrow::Cow;
use std::ops::Range;

use toml::de::{DeTable, DeValue};

/// Former names, and the names that they have now.
const FORMER: [(&str, &str); 3] = [
    ("imperfection", "variation"),
    ("spin_rad", "yaw_rad"),
    ("spin_walk_rad", "yaw_walk_rad"),
];

/// The text with today's names; its lines stay where they are.
pub(crate) fn renamed<'a>(text: &'a str, table: &DeTable<'_>) -> Cow<'a, str> {
    let mut found = Vec::new();
    find(table, &mut found);
    if found.is_empty() {
        return text.into();
    }
    found.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
    let mut text = text.to_owned();
    for (span, name) in found {
        text.replace_range(span, name);
    }
    text.into()
}

fn find(table: &DeTable<'_>, found: &mut Vec<(Range<usize>, &'static str)>) {
    for (key, value) in table {
        if let Some((_, name)) = FORMER.iter().find(|(former, _)| key.get_ref() == former) {
            found.push((key.span(), name));
        }
        find_in(value.get_ref(), found);
    }
}

fn find_in(value: &DeValue<'_>, found: &mut Vec<(Range<usize>, &'static str)>) {
    match value {
        DeValue::Table(table) => find(table, found),
        DeValue::Array(array) => array.iter().for_each(|value| find_in(value.get_ref(), found)),
        _ => (),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn former_names_are_replaced_as_keys_alone() {
        let text = "summary = \"spin_rad\"\n[[parts]]\n\"spin_rad\" = 1.0 # spin_rad\nrest = { spin_rad = 2 }\n\
                    [imperfection]\nnoise = 1.0\n";
        let table = DeTable::parse(text).unwrap();
        let expected = "summary = \"spin_rad\"\n[[parts]]\nyaw_rad = 1.0 # spin_rad\nrest = { yaw_rad = 2 }\n\
                        [variation]\nnoise = 1.0\n";
        assert_eq!(renamed(text, table.get_ref()), expected);
        let table = DeTable::parse(expected).unwrap();
        assert!(matches!(renamed(expected, table.get_ref()), Cow::Borrowed(_)));
    }
}
