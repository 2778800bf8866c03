//! The outcome of a verification test.

use serde::Serialize;
use twintac_plot::Scene;

/// The outcome of a verification test.
#[derive(Default)]
pub(crate) struct Outcome {
    /// The method, in a few sentences.
    pub(crate) done: String,
    pub(crate) figures: Vec<Figure>,
    pub(crate) plots: Vec<Plot>,
}

/// A number and its limit.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Figure {
    pub(crate) name: String,
    pub(crate) value: f64,
    pub(crate) unit: &'static str,
    pub(crate) limit: Limit,
    pub(crate) holds: bool,
}

/// The limit of a number.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Limit {
    /// Limit of the absolute value.
    AtMost(f64),
    AtLeast(f64),
    /// No limit: the number is for information.
    None,
}

/// A plot with its caption.
pub(crate) struct Plot {
    /// Part of the file's name.
    pub(crate) name: &'static str,
    pub(crate) caption: String,
    pub(crate) scene: Scene,
}

impl Figure {
    /// A number whose absolute value has a limit. NaN does not hold.
    pub(crate) fn at_most(limit: f64, name: impl Into<String>, value: f64, unit: &'static str) -> Self {
        Self {
            name: name.into(),
            value,
            unit,
            limit: Limit::AtMost(limit),
            holds: value.abs() <= limit,
        }
    }

    /// A number with a lower limit.
    pub(crate) fn at_least(limit: f64, name: impl Into<String>, value: f64, unit: &'static str) -> Self {
        Self {
            name: name.into(),
            value,
            unit,
            limit: Limit::AtLeast(limit),
            holds: value >= limit,
        }
    }

    /// A number without a limit.
    pub(crate) fn told(name: impl Into<String>, value: f64, unit: &'static str) -> Self {
        Self {
            name: name.into(),
            value,
            unit,
            limit: Limit::None,
            holds: true,
        }
    }
}

impl Outcome {
    /// Whether there is at least one figure, and all hold.
    pub(crate) fn holds(&self) -> bool {
        !self.figures.is_empty() && self.figures.iter().all(|figure| figure.holds)
    }
}

impl std::fmt::Display for Limit {
    fn fmt(&self, out: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::AtMost(limit) => write!(out, "≤ {}", number(*limit)),
            Self::AtLeast(limit) => write!(out, "≥ {}", number(*limit)),
            Self::None => Ok(()),
        }
    }
}

/// A number with four digits.
pub(crate) fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if (1e-2..1e5).contains(&size) => {
            let digits = (3.0 - size.log10().floor()).clamp(0.0, 4.0) as usize;
            let text = format!("{value:.digits$}");
            if text.contains('.') {
                text.trim_end_matches('0').trim_end_matches('.').to_owned()
            } else {
                text
            }
        }
        _ => format!("{value:.2e}"),
    }
}
