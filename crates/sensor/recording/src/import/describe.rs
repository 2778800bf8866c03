//! Parses import descriptions, and applies their overrides for a file.

use std::path::Path;

use super::check::check;
use super::description::{Description, Split};
use crate::RecordingError;

/// Fields for the files whose names match a pattern.
#[derive(Clone, Debug)]
struct Override {
    files: String,
    fields: toml::Table,
}

/// The description of a test setup's files, with its overrides.
#[derive(Clone, Debug)]
pub(super) struct Descriptions {
    base: Description,
    overrides: Vec<Override>,
    table: toml::Table,
}

impl Descriptions {
    /// Parses an import description. `file` names it in errors.
    pub(super) fn parse(file: &str, text: &str) -> Result<Self, RecordingError> {
        let document = twintac_config::parse::<Description>(file, text)?;
        check(&document.value).map_err(|problem| problem.at(&document, ""))?;
        let mut table = twintac_config::parse::<toml::Table>(file, text)?.value;
        table.remove("override");
        let mut overrides = Vec::new();
        for (index, fields) in document.value.overrides.iter().enumerate() {
            let field = format!("override[{index}]");
            let mut fields = fields.clone();
            let Some(toml::Value::String(files)) = fields.remove("files") else {
                let hint = "name the files that it is for, as in files = \"gelA_*\"";
                return Err(document.error(&field, "has no `files`, a text", hint).into());
            };
            let merged = merge(&table, &fields).map_err(|e| {
                document.error(
                    &field,
                    format!("cannot be merged: {}", e.message()),
                    "give it the fields that the rest has",
                )
            })?;
            check(&merged).map_err(|problem| problem.at(&document, &format!("{field}.")))?;
            overrides.push(Override { files, fields });
        }
        Ok(Self {
            base: document.value,
            overrides,
            table,
        })
    }

    /// Whether files contain presses, unless an override says otherwise.
    pub(super) fn has_presses(&self) -> bool {
        !matches!(self.base.presses, Split::None)
    }

    /// The description for a file, with all overrides that match its name; later ones win.
    pub(super) fn for_file(&self, path: &Path) -> Result<Description, RecordingError> {
        let name = path
            .file_name()
            .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let mut fields = toml::Table::new();
        for one in self.overrides.iter().filter(|one| matches(&one.files, &name)) {
            merge_into(&mut fields, &one.fields);
        }
        if fields.is_empty() {
            return Ok(self.base.clone());
        }
        // Each override was merged and checked alone; several together can still be contradictory.
        let contradiction = |problem: String| RecordingError::Inconsistent {
            place: path.display().to_string(),
            problem: format!("the overrides for it contradict each other: {problem}"),
        };
        let merged = merge(&self.table, &fields).map_err(|e| contradiction(e.message().to_owned()))?;
        check(&merged)
            .map_err(|problem| contradiction(format!("`{}` {}", problem.field, problem.problem)))?;
        Ok(merged)
    }
}

fn merge(base: &toml::Table, fields: &toml::Table) -> Result<Description, toml::de::Error> {
    let mut merged = base.clone();
    merge_into(&mut merged, fields);
    merged.try_into()
}

/// Merges tables field by field. Everything else is replaced.
fn merge_into(base: &mut toml::Table, fields: &toml::Table) {
    for (key, value) in fields {
        match (base.get_mut(key), value) {
            (Some(toml::Value::Table(old)), toml::Value::Table(new)) => merge_into(old, new),
            _ => {
                base.insert(key.clone(), value.clone());
            }
        }
    }
}

/// Whether a file name matches a pattern in which `*` stands for any text and `?` for one
/// character.
fn matches(pattern: &str, name: &str) -> bool {
    let mut rest = pattern.chars();
    match rest.next() {
        None => name.is_empty(),
        Some('*') => {
            let ends = name.char_indices().map(|(at, _)| at).chain([name.len()]);
            ends.into_iter().any(|at| matches(rest.as_str(), &name[at..]))
        }
        Some(wanted) => {
            let mut found = name.chars();
            found.next().is_some_and(|c| wanted == '?' || wanted == c)
                && matches(rest.as_str(), found.as_str())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn patterns_match_names() {
        assert!(matches("gelA_*", "gelA_zv05.csv"));
        assert!(matches("*_20230707_*", "gelD_test_20230707_153948.csv"));
        assert!(matches("DS?0*.csv", "DS20_25psi.csv"));
        assert!(matches("*", ""));
        assert!(!matches("gelA_*", "gelB_zv05.csv"));
        assert!(!matches("gelA", "gelA_"));
    }
}
