//! Sensor descriptions as files.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result};
use twintac_sensor::Sensor;
use twintac_shape::Shape;

use crate::built_in::PHYSTAC;
use crate::cache::write_file;

/// A sensor description with its text.
#[derive(Clone, Debug)]
pub struct SensorFile {
    pub sensor: Arc<Sensor>,
    pub text: String,
    folder: PathBuf,
}

/// Reads a description; surfaces that it names lie relative to it.
pub fn read_sensor(path: &Path) -> Result<SensorFile> {
    let text = fs::read_to_string(path).with_context(|| format!("reading {}", path.display()))?;
    let sensor = parse_sensor(path, &text)?;
    // What is kept of the description must not depend on other files.
    let folder = folder_of(path);
    let load = |name: &str| fs::read(folder.join(name));
    let text = Sensor::text_with_material(&path.display().to_string(), &text, &load)?;
    Ok(SensorFile {
        sensor: Arc::new(sensor),
        text,
        folder: folder_of(path),
    })
}

/// Reads a description from its text, as if it stood in `path`.
pub fn parse_sensor(path: &Path, text: &str) -> Result<Sensor> {
    let folder = folder_of(path);
    let load = |name: &str| fs::read(folder.join(name));
    Ok(Sensor::parse(&path.display().to_string(), text, &load)?)
}

impl SensorFile {
    /// Reads a description, or without a file that of PhysTac, which the program carries with it.
    pub fn or_phystac(file: Option<&Path>) -> Result<Self> {
        if let Some(file) = file {
            return read_sensor(file);
        }
        Ok(Self {
            sensor: Arc::new(parse_sensor(Path::new(PHYSTAC.name), PHYSTAC.text)?),
            text: PHYSTAC.text.to_owned(),
            folder: PathBuf::new(),
        })
    }

    /// Puts the description, and the surfaces that it names, into a folder.
    pub fn copy_to(&self, folder: &Path) -> Result<()> {
        for name in self.sensor.surfaces.keys() {
            let bytes = fs::read(self.folder.join(name)).with_context(|| format!("reading {name}"))?;
            write_file(&folder.join(name), &bytes)?;
        }
        write_file(&folder.join("sensor.toml"), self.text.as_bytes())
    }

    /// The import description that the sensor names, if it names one.
    pub fn import(&self) -> Option<PathBuf> {
        self.sensor.import.as_ref().map(|path| self.folder.join(path))
    }
}

fn folder_of(path: &Path) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).to_owned()
}

/// The shape of a sensor's indenter.
pub fn indenter<'a>(sensor: &'a Sensor, name: &str) -> Result<&'a Shape> {
    let known = sensor.indenters.iter();
    let names = || {
        known
            .clone()
            .map(|indenter| indenter.name.as_str())
            .collect::<Vec<_>>()
    };
    let found = known.clone().find(|indenter| indenter.name == name);
    Ok(&found
        .with_context(|| {
            format!(
                "there is no indenter `{name}`; the sensor has {}",
                names().join(", ")
            )
        })?
        .shape)
}
