//! Parses and checks import descriptions, and merges in what they override for a file.

use std::collections::BTreeSet;
use std::path::Path;

use twintac_config::{ConfigError, Document};

use super::Import;
use super::description::{Column, Description, Split};
use super::unit::Unit;
use crate::RecordingError;

/// Fields that hold for files whose names match.
#[derive(Clone, Debug)]
pub(crate) struct Override {
    files: String,
    fields: toml::Table,
}

impl Import {
    /// Parses an import description; `file` names it in errors.
    ///
    /// # Errors
    ///
    /// What is wrong, with the line and the field.
    pub fn parse(file: &str, text: &str) -> Result<Self, RecordingError> {
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
                return Err(document.error(&field, "has no text `files`", hint).into());
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

    /// The description with all overrides that match the file's name, later ones last.
    pub(crate) fn for_file(&self, path: &Path) -> Result<Description, RecordingError> {
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
        // Each override was merged and checked on its own; several together can still contradict each other.
        let contradiction = |problem: String| RecordingError::Inconsistent {
            place: path.display().to_string(),
            problem: format!("the overrides for it do not go together: {problem}"),
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

/// Tables are merged field by field, everything else is replaced.
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

/// Whether a file name matches a pattern in which `*` stands for any text and `?` for one character.
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

/// A field that parses but makes no sense.
struct Problem {
    field: String,
    problem: String,
    hint: &'static str,
}

impl Problem {
    fn at(self, document: &Document<Description>, prefix: &str) -> ConfigError {
        document.error(&format!("{prefix}{}", self.field), self.problem, self.hint)
    }
}

fn require(
    holds: bool,
    field: impl Into<String>,
    problem: impl Into<String>,
    hint: &'static str,
) -> Result<(), Problem> {
    if holds {
        Ok(())
    } else {
        Err(Problem {
            field: field.into(),
            problem: problem.into(),
            hint,
        })
    }
}

fn check(d: &Description) -> Result<(), Problem> {
    let finite = "give a finite number";
    require(
        d.delimiter.is_ascii(),
        "delimiter",
        "is not ASCII",
        "use a comma, a semicolon or a tab",
    )?;
    require(d.gel_top_mm.is_finite(), "gel_top_mm", "is not finite", finite)?;
    require(
        d.contact.z_mm.is_finite(),
        "contact.z_mm",
        "is not finite",
        finite,
    )?;
    require(
        !d.taxels.is_empty(),
        "taxels",
        "is empty",
        "name at least one taxel",
    )?;
    require(
        d.readings.usable[0] < d.readings.usable[1],
        "readings.usable",
        "is empty",
        "give [lowest, highest]",
    )?;
    let mut names = BTreeSet::new();
    for (index, taxel) in d.taxels.iter().enumerate() {
        let field = |field: &str| format!("taxels[{index}].{field}");
        require(
            names.insert(&taxel.name),
            field("name"),
            "is there twice",
            "name each taxel once",
        )?;
        require(
            !taxel.name.is_empty(),
            field("name"),
            "is empty",
            "use the name in the sensor description",
        )?;
        require(
            taxel.scale.is_normal(),
            field("scale"),
            format!("is {}", taxel.scale),
            "give a scale that is not 0",
        )?;
        require(
            taxel.offset_kpa.is_finite(),
            field("offset_kpa"),
            "is not finite",
            finite,
        )?;
        require(taxel.lag_s.is_finite(), field("lag_s"), "is not finite", finite)?;
    }
    check_column("x", &d.x)?;
    check_column("y", &d.y)?;
    d.z.as_ref().map_or(Ok(()), |column| check_column("z", column))?;
    d.time
        .as_ref()
        .map_or(Ok(()), |column| check_column("time", column))?;
    d.force
        .as_ref()
        .map_or(Ok(()), |column| check_column("force", column))?;
    let is_static = matches!(d.presses, Split::Row);
    let has_time = d.time.as_ref().is_some_and(|time| time.column.is_some());
    require(
        is_static || has_time,
        "time",
        "has no column",
        "name the column of the time, or split presses by row",
    )?;
    let lagging = d.taxels.iter().any(|taxel| taxel.lag_s != 0.0);
    require(
        has_time || (!lagging && !d.drop_buffered),
        "time",
        "has no column",
        "lags and buffered rows need times",
    )?;
    require(
        !(is_static && lagging),
        "presses.split",
        "is by row",
        "static presses have no lags: leave out lag_s",
    )?;
    require(
        d.z.is_some() || d.weight_n.is_some(),
        "z",
        "is missing",
        "give z, or weight_n for a dead weight",
    )?;
    let both = d.force.is_some() && d.weight_n.is_some();
    require(
        !both,
        "weight_n",
        "stands beside `force`",
        "give the measured force or the dead weight",
    )?;
    let weight = d.weight_n.unwrap_or(1.0);
    require(
        weight > 0.0 && weight.is_finite(),
        "weight_n",
        format!("is {weight} N"),
        "give a weight above 0",
    )?;
    if let Split::ReturnToRest {
        rest_mm,
        tolerance_mm,
        keep_rest_s,
    } = d.presses
    {
        let hint = "finite numbers; tolerance_mm and keep_rest_s not below 0";
        let good = rest_mm.is_finite() && (0.0..f64::INFINITY).contains(&tolerance_mm) && keep_rest_s >= 0.0;
        require(good, "presses", "has impossible numbers", hint)?;
        require(
            d.z.is_some(),
            "z",
            "is missing",
            "splitting at the return to rest needs z",
        )?;
    }
    if let Some(zero) = d.zero {
        require(
            !is_static && d.z.is_some(),
            "zero",
            "needs frames before the contact",
            "leave it out for static presses",
        )?;
        require(
            zero.above_contact_mm.is_finite(),
            "zero.above_contact_mm",
            "is not finite",
            finite,
        )?;
        require(
            zero.window_s > 0.0,
            "zero.window_s",
            format!("is {} s", zero.window_s),
            "give a time above 0",
        )?;
    }
    if let Some(outliers) = d.outliers {
        require(
            is_static,
            "outliers",
            "are for static presses",
            "leave it out, or split presses by row",
        )?;
        let good = outliers.within_mm > 0.0 && outliers.jump > 0.0;
        require(
            good,
            "outliers",
            "has numbers that are not above 0",
            "give within_mm and jump above 0",
        )?;
    }
    Ok(())
}

fn check_column<U: Unit>(name: &str, column: &Column<U>) -> Result<(), Problem> {
    let factor = column.scale / column.divide_by;
    let hint = "give finite numbers, scale and divide_by not 0";
    require(
        factor.is_normal() && column.offset.is_finite(),
        name,
        "has impossible numbers",
        hint,
    )
}

impl Description {
    /// All columns that are read.
    pub(crate) fn column_names(&self) -> BTreeSet<&str> {
        let mut names: BTreeSet<&str> = self.taxels.iter().map(|taxel| taxel.column.as_str()).collect();
        names.extend(self.time.as_ref().and_then(|time| time.column.as_deref()));
        names.extend(self.x.column.as_deref());
        names.extend(self.y.column.as_deref());
        names.extend(self.z.as_ref().and_then(|z| z.column.as_deref()));
        names.extend(self.force.as_ref().and_then(|force| force.column.as_deref()));
        if let Split::Column { column } = &self.presses {
            names.insert(column);
        }
        names
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
