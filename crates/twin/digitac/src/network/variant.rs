//! The models that are trained and compared.

use serde::{Deserialize, Serialize};

/// A model: its inputs, and how it computes readings from them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Variant {
    /// The TwinTac paper's model: its stress features through a multilayer perceptron, frame by
    /// frame.
    #[serde(rename = "paper")]
    Paper,
    /// The hydrostatic pressure at each port times one gain for each taxel.
    #[serde(rename = "pressure")]
    Pressure,
    /// `Pressure` with a bounded correction by a multilayer perceptron whose inputs are all ports.
    #[serde(rename = "pressure+mlp")]
    PressureMlp,
    /// `Pressure` with quasi-linear viscoelastic relaxation, taxel by taxel.
    #[serde(rename = "pressure+memory")]
    PressureMemory,
    /// `Pressure` with both. The correction is added to the elastic reading, so that relaxation
    /// acts on it as well.
    #[serde(rename = "pressure+memory+mlp")]
    PressureMemoryMlp,
}

impl Variant {
    /// All variants, the simplest physical one first.
    pub const ALL: [Self; 5] = [
        Self::Pressure,
        Self::PressureMlp,
        Self::PressureMemory,
        Self::PressureMemoryMlp,
        Self::Paper,
    ];

    /// The name used in files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Pressure => "pressure",
            Self::PressureMlp => "pressure+mlp",
            Self::PressureMemory => "pressure+memory",
            Self::PressureMemoryMlp => "pressure+memory+mlp",
        }
    }

    /// Whether it has a multilayer perceptron.
    #[must_use]
    pub(crate) fn has_perceptron(self) -> bool {
        matches!(self, Self::Paper | Self::PressureMlp | Self::PressureMemoryMlp)
    }

    /// The variant without its multilayer perceptron; the paper's variant has nothing else and
    /// stays.
    #[must_use]
    pub(crate) fn without_perceptron(self) -> Self {
        match self {
            Self::PressureMlp => Self::Pressure,
            Self::PressureMemoryMlp => Self::PressureMemory,
            other => other,
        }
    }

    /// Whether its readings depend on earlier frames.
    #[must_use]
    pub(crate) fn has_memory(self) -> bool {
        matches!(self, Self::PressureMemory | Self::PressureMemoryMlp)
    }
}

impl std::fmt::Display for Variant {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for Variant {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let names = || Self::ALL.map(Self::name).join(", ");
        Self::ALL
            .into_iter()
            .find(|v| v.name() == name)
            .ok_or_else(|| format!("no variant `{name}`; there are: {}", names()))
    }
}
