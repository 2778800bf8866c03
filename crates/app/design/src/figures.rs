//! What a sensor of a design does, figure by figure.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// What ends a design's range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RangeEnd {
    /// The pressed taxel reads the most that its chip can.
    Saturation,
    /// The description's limit of force.
    Force,
    /// The description's limit of depth, or half of the gel's height.
    Depth,
    /// The gel's equilibrium is not found beyond: the sensor's range may be larger.
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

/// What a sensor of a design does, simulated, pressed by a ball. "At the force" is the force of [`Measure`](crate::Measure). The pressed taxel is the one nearest to the middle of all ports;
/// "between" is the place as far as possible from it and its next neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    /// Reading of the pressed taxel over the force, at the force, kPa/N.
    pub sensitivity_kpa_per_n: f64,
    /// The same of the taxel that reads most, pressed between taxels, kPa/N. `None` of one taxel alone.
    pub sensitivity_between_kpa_per_n: Option<f64>,
    /// How deep the ball is at the force, mm.
    pub depth_mm: f64,
    /// Largest force that is read and stood, above the pressed taxel, N.
    pub range_n: f64,
    /// What ends the range.
    pub range_end: RangeEnd,
    /// Largest reading of another taxel over that of the pressed one, at the force, %. `None` of one taxel alone.
    pub cross_talk_percent: Option<f64>,
    /// How far off a place found from one frame is, root mean square: the bound of Cramér and Rao for unknown place and depth and noise of the readings, at the force, the worse of above a
    /// taxel and between, mm. Of taxels in one row along the row alone. `None` where no place can be found.
    pub localization_error_mm: Option<f64>,
    /// Largest difference of the pressed taxel's readings between way down and way up at the same force over the largest, of a press to the depth at the force at 1 mm/s, %.
    /// `None` where the description's material does not relax: it says nothing then.
    pub hysteresis_percent: Option<f64>,
    /// Force at which some taxel reads three times its noise, pressed between taxels, N.
    pub smallest_force_n: f64,
}

/// One of the figures, by name.
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

    /// Its name, as in tables: with its unit.
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

    /// Its name with the unit as on axes.
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

    /// Whether more of it is better.
    pub(crate) fn is_better_larger(self) -> bool {
        matches!(
            self,
            Self::SensitivityKpaPerN | Self::SensitivityBetweenKpaPerN | Self::RangeN
        )
    }

    /// Its value, if the design has it.
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

    /// Its value, turned so that less is better; what is not there is infinitely bad.
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
                format!("`{text}` is no figure of a design; there are {names}")
            })
    }
}
