//! The protocol, in the form of the file.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use twintac_config::ConfigError;

use crate::part::Series;
use crate::{Load, LoadPlan, Part, Places, PlanError, PressPlan, Target};

/// Presses to a depth, and weights put on the gel.
///
/// A file is either a single [`Part`], or has a summary and the lists `[[parts]]` and `[[loads]]`,
/// whose entries have names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Protocol {
    /// Its purpose.
    pub summary: String,
    /// Presses to a depth, by kind.
    #[serde(default)]
    pub parts: Vec<Part>,
    /// Weights put on the gel.
    #[serde(default)]
    pub loads: Vec<Load>,
}

/// Distinguishes a file with lists from a file that is a single part.
#[derive(Deserialize)]
struct Lists {
    parts: Option<serde::de::IgnoredAny>,
    loads: Option<serde::de::IgnoredAny>,
}

const PLAIN: &str = "give each part and load a name of its own, of letters, digits and dashes";

/// Whether a name is valid for files and folders.
fn is_plain(name: &str) -> bool {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '-' || letter == '_';
    !name.is_empty() && name.chars().all(is_plain)
}

impl Protocol {
    /// Reads a protocol from the text of a TOML file.
    ///
    /// # Errors
    /// The first field that is wrong, with file and line.
    pub fn parse(file: &str, text: &str) -> Result<Self, ConfigError> {
        let lists = twintac_config::parse::<Lists>(file, text)?.value;
        if lists.parts.is_none() && lists.loads.is_none() {
            let document = twintac_config::parse::<Part>(file, text)?;
            document.value.check(&document, "")?;
            if !document.value.name.is_empty() && !is_plain(&document.value.name) {
                let problem = format!("is `{}`", document.value.name);
                return Err(document.error("name", problem, PLAIN));
            }
            return Ok(Self {
                summary: document.value.summary.clone(),
                parts: vec![document.value],
                loads: Vec::new(),
            });
        }
        let document = twintac_config::parse::<Self>(file, text)?;
        let protocol = &document.value;
        for (index, part) in protocol.parts.iter().enumerate() {
            part.check(&document, &format!("parts[{index}]."))?;
        }
        for (index, load) in protocol.loads.iter().enumerate() {
            load.check(&document, &format!("loads[{index}]."))?;
        }
        let parts = protocol.parts.iter().map(|part| &part.name);
        let names: Vec<&String> = parts
            .chain(protocol.loads.iter().map(|load| &load.name))
            .collect();
        for (index, name) in names.iter().enumerate() {
            if !is_plain(name) || names[..index].contains(name) {
                let n_parts = protocol.parts.len();
                let field = match index.checked_sub(n_parts) {
                    None => format!("parts[{index}].name"),
                    Some(load) => format!("loads[{load}].name"),
                };
                let problem = format!("is `{name}`");
                return Err(document.error(&field, problem, PLAIN));
            }
        }
        Ok(document.value)
    }

    /// The same protocol with `n_places` random locations for each indenter, in parts with random
    /// locations.
    #[must_use]
    pub fn with_random_places(mut self, n_places: u32) -> Self {
        for part in &mut self.parts {
            if let Places::Random { count, .. } = &mut part.places {
                *count = n_places;
            }
        }
        self
    }

    /// The presses on a sensor: for each part and each indenter the whole list of locations, as
    /// often as it is repeated.
    ///
    /// # Errors
    /// The sensor does not have an indenter or a taxel that the protocol names.
    pub fn plan(&self, target: &Target, seed: u64) -> Result<Vec<PressPlan>, PlanError> {
        let series = self.series(target)?;
        let plans = series
            .iter()
            .flat_map(|series| (0..series.count()).map(|number| series.press(number, seed)));
        Ok(plans.collect())
    }

    /// A range of the same presses in another order: the first press of each part and indenter,
    /// then the second of each, and so on. So a long enough range has presses of every indenter.
    /// Only the range is planned.
    ///
    /// # Errors
    /// See [`plan`](Self::plan).
    pub fn plan_in_turn(
        &self,
        target: &Target,
        seed: u64,
        stretch: Range<usize>,
    ) -> Result<Vec<PressPlan>, PlanError> {
        let series = self.series(target)?;
        let most = series.iter().map(Series::count).max().unwrap_or(0);
        let in_turn = (0..most).flat_map(|number| series.iter().map(move |series| (series, number)));
        let planned = in_turn.filter(|(series, number)| *number < series.count());
        Ok(planned
            .skip(stretch.start)
            .take(stretch.len())
            .map(|(series, number)| series.press(number, seed))
            .collect())
    }

