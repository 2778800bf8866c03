//! A described sensor.

use std::collections::BTreeMap;
use std::path::Path;

use twintac_sensor::SensorFile;

use crate::Error;

/// A sensor, by its description: gel, taxels, read-out, and the indenters that can press it.
#[derive(Clone, Debug)]
pub struct Sensor {
    file: SensorFile,
}

impl Sensor {
    /// PhysTac: eight barometers under a flat gel of 34 × 18 × 8.5 mm.
    ///
    /// # Errors
    /// None, unless this library was compiled with another description in place of PhysTac's.
    pub fn phystac() -> Result<Self, Error> {
        Ok(SensorFile::phystac()?.into())
    }

    /// PhysTac's fingertip: eight barometers under a dome, 19.2 mm high.
    ///
    /// # Errors
    /// None, unless this library was compiled with another description in place of this one.
    pub fn phystac_tip() -> Result<Self, Error> {
        Ok(SensorFile::phystac_tip()?.into())
    }

    /// Reads a description (TOML).
    ///
    /// # Errors
    /// A file that cannot be read or is wrong; the error names line and field.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        Ok(SensorFile::read(path.as_ref())?.into())
    }

    /// Parses a description (TOML) as if it were in the file `path`, with the surfaces that it
    /// names: the corners of their triangles, mm.
    ///
    /// # Errors
    /// A description that is wrong (the error names line and field); a surface that is missing, or
    /// not closed.
    pub fn with_surfaces(
        path: &Path,
        text: &str,
        surfaces: &BTreeMap<String, Vec<[[f64; 3]; 3]>>,
    ) -> Result<Self, Error> {
        let load = |name: &str| match surfaces.get(name) {
            Some(triangles) => Ok(stl(triangles)),
            None => Err(std::io::ErrorKind::NotFound.into()),
        };
        Ok(SensorFile::parse_with(path, text, &load)?.into())
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.file.sensor.name
    }

    /// Names of its taxels, in the order of every row of readings.
    pub fn taxels(&self) -> impl Iterator<Item = &str> {
        self.file.sensor.taxels.iter().map(|taxel| &*taxel.name)
    }

    /// Names of the indenters that can press it.
    pub fn indenters(&self) -> impl Iterator<Item = &str> {
        self.file.sensor.indenters.iter().map(|indenter| &*indenter.name)
    }

    /// The whole description, and its text.
    #[must_use]
    pub fn file(&self) -> &SensorFile {
        &self.file
    }
}

/// A surface as the bytes of an STL file.
fn stl(triangles: &[[[f64; 3]; 3]]) -> Vec<u8> {
    let mut text = "solid surface\n".to_owned();
    for corners in triangles {
        let vertices = corners
            .map(|[x, y, z]| format!("vertex {x:?} {y:?} {z:?}\n"))
            .concat();
        text += &format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n");
    }
    (text + "endsolid surface\n").into_bytes()
}

impl From<SensorFile> for Sensor {
    fn from(file: SensorFile) -> Self {
        Self { file }
    }
}

impl From<&Sensor> for SensorFile {
    fn from(sensor: &Sensor) -> Self {
        sensor.file.clone()
    }
}
