//! Guesses units of columns from their names or from the size of their numbers.

use super::column::{Column, quoted};

/// Readings of an untouched sensor in each unit: the atmospheric pressure.
const AIR: [(&str, [f64; 2]); 5] = [
    ("Pa", [80_000.0, 115_000.0]),
    ("hPa", [800.0, 1150.0]),
    ("kPa", [80.0, 115.0]),
    ("psi", [11.6, 16.7]),
    ("bar", [0.8, 1.15]),
];

/// Units of time, and how many of each are in a second.
const TIMES: [(&str, f64); 4] = [("s", 1.0), ("ms", 1e3), ("us", 1e6), ("ns", 1e9)];

/// Smallest and largest time between two rows of such a sensor, s.
const STEP_S: [f64; 2] = [5e-4, 1.0];

/// A counter that falls after it exceeded this fraction of its range has rolled over.
const FULL: f64 = 0.95;

/// A unit of length, and what it was guessed from.
pub(super) struct Length {
    pub(super) name: &'static str,
    pub(super) mm: f64,
    pub(super) why: &'static str,
}

impl Length {
    /// The unit of a position, from the column's name or from its range.
    pub(super) fn of(column: &Column) -> Self {
        let [low, high] = column.range();
        let (name, why) = match (column.unit.as_deref(), high - low) {
            (Some("mm"), _) => ("mm", ""),
            (Some("cm"), _) => ("cm", ""),
            (Some("um"), _) => ("um", ""),
            (Some("m"), _) => ("m", ""),
            (_, range) if range > 0.0 && range < 0.06 => (
                "m",
                "it ranges over so little that it would be hundredths of a millimetre",
            ),
            (_, range) if range > 500.0 => ("um", "it ranges over so much that it would be metres"),
            _ => ("mm", "a guess"),
        };
        let mm = match name {
            "m" => 1e3,
            "cm" => 10.0,
            "um" => 1e-3,
            _ => 1.0,
        };
        Self { name, mm, why }
    }
}

/// The unit of readings, and what it was guessed from.
pub(super) fn pressure(taxels: &[&Column]) -> (&'static str, String) {
    let by_name = taxels.first().and_then(|taxel| taxel.unit.as_deref());
    let is_named = |unit: &str| {
        by_name.is_some_and(|name| name == unit.to_lowercase() || name == "mbar" && unit == "hPa")
    };
    if let Some((unit, _)) = AIR.into_iter().find(|(unit, _)| is_named(unit)) {
        return (unit, "by their names".to_owned());
    }
    let median = taxels.get(taxels.len() / 2).map_or(0.0, |taxel| taxel.median());
    let is_air = |[low, high]: [f64; 2]| (low..=high).contains(&median);
    match AIR.into_iter().find(|(_, range)| is_air(*range)) {
        Some((unit, _)) => (
            unit,
            format!("they are about {median:.4}, the pressure of the air"),
        ),
        None => (
            "counts",
            format!("TODO: they are about {median:.4}; give the unit, or the kPa of one count"),
        ),
    }
}

/// The time field, and the resulting frame rate.
pub(super) fn time(column: &Column) -> (String, String) {
    let name = quoted(&column.name);
    if column.is_clock {
        return (
            format!("time = {{ column = {name}, unit = \"clock\" }}"),
            String::new(),
        );
    }
    let pairs = || column.numbers.windows(2).map(|pair| [pair[0], pair[1]]);
    let mut steps: Vec<f64> = pairs()
        .map(|[before, now]| now - before)
        .filter(|step| *step > 0.0)
        .collect();
    steps.sort_unstable_by(f64::total_cmp);
    let step = steps.get(steps.len() / 2).copied().unwrap_or(1.0);
    let named = match &*column.base {
        "millis" => Some("ms"),
        "micros" => Some("us"),
        base => column.unit.as_deref().or(Some(base)),
    };
    let by_name = TIMES.into_iter().find(|(unit, _)| named == Some(*unit));
    let by_step = TIMES
        .into_iter()
        .find(|(_, per_s)| (STEP_S[0]..STEP_S[1]).contains(&(step / per_s)));
    let (unit, per_s) = by_name.or(by_step).unwrap_or(TIMES[0]);
    let falls = pairs().filter(|[before, now]| now < before);
    let highest = falls.map(|[before, _]| before).fold(0.0, f64::max);
    let rolls_over = |wraps_at: &f64| highest < *wraps_at && highest > FULL * wraps_at;
    let wraps_at = [16, 32].map(|bits| 2f64.powi(bits)).into_iter().find(rolls_over);
    let wraps = wraps_at.map_or_else(String::new, |wraps_at| format!(", wraps_at = {wraps_at}"));
    let n_same = pairs().filter(|[before, now]| now == before).count();
    let repeated = if n_same > 0 { ", repeated = \"spread\"" } else { "" };
    let rows_per_step = 1.0 + n_same as f64 / steps.len().max(1) as f64;
    (
        format!("time = {{ column = {name}, unit = \"{unit}\"{wraps}{repeated} }}"),
        format!("{:.1} rows a second", per_s / step * rows_per_step),
    )
}