    /// Number of presses on a sensor.
    ///
    /// # Errors
    /// See [`plan`](Self::plan).
    pub fn n_presses(&self, target: &Target) -> Result<usize, PlanError> {
        let series = self.series(target)?;
        Ok(series.iter().map(|series| series.count() as usize).sum())
    }

    fn series<'a>(&'a self, target: &'a Target) -> Result<Vec<Series<'a>>, PlanError> {
        let mut all = Vec::new();
        for part in &self.parts {
            all.extend(part.series(target)?);
        }
        Ok(all)
    }

    /// The loads on a sensor, in the same order as [`plan`](Self::plan).
    ///
    /// # Errors
    /// See [`plan`](Self::plan).
    pub fn loads(&self, target: &Target, seed: u64) -> Result<Vec<LoadPlan>, PlanError> {
        let plans: Result<Vec<_>, _> = self.loads.iter().map(|load| load.plan(target, seed)).collect();
        Ok(plans?.concat())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Indenters;
    use crate::target::AllWord;

    const DEMO: &str = include_str!("../../../../protocols/demo.toml");
    const CHARACTERIZE: &str = include_str!("../../../../protocols/characterize.toml");
    const PAPER: &str = include_str!("../../../../protocols/paper.toml");
    const SHAPES: &str = include_str!("../../../../protocols/shapes.toml");
    const REAL_TO_SIM: &str = include_str!("../../../../protocols/real2sim.toml");

    fn known() -> Target {
        let indenters = [
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
        .to_vec();
        let taxels = vec![("t0".to_owned(), [-4.0, 1.0]), ("t5".to_owned(), [4.0, 2.0])];
        Target { indenters, taxels }
    }

    #[test]
    fn shipped_protocols_are_valid_and_stay_within_their_ranges() {
        for (file, text) in [
            ("demo.toml", DEMO),
            ("paper.toml", PAPER),
            ("shapes.toml", SHAPES),
            ("real2sim.toml", REAL_TO_SIM),
        ] {
            let protocol = Protocol::parse(file, text).unwrap();
            for part in &protocol.parts {
                let [shallow, deep] = part.depth_mm.ends();
                let mut alone = Protocol {
                    parts: vec![part.clone()],
                    ..protocol.clone()
                };
                alone.parts[0].indenters = Indenters::All(AllWord::All);
                for plan in alone.plan(&known(), 3).unwrap() {
                    assert!((shallow..=deep).contains(&plan.depth_mm), "{plan:?}");
                    assert!((plan.rotation.length() - 1.0).abs() < 1e-12, "{plan:?}");
                }
            }
        }
    }

    #[test]
    fn a_value_may_be_one_of_a_few() {
        let plans = Protocol::parse("paper.toml", PAPER)
            .unwrap()
            .plan(&known(), 1)
            .unwrap();
        let mut speeds: Vec<f64> = plans.iter().map(|plan| plan.speed_mm_per_s).collect();
        speeds.sort_by(f64::total_cmp);
        speeds.dedup();
        assert_eq!(speeds, [1.0, 2.0, 5.0]);
        let nothing = PAPER.replace("[1.0, 2.0, 5.0]", "[]");
        let error = Protocol::parse("paper.toml", &nothing).unwrap_err().to_string();
        assert!(error.contains("speed_mm_per_s` has an empty `one_of`"), "{error}");
    }

    #[test]
    fn a_press_depends_on_seed_and_name_alone() {
        let mut protocol = Protocol::parse("demo.toml", DEMO).unwrap();
        protocol.parts[0].indenters = Indenters::Named(vec!["cube".into(), "ring".into()]);
        let both = protocol.plan(&known(), 3).unwrap();
        protocol.parts[0].indenters = Indenters::Named(vec!["ring".into()]);
        let ring = protocol.plan(&known(), 3).unwrap();
        assert_eq!(both[both.len() / 2..], ring[..]);
        assert_ne!(protocol.plan(&known(), 4).unwrap(), ring);
    }

    #[test]
    fn presses_in_turn_are_the_same_presses_with_all_indenters_in_every_stretch() {
        let protocol = Protocol::parse("shapes.toml", SHAPES)
            .unwrap()
            .with_random_places(3);
        let target = known();
        let n = protocol.n_presses(&target).unwrap();
        assert_eq!(n, 3 * target.indenters.len());
        let whole = protocol.plan_in_turn(&target, 5, 0..n).unwrap();
        let pieces = [0..4, 4..n].map(|stretch| protocol.plan_in_turn(&target, 5, stretch).unwrap());
        assert_eq!(whole, pieces.concat());
        let first = whole[..target.indenters.len()].iter().map(|plan| &plan.indenter);
        assert!(first.eq(&target.indenters));
        let sorted = |mut plans: Vec<PressPlan>| {
            plans.sort_by(|a, b| a.name.cmp(&b.name));
            plans
        };
        assert_eq!(sorted(whole), sorted(protocol.plan(&target, 5).unwrap()));
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
        assert!(protocol.plan(&Target::default(), 1).is_err());
    }

    #[test]
    fn numbers_that_would_fill_the_memory_and_names_that_leave_the_folder_are_refused() {
        let set = |text: &str, field: &str, value: &str| {
            let is_field = |line: &&str| line.trim_start().starts_with(&format!("{field} = "));
            let line = text
                .lines()
                .find(is_field)
                .unwrap_or_else(|| panic!("no {field}"));
            Protocol::parse("p.toml", &text.replacen(line, &format!("{field} = {value}"), 1)).unwrap_err()
        };
        for (field, value) in [
            ("hold_s", "1e9"),
            ("hold_s", "nan"),
            ("hold_s", "[0.0, inf]"),
            ("depth_mm", "1e300"),
            ("depth_mm", "{ one_of = [1.0, nan] }"),
            ("speed_mm_per_s", "1e9"),
            ("clearance_mm", "1e300"),
            ("clearance_mm", "nan"),
        ] {
            let error = set(DEMO, field, value); // elements of a list have their number
            assert!(error.field.starts_with(field), "{value}: {error}");
        }
        let deep = DEMO.replace("depth_mm = [0.6, 1.6]", "depth_mm = [0.6, 50.0]");
        let slow = set(&deep, "speed_mm_per_s", "0.001").to_string();
        assert!(
            slow.contains("`speed_mm_per_s` is 0.001, so that the way down takes"),
            "{slow}"
        );
        let far = DEMO.replace("x_mm = [-9.0, 9.0]", "x_mm = [-1e300, 9.0]");
        assert_eq!(Protocol::parse("p.toml", &far).unwrap_err().field, "places.x_mm");
        for name in ["../../../escaped/x", "/tmp/x", "a/b", "..", "a\\u001b", " "] {
            let text = format!("name = \"{name}\"\n{DEMO}");
            assert_eq!(
                Protocol::parse("p.toml", &text).unwrap_err().field,
                "name",
                "{name}"
            );
        }
        for (field, value) in [("force_n", "1e9"), ("rest_s", "1e9"), ("rest_s", "nan")] {
            let from = CHARACTERIZE.find("[[loads]]").unwrap();
            let text = format!("summary = \"weights\"\n{}", &CHARACTERIZE[from..]);
            let error = set(&text, field, value).to_string();
            assert!(error.contains(&format!("`loads[0].{field}`")), "{error}");
        }
    }

    #[test]
    fn parts_and_loads_stand_in_one_file_and_have_names_of_their_own() {
        let protocol = Protocol::parse("characterize.toml", CHARACTERIZE).unwrap();
        assert!(protocol.parts.len() > 1 && !protocol.loads.is_empty());
        let (plans, loads) = (protocol.plan(&known(), 3).unwrap(), protocol.loads(&known(), 3));
        let names = plans.iter().map(|plan| &plan.name);
        let mut names: Vec<String> = names
            .chain(loads.unwrap().iter().map(|load| &load.name))
            .cloned()
            .collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
        let first = &protocol.parts[0].name;
        let wrong = CHARACTERIZE.replacen("clearance_mm = ", "clearance_mm = -", 1);
        let error = Protocol::parse("characterize.toml", &wrong).unwrap_err();
        assert_eq!(error.field, "parts[0].clearance_mm");
        let again = CHARACTERIZE.replacen(
            &format!("name = \"{}\"", protocol.parts[1].name),
            &format!("name = \"{first}\""),
            1,
        );
        assert_eq!(
            Protocol::parse("characterize.toml", &again).unwrap_err().field,
            "parts[1].name"
        );
    }

    #[test]
    fn taxels_are_pressed_from_above_where_they_are() {
        let mut protocol = Protocol::parse("demo.toml", DEMO).unwrap();
        protocol.parts[0].indenters = Indenters::Named(vec!["cube".into()]);
        protocol.parts[0].places = Places::Taxels { names: None };
        protocol.parts[0].repeats = 2;
        let places: Vec<_> = protocol
            .plan(&known(), 1)
            .unwrap()
            .iter()
            .map(|plan| [plan.x_mm, plan.y_mm])
            .collect();
        assert_eq!(places, [[-4.0, 1.0], [4.0, 2.0], [-4.0, 1.0], [4.0, 2.0]]);
        protocol.parts[0].places = Places::Taxels {
            names: Some(vec!["t9".into()]),
        };
        let error = protocol.plan(&known(), 1).unwrap_err();
        assert_eq!((error.how, error.known.as_str()), ("above", "t0, t5"));
    }
}
