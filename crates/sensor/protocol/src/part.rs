//! Presses of one kind, in the form of the file.

use glam::{DQuat, DVec3};
use rand::Rng;
use serde::{Deserialize, Serialize};
use twintac_config::{ConfigError, Document};

use twintac_random::stream;

use crate::places::Spots;
use crate::{Indenters, Places, PlanError, PressPlan, Range, Target};

/// Presses to a depth: a whole protocol, or a part of one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Prefix of the names of its presses. A protocol of a single part needs none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Its purpose.
    pub summary: String,
    /// Indenters that press, one after the other.
    pub indenters: Indenters,
    /// Locations of the presses.
    pub places: Places,
    /// Depth below the first touch, mm.
    pub depth_mm: Range,
    /// Speed of approach and retreat, mm/s.
    pub speed_mm_per_s: Range,
    /// Time at full depth, s.
    pub hold_s: Range,
    /// Yaw: rotation about the vertical, radians.
    #[serde(default)]
    pub yaw_rad: Range,
    /// Tilt from the vertical, in a random direction, radians.
    #[serde(default)]
    pub tilt_rad: Range,
    /// Height above the first touch at which a press starts and ends, mm.
    pub clearance_mm: f64,
    /// How often the whole list of locations is pressed.
    #[serde(default = "once")]
    pub repeats: u32,
}

/// Largest distance, mm, and speed, mm/s, of a press: beyond any gel and any robot arm.
const MOST_MM: f64 = 1000.0;
const MOST_MM_PER_S: f64 = 1000.0;

/// Longest phase of a press, s: the frames of an hour fit in memory.
pub(crate) const LONGEST_S: f64 = 3600.0;

/// Largest yaw, radians.
const MOST_YAW_RAD: f64 = 100.0;

pub(crate) fn once() -> u32 {
    1
}

/// The name of a press or a load.
pub(crate) fn name_of(part: &str, indenter: &str, number: u32) -> String {
    let dash = if part.is_empty() { "" } else { "-" };
    format!("{part}{dash}{indenter}#{number:03}")
}

/// The presses of one part with one indenter.
pub(crate) struct Series<'a> {
    part: &'a Part,
    indenter: &'a str,
    spots: Spots<'a>,
}

impl Series<'_> {
    /// Number of presses.
    pub(crate) fn count(&self) -> u32 {
        self.part.repeats * self.spots.count()
    }

    /// The press with this number, counted from 0.
    pub(crate) fn press(&self, number: u32, seed: u64) -> PressPlan {
        self.part.press(self.indenter, &self.spots, number, seed)
    }
}

impl Part {
    /// Checks the part. `within` is the path of the table with the part's fields.
    pub(crate) fn check<T>(&self, document: &Document<T>, within: &str) -> Result<(), ConfigError> {
        let error = |field: &str, problem: String, hint: &str| {
            Err(document.error(&format!("{within}{field}"), problem, hint))
        };
        let bounds = [
            ("depth_mm", &self.depth_mm, [1e-3, MOST_MM]),
            ("speed_mm_per_s", &self.speed_mm_per_s, [1e-3, MOST_MM_PER_S]),
            ("hold_s", &self.hold_s, [0.0, LONGEST_S]),
            ("yaw_rad", &self.yaw_rad, [-MOST_YAW_RAD, MOST_YAW_RAD]),
            ("tilt_rad", &self.tilt_rad, [0.0, 1.0]),
            ("clearance_mm", &Range::Fixed(self.clearance_mm), [0.0, MOST_MM]),
        ];
        for (field, range, bounds) in bounds {
            if let Some((problem, hint)) = range.problem(bounds) {
                return error(field, problem, &hint);
            }
        }
        let slowest_mm_per_s = self.speed_mm_per_s.ends()[0];
        let travel_s = (self.depth_mm.ends()[1] + self.clearance_mm) / slowest_mm_per_s;
        if travel_s > LONGEST_S {
            return error(
                "speed_mm_per_s",
                format!("is {slowest_mm_per_s}, so that the way down takes {travel_s:.0} s"),
                &format!("let it take {LONGEST_S} s at most"),
            );
        }
        if let Some((field, problem, hint)) = self.indenters.problem() {
            return error(&field, problem, hint);
        }
        if let Some((field, problem, hint)) = self.places.problem(self.repeats) {
            return error(&field, problem, &hint);
        }
        Ok(())
    }

    /// A series of presses for each indenter: the whole list of locations, as often as it is
    /// repeated.
    pub(crate) fn series<'a>(&'a self, target: &'a Target) -> Result<Vec<Series<'a>>, PlanError> {
        let indenters = self.indenters.named(target)?.iter();
        let series = |indenter: &'a String| {
            Ok(Series {
                part: self,
                indenter,
                spots: self.places.on(target)?,
            })
        };
        indenters.map(series).collect()
    }

    fn press(&self, indenter: &str, spots: &Spots<'_>, number: u32, seed: u64) -> PressPlan {
        let name = name_of(&self.name, indenter, number);
        let mut random = stream(seed, &name);
        let [x_mm, y_mm] = spots.at(number % spots.count(), &mut random);
        let tilt_towards = DQuat::from_rotation_z(std::f64::consts::TAU * random.random::<f64>()) * DVec3::X;
        let tilt = DQuat::from_axis_angle(tilt_towards, self.tilt_rad.draw(&mut random));
        let yaw = DQuat::from_rotation_z(self.yaw_rad.draw(&mut random));
        PressPlan {
            name,
            indenter: indenter.to_owned(),
            x_mm,
            y_mm,
            rotation: tilt * yaw,
            clearance_mm: self.clearance_mm,
            depth_mm: self.depth_mm.draw(&mut random),
            speed_mm_per_s: self.speed_mm_per_s.draw(&mut random),
            hold_s: self.hold_s.draw(&mut random),
        }
    }
}
