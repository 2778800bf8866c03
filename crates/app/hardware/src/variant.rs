//! Variants of hardware: a name, a description and a chip.

use std::path::Path;

use anyhow::{Context, Result};
use twintac_sensor::Sensor;
use twintac_store::Digest;

use crate::options::Options;

/// A description from which hardware is made.
pub(crate) struct Variant {
    pub(crate) name: String,
    pub(crate) sensor: Sensor,
    pub(crate) chip: String,
    /// SHA-256 of the description's file.
    pub(crate) sha256: String,
}

/// Name, description and chip of the shipped variants.
const SHIPPED: [(&str, &str, &str); 3] = [
    ("phystac-ms5837", "sensors/phystac.toml", "MS5837-30BA"),
    ("fingertip", "sensors/phystac-tip.toml", "MS5837-30BA"),
    ("phystac", "sensors/phystac.toml", "CPS135B"),
];

/// The variants that the options name.
pub(crate) fn wanted(options: &Options) -> Result<Vec<Variant>> {
    let Some(path) = &options.sensor else {
        return shipped(&options.root);
    };
    Ok(vec![read(path, None, options.chip.as_deref())?])
}

/// All shipped variants.
pub(crate) fn shipped(root: &Path) -> Result<Vec<Variant>> {
    SHIPPED
        .into_iter()
        .map(|(name, path, chip)| read(&root.join(path), Some(name), Some(chip)))
        .collect()
}

fn read(path: &Path, name: Option<&str>, chip: Option<&str>) -> Result<Variant> {
    let sensor = Sensor::read(path)?;
    let sha256 = Digest::of_file(path)
        .with_context(|| format!("reading {}", path.display()))?
        .to_string();
    let own = || {
        sensor
            .readout
            .chip
            .clone()
            .unwrap_or_else(|| "CPS135B".to_owned())
    };
    Ok(Variant {
        name: name.unwrap_or(&sensor.name).to_owned(),
        chip: chip.map_or_else(own, str::to_owned),
        sensor,
        sha256,
    })
}
