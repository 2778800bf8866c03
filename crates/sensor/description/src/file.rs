//! The fields of a description's TOML file.

use serde::Deserialize;
use twintac_shape::Solid;

use crate::{Inclusion, Indenter, LoadLimits, Readout, Shell, Taxel};

/// The file as written, before any check.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SensorToml {
    /// A unique name.
    pub(crate) name: String,
    /// What the sensor is, in one line.
    pub(crate) summary: String,
    /// Source of the dimensions.
    pub(crate) source: String,
    /// Paths of fields that nobody has measured, such as `gel.material`. Output that depends on
    /// them is marked.
    #[serde(default)]
    pub(crate) inferred: Vec<String>,
    /// The gel.
    pub(crate) gel: GelFile,
    /// Rigid boxes inside the gel.
    #[serde(default)]
    pub(crate) inclusions: Vec<Inclusion>,
    /// Rigid walls beside the gel.
    pub(crate) shell: Option<Shell>,
    /// Taxels, in the order of the columns of readings.
    pub(crate) taxels: Vec<Taxel>,
    /// Read-out: range, resolution, rate and chips.
    pub(crate) readout: Readout,
    /// Indenters that the sensor can be pressed with.
    #[serde(default)]
    pub(crate) indenters: Vec<Indenter>,
    /// Largest force and depth that the sensor withstands.
    pub(crate) limits: Option<LoadLimits>,
    /// Path of the import description that reads recordings of this sensor.
    pub(crate) import: Option<String>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GelFile {
    /// The undeformed shape.
    pub(crate) solid: Solid,
    /// A table, or the path of a material file that has it.
    pub(crate) material: toml::Value,
}
