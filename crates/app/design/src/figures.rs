//! The figures of a design.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// What limits a design's range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RangeEnd {
    /// The pressed taxel reads the largest value of its chip.
    Saturation,
    /// The description's limit of force.
    Force,
    /// The description's limit of depth, or half of the gel's height.
    Depth,
    /// The solver finds no equilibrium beyond this force: the true range may be larger.
    Solver,
}

impl fmt::Display for RangeEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Saturation => "saturation",
            Self::Force => "force",
            Self::Depth => "depth",
            Self::Solver => "solver",
        })
    }
}

/// The simulated figures of a design, pressed by a ball. "At the force" means at the force of
/// [`Measure`](crate::Measure). The pressed taxel is the one nearest to the middle of all ports.
/// "Between" is the location farthest from the pressed taxel and its next neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    /// Reading of the pressed taxel divided by the force, at the force, kPa/N.
    pub sensitivity_kpa_per_n: f64,
    /// The same for the taxel that reads most, when pressed between taxels, kPa/N. `None` for a
    /// sensor of one taxel.
    pub sensitivity_between_kpa_per_n: Option<f64>,
    /// Depth of the ball at the force, mm.
    pub depth_mm: f64,
    /// Largest force above the pressed taxel that the chip can read and the limits allow, N.
    pub range_n: f64,
    /// What limits the range.
    pub range_end: RangeEnd,
    /// Cross-talk: largest reading of another taxel divided by that of the pressed one, at the
    /// force, %. `None` for a sensor of one taxel.
    pub cross_talk_percent: Option<f64>,
    /// Error of a location found from one frame, root mean square, mm: the Cramér–Rao bound for
    /// unknown location and depth with noise of the readings, at the force; the larger of the
    /// values above a taxel and between taxels. For taxels in one row it is the error along the
    /// row. `None` if the readings do not determine a location.
    pub localization_error_mm: Option<f64>,
    /// Hysteresis: largest difference of the pressed taxel's readings between way down and way up
    /// at the same force, divided by the largest reading, for a press to the depth at the force at
    /// 1 mm/s, %. `None` if the description's material does not relax: the simulation then says
    /// nothing about hysteresis.
    pub hysteresis_percent: Option<f64>,
    /// Smallest force at which some taxel reads three times its noise, when pressed between taxels,
    /// N.
    pub smallest_force_n: f64,
}

/// The name of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Figure {
    /// [`Figures::sensitivity_kpa_per_n`], the more the better.
    SensitivityKpaPerN,
    /// [`Figures::sensitivity_between_kpa_per_n`], the more the better.
    SensitivityBetweenKpaPerN,
    /// [`Figures::range_n`], the more the better.
    RangeN,
    /// [`Figures::cross_talk_percent`], the less the better.
    CrossTalkPercent,
    /// [`Figures::localization_error_mm`], the less the better.
    LocalizationErrorMm,
    /// [`Figures::hysteresis_percent`], the less the better.
    HysteresisPercent,
    /// [`Figures::smallest_force_n`], the less the better.
    SmallestForceN,
}

impl Figure {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::SensitivityKpaPerN,
        Self::SensitivityBetweenKpaPerN,
        Self::RangeN,
        Self::CrossTalkPercent,
        Self::LocalizationErrorMm,
        Self::HysteresisPercent,
        Self::SmallestForceN,
    ];

    /// Its name in tables, with its unit.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::SensitivityKpaPerN => "sensitivity_kpa_per_n",
            Self::SensitivityBetweenKpaPerN => "sensitivity_between_kpa_per_n",
            Self::RangeN => "range_n",
            Self::CrossTalkPercent => "cross_talk_percent",
            Self::LocalizationErrorMm => "localization_error_mm",
            Self::HysteresisPercent => "hysteresis_percent",
            Self::SmallestForceN => "smallest_force_n",
        }
    }

    /// Its label on axes, with its unit.
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::SensitivityKpaPerN => "sensitivity above a taxel, kPa/N",
            Self::SensitivityBetweenKpaPerN => "sensitivity between taxels, kPa/N",
            Self::RangeN => "range, N",
            Self::CrossTalkPercent => "cross-talk, %",
            Self::LocalizationErrorMm => "localization error, mm",
            Self::HysteresisPercent => "hysteresis, %",
            Self::SmallestForceN => "smallest force, N",
        }
    }

    /// Whether larger values are better.
    pub(crate) fn is_better_larger(self) -> bool {
        matches!(
            self,
            Self::SensitivityKpaPerN | Self::SensitivityBetweenKpaPerN | Self::RangeN
        )
    }

    /// Its value, if the design has one.
    #[must_use]
    pub fn of(self, figures: &Figures) -> Option<f64> {
        match self {
            Self::SensitivityKpaPerN => Some(figures.sensitivity_kpa_per_n),
            Self::SensitivityBetweenKpaPerN => figures.sensitivity_between_kpa_per_n,
            Self::RangeN => Some(figures.range_n),
            Self::CrossTalkPercent => figures.cross_talk_percent,
            Self::LocalizationErrorMm => figures.localization_error_mm,
            Self::HysteresisPercent => figures.hysteresis_percent,
            Self::SmallestForceN => Some(figures.smallest_force_n),
        }
    }

    /// Its value with a sign such that smaller is better. A missing value is infinite.
    pub(crate) fn badness(self, figures: &Figures) -> f64 {
        match self.of(figures) {
            Some(value) if self.is_better_larger() => -value,
            Some(value) => value,
            None => f64::INFINITY,
        }
    }
}

impl FromStr for Figure {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|figure| figure.name() == text)
            .ok_or_else(|| {
                let names = Self::ALL.map(Self::name).join(", ");
                format!("`{text}` is not a figure of a design; there are {names}")
            })
    }
}
