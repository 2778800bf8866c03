//! Checks of an import description.

use std::collections::{BTreeMap, BTreeSet};

use glam::DQuat;
use twintac_config::{ConfigError, Document};

use super::description::{Column, Description, JoinClock, Repeated, Split};
use super::unit::{Pressure, Unit};

/// Largest deviation of a quaternion's length from 1.
pub(super) const UNIT_TOLERANCE: f64 = 1e-2;

const FINITE: &str = "give a finite number";

/// A field that can be parsed but is wrong.
pub(super) struct Problem {
    pub(super) field: String,
    pub(super) problem: String,
    hint: &'static str,
}

impl Problem {
    pub(super) fn at(self, document: &Document<Description>, prefix: &str) -> ConfigError {
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

/// Finds the first field that is wrong.
pub(super) fn check(d: &Description) -> Result<(), Problem> {
    check_text(d)?;
    check_numbers(d)?;
    check_readings(d)?;
    check_taxels(d)?;
    check_columns(d)?;
    let is_static = matches!(d.presses, Split::Row);
    check_times(d, is_static)?;
    check_load(d)?;
    check_presses(d)?;
    check_joins(d)?;
    check_zero(d, is_static)?;
    check_outliers(d, is_static)
}

fn check_joins(d: &Description) -> Result<(), Problem> {
    for (index, join) in d.joins.iter().enumerate() {
        let field = |name: &str| format!("join[{index}].{name}");
        let has_time = d.time.as_ref().is_some_and(|time| time.column.is_some());
        require(
            has_time && !matches!(d.presses, Split::Row),
            format!("join[{index}]"),
            "is given in a description whose own files have no time",
            "give the main file's `time` a column, or put the columns into one file",
        )?;
        require(
            !join.file.trim().is_empty() && !join.file.contains(['/', '\\']),
            field("file"),
            format!("is `{}`", join.file),
            "give the name of a file in the same folder, such as \"{stem}-force.csv\"",
        )?;
        let wanted = d.wanted();
        let is_read = |name: &String| wanted.iter().any(|(wanted, _)| wanted == name);
        let unread = join.columns.iter().find(|name| !is_read(name));
        require(
            !join.columns.is_empty() && unread.is_none(),
            field("columns"),
            unread.map_or("is empty".to_owned(), |name| {
                format!("has `{name}`, from which nothing is read")
            }),
            "give the columns that `x`, `y`, `z`, `rotation`, `force`, `presses` or `taxels` name and that are in this file",
        )?;
        require(
            join.time.column.is_some(),
            field("time"),
            "has no column",
            "give the column of its time",
        )?;
        let is_given = match join.clock {
            JoinClock::Given { offset_s, rate } => offset_s.is_finite() && rate.is_finite() && rate > 0.0,
            _ => true,
        };
        require(
            is_given,
            field("clock"),
            "is not finite, or runs backwards",
            FINITE,
        )?;
        require(
            join.within_s > 0.0 && join.within_s.is_finite(),
            field("within_s"),
            format!("is {}", join.within_s),
            "give a time above 0",
        )?;
    }
    Ok(())
}

fn check_text(d: &Description) -> Result<(), Problem> {
    require(
        d.delimiter.is_ascii(),
        "delimiter",
        "is not ASCII",
        "use a comma, a semicolon, a tab or a blank",
    )?;
    require(
        d.comment.is_none_or(|comment| comment.is_ascii()),
        "comment",
        "is not ASCII",
        "use a character such as #",
    )?;
    require(
        matches!(d.decimal, '.' | ','),
        "decimal",
        format!("is `{}`", d.decimal),
        "give a point or a comma",
    )?;
    require(
        d.decimal != d.delimiter,
        "decimal",
        "is also the separator of columns",
        "such files have another delimiter, as in delimiter = \";\"",
    )
}

fn check_numbers(d: &Description) -> Result<(), Problem> {
    require(d.gel_top_mm.is_finite(), "gel_top_mm", "is not finite", FINITE)?;
    require(
        d.contact.z_mm.is_finite(),
        "contact.z_mm",
        "is not finite",
        FINITE,
    )?;
    require(
        !d.taxels.is_empty(),
        "taxels",
        "is empty",
        "name at least one taxel",
    )
}

fn check_readings(d: &Description) -> Result<(), Problem> {
    let are_counts = matches!(d.readings.unit, Pressure::Counts);
    require(
        are_counts == d.readings.kpa_per_count.is_some(),
        "readings.kpa_per_count",
        if are_counts {
            "is missing"
        } else {
            "is given beside a unit of pressure"
        },
        "give it for counts only",
    )?;
    require(
        d.readings.kpa_per_count.is_none_or(f64::is_normal),
        "readings.kpa_per_count",
        "is impossible",
        "give a finite number that is not 0",
    )?;
    require(
        d.temperatures.scale.is_normal(),
        "temperatures.scale",
        format!("is {}", d.temperatures.scale),
        "give a scale that is not 0",
    )?;
    require(
        d.readings.usable[0] < d.readings.usable[1],
        "readings.usable",
        "is empty",
        "give [lowest, highest]",
    )?;
    Ok(())
}

fn check_taxels(d: &Description) -> Result<(), Problem> {
    let (mut names, mut columns) = (BTreeSet::new(), BTreeSet::new());
    for (index, taxel) in d.taxels.iter().enumerate() {
        let field = |field: &str| format!("taxels[{index}].{field}");
        require(
            names.insert(&taxel.name),
            field("name"),
            "is given twice",
            "name each taxel once",
        )?;
        require(
            columns.insert(&taxel.column),
            field("column"),
            format!("`{}` is also the column of another taxel", taxel.column),
            "give each taxel a column of its own",
        )?;
        require(
            taxel.temperature.as_ref() != Some(&taxel.column),
            field("temperature"),
            format!("`{}` is also the column of its readings", taxel.column),
            "give the column of its temperature",
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
            FINITE,
        )?;
        require(taxel.lag_s.is_finite(), field("lag_s"), "is not finite", FINITE)?;
    }
    Ok(())
}

fn check_columns(d: &Description) -> Result<(), Problem> {
    let mut read: BTreeMap<&str, &str> = BTreeMap::new();
    let columns = [
        ("time", d.time.as_ref().and_then(|time| time.column.as_deref())),
        ("x", d.x.column.as_deref()),
        ("y", d.y.column.as_deref()),
        ("z", d.z.as_ref().and_then(|z| z.column.as_deref())),
        (
            "force",
            d.force.as_ref().and_then(|force| force.column.as_deref()),
        ),
    ];
    let taxels = d
        .taxels
        .iter()
        .map(|taxel| ("taxels", Some(taxel.column.as_str())));
    for (field, column) in columns.into_iter().chain(taxels) {
        let Some(column) = column else { continue };
        let other = read.insert(column, field);
        require(
            other.is_none(),
            field,
            format!(
                "reads the column `{column}`, which `{}` reads as well",
                other.unwrap_or_default()
            ),
            "give each quantity a column of its own",
        )?;
    }
    check_column("x", &d.x)?;
    check_column("y", &d.y)?;
    d.z.as_ref().map_or(Ok(()), |column| check_column("z", column))?;
    d.force
        .as_ref()
        .map_or(Ok(()), |column| check_column("force", column))?;
    if let Some(rotation) = &d.rotation {
        let length = DQuat::from_array(rotation.upright).length();
        require(
            (length - 1.0).abs() < UNIT_TOLERANCE,
            "rotation.upright",
            format!("has length {length}"),
            "give a unit quaternion [x, y, z, w]",
        )?;
    }
    Ok(())
}

fn check_times(d: &Description, is_static: bool) -> Result<(), Problem> {
    if let Some(time) = &d.time {
        check_line("time", [time.scale, time.divide_by, time.offset])?;
        let is_count = |count: f64| count.is_finite() && count > 0.0;
        require(
            time.wraps_at.is_none_or(is_count),
            "time.wraps_at",
            "is not above 0",
            "give the number that would follow the largest, such as 4294967296",
        )?;
        let is_rate = !matches!(time.repeated, Repeated::RateHz(rate_hz) if !is_count(rate_hz));
        require(
            is_rate,
            "time.repeated",
            "has an impossible rate",
            "give a rate above 0 Hz",
        )?;
    }
    let has_time = match &d.time {
        Some(time) => time.column.is_some(),
        None => d.is_of_bag(),
    };
    require(
        is_static || has_time,
        "time",
        "has no column",
        "name the column of the time, or split presses by row; only columns `/topic:field` of a bag have a time of their own",
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
    Ok(())
}

fn check_load(d: &Description) -> Result<(), Problem> {
    require(
        d.z.is_some() || d.weight_n.is_some() || matches!(d.presses, Split::None),
        "z",
        "is missing",
        "give z, weight_n for a dead weight, or presses = { split = \"none\" } for a log of readings alone",
    )?;
    let both = d.force.is_some() && d.weight_n.is_some();
    require(
        !both,
        "weight_n",
        "is given beside `force`",
        "give the measured force or the dead weight",
    )?;
    let weight = d.weight_n.unwrap_or(1.0);
    require(
        weight > 0.0 && weight.is_finite(),
        "weight_n",
        format!("is {weight} N"),
        "give a weight above 0",
    )?;
    Ok(())
}

fn check_presses(d: &Description) -> Result<(), Problem> {
    require(
        !(matches!(d.presses, Split::None) && d.zero.is_some()),
        "zero",
        "is given, but there are no presses",
        "leave it out: a log of readings alone keeps them as they are",
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
    Ok(())
}

fn check_zero(d: &Description, is_static: bool) -> Result<(), Problem> {
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
            FINITE,
        )?;
        require(
            zero.window_s > 0.0,
            "zero.window_s",
            format!("is {} s", zero.window_s),
            "give a time above 0",
        )?;
    }
    Ok(())
}

fn check_outliers(d: &Description, is_static: bool) -> Result<(), Problem> {
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
    check_line(name, [column.scale, column.divide_by, column.offset])
}

fn check_line(name: &str, [scale, divide_by, offset]: [f64; 3]) -> Result<(), Problem> {
    let hint = "give finite numbers, scale and divide_by not 0";
    require(
        (scale / divide_by).is_normal() && offset.is_finite(),
        name,
        "has impossible numbers",
        hint,
    )
}
