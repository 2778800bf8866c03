//! A column: its name, the unit at the end of the name, and its numbers.

use crate::import::bag::is_bag_column;

/// A column, and its numbers.
pub(super) struct Column {
    pub(super) name: String,
    /// The name in lower case without its unit, and the unit at its end.
    pub(super) base: String,
    pub(super) unit: Option<String>,
    pub(super) numbers: Vec<f64>,
    pub(super) is_text: bool,
    pub(super) is_clock: bool,
}

impl Column {
    pub(super) fn named(name: String) -> Self {
        let lower = name.to_lowercase();
        let (base, unit) = match lower.split_once(['(', '[']) {
            Some((base, unit)) => (base, Some(unit.trim_end_matches([')', ']']))),
            None => match lower.rsplit_once(['_', ' ']) {
                Some((base, unit)) if is_unit(unit) => (base, Some(unit)),
                _ => (&*lower, None),
            },
        };
        Self {
            base: base.trim_matches(['_', ' ', '/', ':']).to_owned(),
            unit: unit.map(str::to_owned),
            numbers: Vec::new(),
            is_text: false,
            is_clock: false,
            name,
        }
    }

    /// The name without its unit. In a bag: the index in an array, or the topic.
    pub(super) fn bare_name(&self) -> String {
        if is_bag_column(&self.name)
            && let Some((topic, field)) = self.name.split_once(':')
        {
            return match field.rsplit_once('.') {
                Some((_, number)) if number.parse::<usize>().is_ok() => format!("t{number}"),
                _ => topic.trim_matches('/').replace('/', "_"),
            };
        }
        let is_same_length = self.name.to_lowercase().len() == self.name.len();
        let bare = self.name.get(..self.base.len()).filter(|_| is_same_length);
        bare.filter(|bare| bare.to_lowercase() == self.base)
            .unwrap_or(&self.name)
            .to_owned()
    }

    /// The name without the digits at its end. `None` if there are none.
    pub(super) fn stem(&self) -> Option<&str> {
        let stem = self
            .base
            .trim_end_matches(|character: char| character.is_ascii_digit());
        (stem.len() < self.base.len()).then_some(stem)
    }

    pub(super) fn range(&self) -> [f64; 2] {
        let finite = self.numbers.iter().filter(|number| number.is_finite());
        finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &number| {
            [low.min(number), high.max(number)]
        })
    }

    pub(super) fn median(&self) -> f64 {
        let mut finite: Vec<f64> = self
            .numbers
            .iter()
            .copied()
            .filter(|number| number.is_finite())
            .collect();
        finite.sort_unstable_by(f64::total_cmp);
        finite.get(finite.len() / 2).copied().unwrap_or(0.0)
    }
}

fn is_unit(word: &str) -> bool {
    let units = [
        "s", "ms", "us", "ns", "mm", "cm", "um", "m", "n", "mn", "kgf", "pa", "hpa", "mbar", "kpa", "bar",
        "psi",
    ];
    units.contains(&word)
}

/// A text as a TOML string.
pub(super) fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}
