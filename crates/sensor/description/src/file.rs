//! What stands in a description's TOML.

use serde::Deserialize;
use twintac_shape::Solid;

use crate::{Inclusion, Indenter, LoadLimits, Readout, Shell, Taxel};

/// The file as it is written, before anything is checked.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SensorToml {
    pub(crate) name: String,
    pub(crate) summary: String,
    pub(crate) source: String,
    #[serde(default)]
    pub(crate) inferred: Vec<String>,
    pub(crate) gel: GelFile,
    #[serde(default)]
    pub(crate) inclusions: Vec<Inclusion>,
    pub(crate) shell: Option<Shell>,
    pub(crate) taxels: Vec<Taxel>,
    pub(crate) readout: Readout,
    #[serde(default)]
    pub(crate) indenters: Vec<Indenter>,
    pub(crate) limits: Option<LoadLimits>,
    pub(crate) import: Option<String>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GelFile {
    pub(crate) solid: Solid,
    /// A table, or the path of a file that has it.
    pub(crate) material: toml::Value,
}
