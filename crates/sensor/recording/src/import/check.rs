//! What has to hold of an import description.

use std::collections::BTreeSet;

use twintac_config::{ConfigError, Document};

use super::description::{Column, Description, Split};
use super::unit::Unit;

const FINITE: &str = "give a finite number";

/// A field that parses but makes no sense.
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

/// The first field that makes no sense.
pub(super) fn check(d: &Description) -> Result<(), Problem> {
    check_numbers(d)?;
    check_taxels(d)?;
    check_columns(d)?;
    let is_static = matches!(d.presses, Split::Row);
    check_times(d, is_static)?;
    check_load(d)?;
    check_presses(d)?;
    check_zero(d, is_static)?;
    check_outliers(d, is_static)
}

fn check_numbers(d: &Description) -> Result<(), Problem> {
    require(
        d.delimiter.is_ascii(),
        "delimiter",
        "is not ASCII",
        "use a comma, a semicolon or a tab",
    )?;
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
            FINITE,
        )?;
        require(taxel.lag_s.is_finite(), field("lag_s"), "is not finite", FINITE)?;
    }
    Ok(())
}

fn check_columns(d: &Description) -> Result<(), Problem> {
    check_column("x", &d.x)?;
    check_column("y", &d.y)?;
    d.z.as_ref().map_or(Ok(()), |column| check_column("z", column))?;
    d.time
        .as_ref()
        .map_or(Ok(()), |column| check_column("time", column))?;
    d.force
        .as_ref()
        .map_or(Ok(()), |column| check_column("force", column))?;
    Ok(())
}

fn check_times(d: &Description, is_static: bool) -> Result<(), Problem> {
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
    Ok(())
}

fn check_load(d: &Description) -> Result<(), Problem> {
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
    Ok(())
}

fn check_presses(d: &Description) -> Result<(), Problem> {
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
    let factor = column.scale / column.divide_by;
    let hint = "give finite numbers, scale and divide_by not 0";
    require(
        factor.is_normal() && column.offset.is_finite(),
        name,
        "has impossible numbers",
        hint,
    )
}
