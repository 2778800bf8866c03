//! The protocol as people write it.

use glam::{DQuat, DVec3};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use twintac_config::{ConfigError, Document};

use crate::PressPlan;

/// Most presses that one indenter can be planned to do.
const MOST_PRESSES: u64 = 1_000_000;

/// A protocol of presses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Protocol {
    /// What the protocol is for.
    pub summary: String,
    /// Which indenters press, one after the other.
    pub indenters: Indenters,
    /// Where they press.
    pub places: Places,
    /// Depth below first touch, mm.
    pub depth_mm: Range,
    /// Speed of approach and retreat, mm/s.
    pub speed_mm_per_s: Range,
    /// Time at full depth, s.
    pub hold_s: Range,
    /// Turn about the vertical, radians.
    #[serde(default)]
    pub spin_rad: Range,
    /// Tilt away from the vertical, in a random direction, radians.
    #[serde(default)]
    pub tilt_rad: Range,
    /// Height above first touch at which a press starts and ends, mm.
    pub clearance_mm: f64,
    /// How often the whole list of places is pressed.
    #[serde(default = "once")]
    pub repeats: u32,
}

/// Which indenters press.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a list of names or \"all\"")]
pub enum Indenters {
    /// Those named, in this order.
    Named(Vec<String>),
    /// The word `all`: every indenter of the sensor description.
    All(AllWord),
}

/// The word `all`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AllWord {
    /// Every indenter of the sensor description.
    All,
}

/// Where to press.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Places {
    /// A regular grid over a rectangle, its border included, x running fastest.
    Grid {
        /// The rectangle.
        #[serde(flatten)]
        area: Area,
        /// Places along x and y.
        count: [u32; 2],
    },
    /// Places drawn evenly from a rectangle, others for each indenter.
    Random {
        /// The rectangle.
        #[serde(flatten)]
        area: Area,
        /// Places an indenter.
        count: u32,
    },
}

/// A rectangle in the gel's plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Area {
    /// From and to along x, mm.
    pub x_mm: [f64; 2],
    /// From and to along y, mm.
    pub y_mm: [f64; 2],
}

/// One number, or two between which a press's value is drawn evenly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number or [from, to]")]
pub enum Range {
    /// Always the same.
    Fixed(f64),
    /// Drawn between the two.
    Between([f64; 2]),
}

impl Default for Range {
    fn default() -> Self {
        Self::Fixed(0.0)
    }
}

impl Range {
    fn ends(&self) -> [f64; 2] {
        match *self {
            Self::Fixed(value) => [value, value],
            Self::Between(ends) => ends,
        }
    }

    fn draw(&self, chance: &mut ChaCha8Rng) -> f64 {
        let [low, high] = self.ends();
        low + (high - low) * chance.random::<f64>()
    }
}

fn once() -> u32 {
    1
}

/// A protocol that does not fit the sensor.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the protocol presses with `{asked}`, the sensor's description has {known}")]
pub struct PlanError {
    /// The indenter that the protocol names.
    pub asked: String,
    /// The indenters that there are.
    pub known: String,
}

impl Protocol {
    /// Reads a protocol from the text of a TOML file.
    ///
    /// # Errors
    /// The first field that is wrong, with file and line.
    pub fn parse(file: &str, text: &str) -> Result<Self, ConfigError> {
        let document = twintac_config::parse::<Self>(file, text)?;
        document.value.check(&document)?;
        Ok(document.value)
    }

