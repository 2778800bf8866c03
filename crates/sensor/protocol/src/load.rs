//! Weights put on the gel: steps of a known force.

use serde::{Deserialize, Serialize};
use twintac_config::{ConfigError, Document};

use twintac_random::stream;

use crate::part::{LONGEST_S, name_of, once};
use crate::{Indenters, Places, PlanError, Range, Target};

/// Largest weight, N: about that of 100 kg.
const MOST_N: f64 = 1000.0;

/// Weights that are put on, left there and taken off, in the form of the file.
///
/// The force is known from the weight, so it may be smaller than a force sensor can detect. No
/// robot carries the weight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Prefix of the names of its loads.
    pub name: String,
    /// Its purpose.
    pub summary: String,
    /// Indenters that stand on the gel, one after the other.
    pub indenters: Indenters,
    /// Locations where they stand.
    pub places: Places,
    /// Weight, indenter included, N.
    pub force_n: Range,
    /// Time without the weight, before and after, s.
    pub rest_s: f64,
    /// Time with the weight, s.
    pub hold_s: f64,
    /// How often the whole list of locations is loaded.
    #[serde(default = "once")]
    pub repeats: u32,
}

/// One planned load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LoadPlan {
    /// Unique in its protocol: `<load>-<indenter>#<number>`.
    pub name: String,
    /// Name of the indenter in the sensor description.
    pub indenter: String,
    /// x of the indenter's origin in the gel's frame, mm.
    pub x_mm: f64,
    /// y of the indenter's origin in the gel's frame, mm.
    pub y_mm: f64,
    /// Weight, N.
    pub force_n: f64,
    /// Time without the weight, before and after, s.
    pub rest_s: f64,
    /// Time with the weight, s.
    pub hold_s: f64,
}

impl Load {
    /// Checks the load. `within` is the path of the table with the load's fields.
    pub(crate) fn check<T>(&self, document: &Document<T>, within: &str) -> Result<(), ConfigError> {
        let error = |field: &str, problem: String, hint: &str| {
            Err(document.error(&format!("{within}{field}"), problem, hint))
        };
        let bounds = [
            ("force_n", &self.force_n, [1e-6, MOST_N]),
            ("rest_s", &Range::Fixed(self.rest_s), [0.1, LONGEST_S]),
            ("hold_s", &Range::Fixed(self.hold_s), [0.1, LONGEST_S]),
        ];
        for (field, range, bounds) in bounds {
            if let Some((problem, hint)) = range.problem(bounds) {
                return error(field, problem, &hint);
            }
        }
        if let Some((field, problem, hint)) = self.indenters.problem() {
            return error(&field, problem, hint);
        }
        if let Some((field, problem, hint)) = self.places.problem(self.repeats) {
            return error(&field, problem, &hint);
        }
        Ok(())
    }

    pub(crate) fn plan(&self, target: &Target, seed: u64) -> Result<Vec<LoadPlan>, PlanError> {
        let spots = self.places.on(target)?;
        let mut plans = Vec::new();
        for indenter in self.indenters.named(target)? {
            for number in 0..self.repeats * spots.count() {
                let name = name_of(&self.name, indenter, number);
                let mut random = stream(seed, &name);
                let [x_mm, y_mm] = spots.at(number % spots.count(), &mut random);
                plans.push(LoadPlan {
                    name,
                    indenter: indenter.clone(),
                    x_mm,
                    y_mm,
                    force_n: self.force_n.draw(&mut random),
                    rest_s: self.rest_s,
                    hold_s: self.hold_s,
                });
            }
        }
        Ok(plans)
    }
}

/// Time to put a weight on or to take it off, s.
const MOVE_S: f64 = 0.1;

impl LoadPlan {
    /// Time, s, and force on the gel, N, at a frame rate.
    #[must_use]
    pub fn course(&self, rate_hz: f64) -> Vec<(f64, f64)> {
        let on_s = self.rest_s + MOVE_S;
        let off_s = on_s + self.hold_s + MOVE_S;
        let n_frames = ((off_s + self.rest_s) * rate_hz).ceil() as usize + 1;
        (0..n_frames)
            .map(|frame| {
                let time_s = frame as f64 / rate_hz;
                let part = ((time_s - self.rest_s) / MOVE_S).min((off_s - time_s) / MOVE_S);
                (time_s, self.force_n * part.clamp(0.0, 1.0))
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_weight_is_put_on_left_there_and_taken_off() {
        let plan = LoadPlan {
            name: "least-ball#000".into(),
            indenter: "ball".into(),
            x_mm: 0.0,
            y_mm: 0.0,
            force_n: 0.007,
            rest_s: 1.0,
            hold_s: 2.0,
        };
        let course = plan.course(50.0);
        let with_it = course.iter().filter(|(_, force_n)| *force_n == 0.007).count();
        let without = course.iter().filter(|(_, force_n)| *force_n == 0.0).count();
        assert!((100..=102).contains(&with_it), "{with_it}");
        assert!((100..=104).contains(&without), "{without}");
        assert!((course[course.len() - 1].0 - 4.2).abs() < 1e-9);
    }
}
