//! An indenter in a file of its own.

use std::path::Path;
use std::sync::Arc;

use twintac_config::Document;
use twintac_shape::{Surfaces, TriangleSurface};

use crate::load::load_surface;
use crate::{Indenter, Sensor, SensorError};

/// An indenter that no sensor's description contains. Its TOML file has the fields of an entry of
/// `[[indenters]]`:
///
/// ```toml
/// name = "ball-8"
/// shape = { kind = "sphere", radius_mm = 4.0 }
/// ```
#[derive(Clone, Debug)]
pub struct IndenterFile {
    /// The indenter.
    pub indenter: Indenter,
    /// Its triangle surface, if it has one.
    surfaces: Surfaces,
    /// The parsed file, for the lines of its fields in errors.
    document: Document<Indenter>,
}

impl IndenterFile {
    /// Reads the file. The path of a surface (STL) is relative to the file's folder.
    ///
    /// # Errors
    /// The file cannot be read, a field is wrong, or a surface cannot be loaded.
    pub fn read(path: &Path) -> Result<Self, SensorError> {
        let document = twintac_config::read::<Indenter>(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_document(document, folder, &|surface| std::fs::read(folder.join(surface)))
    }

    /// Reads the file's text. `file` names it in errors; `load` returns the bytes of an STL file,
    /// given its path in the text.
    ///
    /// # Errors
    /// See [`read`](Self::read).
    pub fn parse(
        file: &str,
        text: &str,
        load: &dyn Fn(&str) -> std::io::Result<Vec<u8>>,
    ) -> Result<Self, SensorError> {
        let document = twintac_config::parse::<Indenter>(file, text)?;
        let folder = Path::new(file).parent().unwrap_or(Path::new(""));
        Self::from_document(document, folder, load)
    }

    fn from_document(
        document: Document<Indenter>,
        folder: &Path,
        load: &dyn Fn(&str) -> std::io::Result<Vec<u8>>,
    ) -> Result<Self, SensorError> {
        let mut indenter = document.value.clone();
        indenter.check(&document, "")?;
        let files = indenter.shape.surface_files().into_iter();
        let loaded =
            files.map(|(field, file)| load_surface(&document, &format!("shape.{field}"), file, load));
        let loaded = loaded.collect::<Result<Vec<TriangleSurface>, _>>()?;
        // The sensor may have another surface of the same name.
        indenter
            .shape
            .rename_surfaces(&|surface| folder.join(surface).display().to_string());
        let files = indenter.shape.surface_files().into_iter().zip(loaded);
        let surfaces = files.map(|((_, file), loaded)| (file.name().into_owned(), Arc::new(loaded)));
        let surfaces: Surfaces = surfaces.collect();
        indenter.check_size(&document, "", &surfaces)?;
        Ok(Self {
            indenter,
            surfaces,
            document,
        })
    }

    /// The sensor with this indenter added. An indenter of the same name is replaced.
    ///
    /// # Errors
    /// The indenter is so far from its origin that it comes down beside the sensor's gel.
    pub fn added_to(&self, sensor: &Sensor) -> Result<Sensor, SensorError> {
        let mut sensor = sensor.clone();
        sensor
            .indenters
            .retain(|indenter| indenter.name != self.indenter.name);
        sensor.indenters.push(self.indenter.clone());
        sensor.surfaces.extend(self.surfaces.clone());
        self.indenter.check_reach(&self.document, "", &sensor)?;
        Ok(sensor)
    }
}

#[cfg(test)]
mod tests {
    use twintac_shape::Shape;

    use super::*;
    use crate::SensorFile;

    #[test]
    fn an_indenter_is_added_or_takes_the_place_of_its_namesake() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("indenter.toml");
        let phystac = SensorFile::phystac().unwrap().sensor;
        for (name, n_more) in [("ball-8", 1), ("cube", 0)] {
            let text = format!("name = \"{name}\"\nshape = {{ kind = \"sphere\", radius_mm = 4.0 }}\n");
            std::fs::write(&path, text).unwrap();
            let sensor = IndenterFile::read(&path).unwrap().added_to(&phystac).unwrap();
            assert_eq!(sensor.indenters.len(), phystac.indenters.len() + n_more);
            let found = &sensor.indenter(name).unwrap().shape;
            assert!(matches!(found, Shape::Sphere { radius_mm } if *radius_mm == 4.0));
        }
    }

    #[test]
    fn a_union_is_read_with_the_surfaces_of_its_parts() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("indenter.toml");
        let text = r#"
            name = "two"
            shape.kind = "union"
            [[shape.parts]]
            shape = { kind = "sphere", radius_mm = 3.0 }
            whole_from_part = { position_mm = [4.0, 0.0, 0.5] }
            [[shape.parts]]
            shape = { kind = "stl", path = "absent.stl" }
        "#;
        std::fs::write(&path, text).unwrap();
        let error = IndenterFile::read(&path).unwrap_err().to_string();
        assert!(error.contains("`shape.parts[1].shape.path`"), "{error}");
        std::fs::write(
            &path,
            text.replace("\"stl\", path = \"absent.stl\"", "\"sphere\", radius_mm = 1.0"),
        )
        .unwrap();
        let Shape::Union { parts } = IndenterFile::read(&path).unwrap().indenter.shape else {
            panic!("no union")
        };
        assert_eq!(parts[0].whole_from_part.position_mm.x, 4.0);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("indenter.toml");
        for (text, words) in [
            (
                "name = \"ball\"\nshape = { kind = \"sphere\", radius_mm = -4.0 }\n",
                "indenter.toml:2: `shape.radius_mm`",
            ),
            (
                "name = \"two words\"\nshape = { kind = \"sphere\", radius_mm = 4.0 }\n",
                "indenter.toml:1: `name`",
            ),
            (
                "name = \"tool\"\nshape = { kind = \"stl\", path = \"tool.stl\" }\n",
                "`shape.path` names `tool.stl`, which cannot be read",
            ),
            ("name = \"ball\"\n", "indenter.toml"),
        ] {
            std::fs::write(&path, text).unwrap();
            let error = IndenterFile::read(&path).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}