    fn check(&self, document: &Document<Self>) -> Result<(), ConfigError> {
        let smallest = [
            ("depth_mm", self.depth_mm, 1e-3),
            ("speed_mm_per_s", self.speed_mm_per_s, 1e-3),
            ("hold_s", self.hold_s, 0.0),
            ("spin_rad", self.spin_rad, f64::NEG_INFINITY),
            ("tilt_rad", self.tilt_rad, 0.0),
            ("clearance_mm", Range::Fixed(self.clearance_mm), 0.0),
        ];
        for (field, range, least) in smallest {
            let [low, high] = range.ends();
            if low > high {
                return Err(document.error(
                    field,
                    format!("runs from {low} to {high}"),
                    "give the smaller number first",
                ));
            }
            if low < least {
                return Err(document.error(field, format!("is {low}"), format!("give {least} or more")));
            }
        }
        let tilt_rad = self.tilt_rad.ends()[1];
        if tilt_rad > 1.0 {
            return Err(document.error(
                "tilt_rad",
                format!("is {tilt_rad}"),
                "keep the tilt at 1 rad or below",
            ));
        }
        if let Indenters::Named(names) = &self.indenters {
            if names.is_empty() {
                return Err(document.error("indenters", "names none", "name at least one, or give \"all\""));
            }
            for (index, name) in names.iter().enumerate() {
                if names[..index].contains(name) {
                    let problem = format!("is `{name}` again");
                    return Err(document.error(
                        &format!("indenters[{index}]"),
                        problem,
                        "name each indenter once",
                    ));
                }
            }
        }
        let (area, n_places) = match &self.places {
            Places::Grid { area, count } => (area, u64::from(count[0]) * u64::from(count[1])),
            Places::Random { area, count } => (area, u64::from(*count)),
        };
        for (field, [low, high]) in [("places.x_mm", area.x_mm), ("places.y_mm", area.y_mm)] {
            if low > high {
                return Err(document.error(
                    field,
                    format!("runs from {low} to {high}"),
                    "give the smaller number first",
                ));
            }
        }
        if n_places == 0 {
            return Err(document.error("places.count", "is zero", "plan at least one place"));
        }
        if self.repeats == 0 {
            return Err(document.error("repeats", "is zero", "press at least once"));
        }
        if n_places.saturating_mul(u64::from(self.repeats)) > MOST_PRESSES {
            let problem = format!("makes {n_places} places, pressed {} times", self.repeats);
            return Err(document.error(
                "places.count",
                problem,
                format!("keep to {MOST_PRESSES} presses an indenter"),
            ));
        }
        Ok(())
    }

    /// The presses, for a sensor with these indenters: for each indenter, the whole list of places as often
    /// as it is repeated.
    ///
    /// # Errors
    /// An indenter that the sensor does not have.
    pub fn plan(&self, known: &[String], seed: u64) -> Result<Vec<PressPlan>, PlanError> {
        let indenters = match &self.indenters {
            Indenters::All(_) => known,
            Indenters::Named(names) => names,
        };
        let mut plans = Vec::new();
        for indenter in indenters {
            if !known.contains(indenter) {
                return Err(PlanError {
                    asked: indenter.clone(),
                    known: known.join(", "),
                });
            }
            let mut number = 0;
            for _ in 0..self.repeats {
                for place in 0..self.n_places() {
                    plans.push(self.press(indenter, place, number, seed));
                    number += 1;
                }
            }
        }
        Ok(plans)
    }

    fn n_places(&self) -> u32 {
        match &self.places {
            Places::Grid { count, .. } => count[0] * count[1],
            Places::Random { count, .. } => *count,
        }
    }

    fn press(&self, indenter: &str, place: u32, number: u32, seed: u64) -> PressPlan {
        let name = format!("{indenter}#{number:03}");
        let mut chance = stream(seed, &name);
        let (x_mm, y_mm) = match &self.places {
            Places::Grid { area, count } => {
                let at = |[low, high]: [f64; 2], index: u32, count: u32| {
                    let fraction = if count > 1 {
                        f64::from(index) / f64::from(count - 1)
                    } else {
                        0.5
                    };
                    low + (high - low) * fraction
                };
                (
                    at(area.x_mm, place % count[0], count[0]),
                    at(area.y_mm, place / count[0], count[1]),
                )
            }
            Places::Random { area, .. } => {
                let x_mm = Range::Between(area.x_mm).draw(&mut chance);
                (x_mm, Range::Between(area.y_mm).draw(&mut chance))
            }
        };
        let tilt_towards = DQuat::from_rotation_z(std::f64::consts::TAU * chance.random::<f64>()) * DVec3::X;
        let tilt = DQuat::from_axis_angle(tilt_towards, self.tilt_rad.draw(&mut chance));
        let spin = DQuat::from_rotation_z(self.spin_rad.draw(&mut chance));
        PressPlan {
            name,
            indenter: indenter.to_owned(),
            x_mm,
            y_mm,
            rotation: tilt * spin,
            clearance_mm: self.clearance_mm,
            depth_mm: self.depth_mm.draw(&mut chance),
            speed_mm_per_s: self.speed_mm_per_s.draw(&mut chance),
            hold_s: self.hold_s.draw(&mut chance),
        }
    }
}

