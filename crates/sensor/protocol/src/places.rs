//! Locations of presses.

use serde::{Deserialize, Serialize};
use twintac_random::RandomStream;

use crate::{PlanError, Range, Target};

/// Largest number of presses with one indenter.
const MOST_PRESSES: u64 = 1_000_000;

/// Largest distance of a location from the gel's origin, mm.
const FARTHEST_MM: f64 = 1000.0;

/// Locations of presses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Places {
    /// A regular grid over a rectangle, including its border; x runs fastest.
    Grid {
        /// The rectangle.
        #[serde(flatten)]
        area: Area,
        /// Number of locations along x and y.
        count: [u32; 2],
    },
    /// Random locations, uniform in a rectangle, different for each indenter.
    Random {
        /// The rectangle.
        #[serde(flatten)]
        area: Area,
        /// Number of locations for each indenter.
        count: u32,
    },
    /// Above taxels.
    Taxels {
        /// Names of the taxels, in this order. Default: all, in the order of the sensor
        /// description.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        names: Option<Vec<String>>,
    },
}

/// A rectangle in the gel's plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Area {
    /// First and last x, mm.
    pub x_mm: [f64; 2],
    /// First and last y, mm.
    pub y_mm: [f64; 2],
}

/// Locations on a given sensor.
pub(crate) enum Spots<'a> {
    Known(Vec<[f64; 2]>),
    Drawn(&'a Area, u32),
}

impl Spots<'_> {
    pub(crate) fn count(&self) -> u32 {
        match self {
            Self::Known(places_mm) => places_mm.len() as u32,
            Self::Drawn(_, count) => *count,
        }
    }

    /// The location with this index, mm.
    pub(crate) fn at(&self, index: u32, random: &mut RandomStream) -> [f64; 2] {
        match self {
            Self::Known(places_mm) => places_mm[index as usize],
            Self::Drawn(area, _) => {
                let x_mm = Range::Between(area.x_mm).draw(random);
                [x_mm, Range::Between(area.y_mm).draw(random)]
            }
        }
    }
}

impl Places {
    pub(crate) fn on(&self, target: &Target) -> Result<Spots<'_>, PlanError> {
        Ok(match self {
            Self::Random { area, count } => Spots::Drawn(area, *count),
            Self::Grid { area, count } => {
                let at = |[low, high]: [f64; 2], index: u32, count: u32| {
                    let fraction = if count > 1 {
                        f64::from(index) / f64::from(count - 1)
                    } else {
                        0.5
                    };
                    low + (high - low) * fraction
                };
                let rows = 0..count[1];
                let place =
                    |row: u32, column: u32| [at(area.x_mm, column, count[0]), at(area.y_mm, row, count[1])];
                Spots::Known(
                    rows.flat_map(|row| (0..count[0]).map(move |column| place(row, column)))
                        .collect(),
                )
            }
            Self::Taxels { names: None } => {
                Spots::Known(target.taxels.iter().map(|(_, at_mm)| *at_mm).collect())
            }
            Self::Taxels { names: Some(names) } => {
                let place = |name: &String| {
                    let found = target.taxels.iter().find(|(taxel, _)| taxel == name);
                    found.map(|(_, at_mm)| *at_mm).ok_or_else(|| PlanError {
                        how: "above",
                        asked: name.clone(),
                        known: target
                            .taxels
                            .iter()
                            .map(|(taxel, _)| taxel.as_str())
                            .collect::<Vec<_>>()
                            .join(", "),
                    })
                };
                Spots::Known(names.iter().map(place).collect::<Result<_, _>>()?)
            }
        })
    }

    /// What is wrong with the locations if each is pressed `repeats` times: the field relative to
    /// the table, the problem and a hint.
    pub(crate) fn problem(&self, repeats: u32) -> Option<(String, String, String)> {
        let wrong =
            |field: &str, problem: String, hint: &str| Some((field.to_owned(), problem, hint.to_owned()));
        let (area, n_places) = match self {
            Self::Grid { area, count } => (Some(area), u64::from(count[0]) * u64::from(count[1])),
            Self::Random { area, count } => (Some(area), u64::from(*count)),
            Self::Taxels { names } => (None, names.as_ref().map_or(1, |names| names.len() as u64)),
        };
        for (field, [low, high]) in area
            .iter()
            .flat_map(|area| [("places.x_mm", area.x_mm), ("places.y_mm", area.y_mm)])
        {
            let is_near = low.abs().max(high.abs()) <= FARTHEST_MM;
            if !is_near {
                let hint = format!("give locations within {FARTHEST_MM} mm of the gel's origin");
                return wrong(field, format!("runs from {low} to {high}"), &hint);
            }
            if low > high {
                return wrong(
                    field,
                    format!("runs from {low} to {high}"),
                    "give the smaller number first",
                );
            }
        }
        if n_places == 0 {
            let field = if area.is_some() {
                "places.count"
            } else {
                "places.names"
            };
            return wrong(field, "is zero".to_owned(), "plan at least one location");
        }
        if repeats == 0 {
            return wrong("repeats", "is zero".to_owned(), "press at least once");
        }
        if n_places.saturating_mul(u64::from(repeats)) > MOST_PRESSES {
            let problem = format!("makes {n_places} locations, each pressed {repeats} times");
            let hint = format!("keep to {MOST_PRESSES} presses an indenter");
            return Some(("places.count".to_owned(), problem, hint));
        }
        None
    }
}
