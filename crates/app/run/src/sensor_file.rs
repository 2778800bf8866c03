//! Sensor descriptions as files.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use twintac_sensor::Sensor;
use twintac_shape::Shape;

use crate::RunError;
use crate::built_in::PHYSTAC;
use crate::files::{read_text, write_file};

/// A sensor description with its text, which goes into every run and model that is made with it.
#[derive(Clone, Debug)]
pub struct SensorFile {
    /// What the description says.
    pub sensor: Arc<Sensor>,
    /// Its text, with the material that it may name in a file of its own.
    pub text: String,
    folder: PathBuf,
}

impl SensorFile {
    /// Reads a description; material and surfaces that it names lie relative to it.
    ///
    /// # Errors
    /// A file that cannot be read, or that is wrong.
    pub fn read(path: &Path) -> Result<Self, RunError> {
        let text = read_text(path)?;
        let sensor = parse_sensor(path, &text)?;
        // What is kept of the description must not depend on other files.
        let folder = folder_of(path);
        let load = |name: &str| fs::read(folder.join(name));
        let text = Sensor::text_with_material(&path.display().to_string(), &text, &load)?;
        Ok(Self {
            sensor: Arc::new(sensor),
            text,
            folder: folder_of(path),
        })
    }

    /// The description of PhysTac, which is built in.
    ///
    /// # Errors
    /// None, unless the built-in description is wrong.
    pub fn phystac() -> Result<Self, RunError> {
        Ok(Self {
            sensor: Arc::new(parse_sensor(Path::new(PHYSTAC.name), PHYSTAC.text)?),
            text: PHYSTAC.text.to_owned(),
            folder: PathBuf::new(),
        })
    }

    /// Reads a description, or without a file that of PhysTac.
    ///
    /// # Errors
    /// Those of [`read`](Self::read).
    pub fn or_phystac(file: Option<&Path>) -> Result<Self, RunError> {
        file.map_or_else(Self::phystac, Self::read)
    }

    /// Puts the description, and the surfaces that it names, into a folder.
    pub(crate) fn copy_to(&self, folder: &Path) -> Result<(), RunError> {
        for name in self.sensor.surfaces.keys() {
            let from = self.folder.join(name);
            let bytes = fs::read(&from).map_err(RunError::file("reading", &from))?;
            write_file(&folder.join(name), &bytes)?;
        }
        write_file(&folder.join("sensor.toml"), self.text.as_bytes())
    }

    /// The import description that the sensor names, if it names one.
    #[must_use]
    pub fn import(&self) -> Option<PathBuf> {
        self.sensor.import.as_ref().map(|path| self.folder.join(path))
    }
}

/// Reads a description from its text, as if it stood in `path`.
pub(crate) fn parse_sensor(path: &Path, text: &str) -> Result<Sensor, RunError> {
    let folder = folder_of(path);
    let load = |name: &str| fs::read(folder.join(name));
    Ok(Sensor::parse(&path.display().to_string(), text, &load)?)
}

fn folder_of(path: &Path) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).to_owned()
}

/// The shape of a sensor's indenter.
pub(crate) fn indenter<'a>(sensor: &'a Sensor, name: &str) -> Result<&'a Shape, RunError> {
    let indenters = &sensor.indenters;
    let found = indenters.iter().find(|indenter| indenter.name == name);
    found.map(|indenter| &indenter.shape).ok_or_else(|| {
        let names: Vec<&str> = indenters.iter().map(|indenter| indenter.name.as_str()).collect();
        RunError::Input(format!(
            "there is no indenter `{name}`; the sensor has {}",
            names.join(", ")
        ))
    })
}