/// Random numbers of one press: of the seed and its name alone.
fn stream(seed: u64, name: &str) -> ChaCha8Rng {
    // FNV-1a.
    let hash = name.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |h, b| {
        (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3)
    });
    let mut stream = ChaCha8Rng::seed_from_u64(seed);
    stream.set_stream(hash);
    stream
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEMO: &str = include_str!("../../../protocols/demo.toml");
    const REAL_TO_SIM: &str = include_str!("../../../protocols/real2sim.toml");

    fn known() -> Vec<String> {
        [
            "sphere-25",
            "cube",
            "x",
            "ring",
            "triangle",
            "wedge",
            "cylinder",
            "sphere",
        ]
        .map(str::to_owned)
        .to_vec()
    }

    #[test]
    fn shipped_protocols_are_valid_and_stay_within_their_ranges() {
        for (file, text) in [("demo.toml", DEMO), ("real2sim.toml", REAL_TO_SIM)] {
            let mut protocol = Protocol::parse(file, text).unwrap();
            protocol.indenters = Indenters::All(AllWord::All);
            let plans = protocol.plan(&known(), 3).unwrap();
            let [shallow, deep] = protocol.depth_mm.ends();
            assert!(plans.iter().all(|plan| (shallow..=deep).contains(&plan.depth_mm)));
            assert!(
                plans
                    .iter()
                    .all(|plan| (plan.rotation.length() - 1.0).abs() < 1e-12)
            );
        }
    }

    #[test]
    fn a_press_depends_on_seed_and_name_alone() {
        let mut protocol = Protocol::parse("demo.toml", DEMO).unwrap();
        protocol.indenters = Indenters::Named(vec!["cube".into(), "ring".into()]);
        let both = protocol.plan(&known(), 3).unwrap();
        protocol.indenters = Indenters::Named(vec!["ring".into()]);
        let ring = protocol.plan(&known(), 3).unwrap();
        assert_eq!(both[both.len() / 2..], ring[..]);
        assert_ne!(protocol.plan(&known(), 4).unwrap(), ring);
    }

    #[test]
    fn mistakes_are_named_with_their_line() {
        let text = DEMO.replace("clearance_mm = ", "clearance_mm = -");
        let error = Protocol::parse("demo.toml", &text).unwrap_err();
        assert_eq!(error.field, "clearance_mm");
        assert!(
            text.lines()
                .nth(error.line - 1)
                .unwrap()
                .starts_with("clearance_mm"),
            "{error}"
        );
        let wrong = |old: &str, new: &str| {
            assert!(DEMO.contains(old), "{old}");
            Protocol::parse("demo.toml", &DEMO.replace(old, new))
                .unwrap_err()
                .field
        };
        assert_eq!(
            wrong("count = 16", "count = 16, margin_mm = 1"),
            "places.margin_mm"
        );
        assert_eq!(wrong("count = 16", "count = 0"), "places.count");
        assert_eq!(wrong("count = 16", "count = 4000000000"), "places.count");
        assert_eq!(wrong("count = 16", "number = 16"), "places.count");
        assert_eq!(wrong("x_mm = [-9.0, 9.0]", "x_mm = [9.0, -9.0]"), "places.x_mm");
        assert_eq!(
            wrong("depth_mm = [0.6, 1.6]", "depth_mm = [1.6, 0.6]"),
            "depth_mm"
        );
        assert_eq!(wrong("depth_mm = [0.6, 1.6]", "depth_mm = \"deep\""), "depth_mm");
        assert_eq!(
            wrong("speed_mm_per_s = [1.5, 4.0]", "speed_mm_per_s = 0.0"),
            "speed_mm_per_s"
        );
        assert_eq!(wrong("hold_s = [0.5, 1.5]", "hold_s = inf"), "hold_s");
        assert_eq!(
            wrong("indenters = [", "indenters = [\"cylinder\", "),
            "indenters[2]"
        );
        let protocol = Protocol::parse("demo.toml", DEMO).unwrap();
        assert!(protocol.plan(&["needle".to_owned()], 1).is_err());
    }
}
