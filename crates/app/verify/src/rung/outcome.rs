//! What a rung comes to.

use serde::Serialize;
use twintac_plot::Scene;

/// What a rung comes to.
#[derive(Default)]
pub(crate) struct Outcome {
    /// What was done, in a few sentences.
    pub(crate) done: String,
    pub(crate) figures: Vec<Figure>,
    pub(crate) plots: Vec<Plot>,
}

/// A number, and what it has to be.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Figure {
    pub(crate) name: String,
    pub(crate) value: f64,
    pub(crate) unit: &'static str,
    pub(crate) limit: Limit,
    pub(crate) holds: bool,
}

/// What a number has to be.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Limit {
    /// Its size, whatever its sign.
    AtMost(f64),
    AtLeast(f64),
    /// Told for what it is worth.
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
    /// A number whose size has a limit; what is no number does not hold.
    pub(crate) fn at_most(limit: f64, name: impl Into<String>, value: f64, unit: &'static str) -> Self {
        Self {
            name: name.into(),
            value,
            unit,
            limit: Limit::AtMost(limit),
            holds: value.abs() <= limit,
        }
    }

    /// A number that has to reach another.
    pub(crate) fn at_least(limit: f64, name: impl Into<String>, value: f64, unit: &'static str) -> Self {
        Self {
            name: name.into(),
            value,
            unit,
            limit: Limit::AtLeast(limit),
            holds: value >= limit,
        }
    }

    /// A number that is told, not judged.
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
    /// Whether every figure holds, of which there has to be one.
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
