//! The indenters and taxels that a protocol is planned for.

use serde::{Deserialize, Serialize};

/// What planning a protocol needs to know of a sensor.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Target {
    /// Names of the sensor's indenters.
    pub indenters: Vec<String>,
    /// Name of each taxel, and its position in the gel's plane, mm.
    pub taxels: Vec<(String, [f64; 2])>,
}

/// The indenters that press.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a list of names or \"all\"")]
pub enum Indenters {
    /// The named ones, in this order.
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

/// A protocol that does not fit the sensor.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the protocol presses {how} `{asked}`, the sensor's description has {known}")]
pub struct PlanError {
    /// `with` for an indenter, `above` for a taxel.
    pub how: &'static str,
    /// The indenter or taxel that the protocol names.
    pub asked: String,
    /// The ones that the sensor has.
    pub known: String,
}

impl Indenters {
    /// The names of the indenters.
    pub(crate) fn named<'a>(&'a self, target: &'a Target) -> Result<&'a [String], PlanError> {
        let names = match self {
            Self::All(_) => &target.indenters,
            Self::Named(names) => names,
        };
        let missing = names.iter().find(|name| !target.indenters.contains(name));
        missing.map_or(Ok(names), |asked| {
            Err(PlanError {
                how: "with",
                asked: asked.clone(),
                known: target.indenters.join(", "),
            })
        })
    }

    /// What is wrong: the field relative to the table, the problem and a hint.
    pub(crate) fn problem(&self) -> Option<(String, String, &'static str)> {
        let Self::Named(names) = self else {
            return None;
        };
        if names.is_empty() {
            let hint = "name at least one, or give \"all\"";
            return Some(("indenters".into(), "names none".into(), hint));
        }
        let again = (0..names.len()).find(|&index| names[..index].contains(&names[index]))?;
        let problem = format!("is `{}` again", names[again]);
        Some((format!("indenters[{again}]"), problem, "name each indenter once"))
    }
}
