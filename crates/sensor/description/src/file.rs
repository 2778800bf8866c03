//! What stands in a description's TOML.

use serde::Deserialize;
use twintac_shape::Solid;

use crate::{Inclusion, Indenter, LoadLimits, Readout, Shell, Taxel};

/// The file as it is written, before anything is checked.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SensorToml {
    /// A name of its own.
    pub(crate) name: String,
    /// What it is, in a line.
    pub(crate) summary: String,
    /// Where its sizes come from.
    pub(crate) source: String,
    /// Paths of fields that nobody has measured, such as `gel.material`; what depends on them says so.
    #[serde(default)]
    pub(crate) inferred: Vec<String>,
    /// The gel.
    pub(crate) gel: GelFile,
    /// Rigid boxes inside the gel.
    #[serde(default)]
    pub(crate) inclusions: Vec<Inclusion>,
    /// Rigid walls beside the gel.
    pub(crate) shell: Option<Shell>,
    /// Where pressure is felt, in the order of every row of readings.
    pub(crate) taxels: Vec<Taxel>,
    /// How readings come out.
    pub(crate) readout: Readout,
    /// What it can be pressed with.
    #[serde(default)]
    pub(crate) indenters: Vec<Indenter>,
    /// What it stands.
    pub(crate) limits: Option<LoadLimits>,
    /// Path of the description that says how to read recordings of it.
    pub(crate) import: Option<String>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GelFile {
    /// Its undeformed shape.
    pub(crate) solid: Solid,
    /// A table, or the path of a file that has it.
    pub(crate) material: toml::Value,
}
