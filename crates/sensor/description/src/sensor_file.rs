//! A sensor description with its text.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sha2::{Digest, Sha256};
use toml::{Table, Value};

use crate::{Sensor, SensorError};

/// PhysTac's description, and the file name for errors.
const PHYSTAC: (&str, &str) = ("sensors/phystac.toml", include_str!("../built_in/phystac.toml"));
const PHYSTAC_TIP: (&str, &str) = (
    "sensors/phystac-tip.toml",
    include_str!("../built_in/phystac-tip.toml"),
);

/// A sensor description with its text. Logs, runs and models keep it in this form.
#[derive(Clone, Debug)]
pub struct SensorFile {
    /// The sensor.
    pub sensor: Arc<Sensor>,
    /// The description (TOML). A material file that it names is replaced by its table.
    pub text: String,
    /// The folder to which paths of surfaces and of the import description are relative.
    folder: PathBuf,
    /// Contents of the surface files (STL), by their names in the description.
    surfaces: BTreeMap<String, Arc<[u8]>>,
}

/// Folder of the surfaces that are kept with a description.
const SURFACES: &str = "surfaces";

impl SensorFile {
    /// Reads a description. Paths of other files are relative to its folder.
    ///
    /// # Errors
    /// The file cannot be read; those of [`Sensor::parse`].
    pub fn read(path: &Path) -> Result<Self, SensorError> {
        let text = std::fs::read_to_string(path).map_err(|found| SensorError {
            file: path.display().to_string(),
            line: 0,
            field: String::new(),
            problem: format!("cannot be read: {found}"),
            hint: "give the path of a sensor description (TOML)".to_owned(),
        })?;
        Self::parse(path, &text)
    }

    /// Reads a description from its text, as if it were in the file `path`, which need not exist.
    ///
    /// # Errors
    /// Those of [`Sensor::parse`].
    pub fn parse(path: &Path, text: &str) -> Result<Self, SensorError> {
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Self::parse_with(path, text, &|name| std::fs::read(folder.join(name)))
    }

    /// Like [`parse`](Self::parse). `load` returns the contents of material and surface files,
    /// given their names in the description.
    ///
    /// # Errors
    /// Those of [`Sensor::parse`].
    pub fn parse_with(
        path: &Path,
        text: &str,
        load: &dyn Fn(&str) -> std::io::Result<Vec<u8>>,
    ) -> Result<Self, SensorError> {
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let loaded = RefCell::new(BTreeMap::new());
        let load = |name: &str| {
            let bytes = load(name)?;
            loaded.borrow_mut().insert(name.to_owned(), Arc::from(&*bytes));
            Ok(bytes)
        };
        let file = path.display().to_string();
        let sensor = Sensor::parse(&file, text, &load)?;
        let text = Sensor::text_with_material(&file, text, &load)?;
        let mut surfaces: BTreeMap<String, Arc<[u8]>> = loaded.into_inner();
        let named = sensor.surface_files().into_iter();
        let named: BTreeSet<&String> = named.map(|(_, file)| &file.path).collect();
        surfaces.retain(|name, _| named.contains(name));
        Ok(Self {
            sensor: Arc::new(sensor),
            text,
            folder,
            surfaces,
        })
    }

    /// The built-in description of PhysTac.
    ///
    /// # Errors
    /// None, unless this crate was compiled with another file in its place.
    pub fn phystac() -> Result<Self, SensorError> {
        let (name, text) = PHYSTAC;
        Self::parse(Path::new(name), text)
    }

    /// The built-in description of PhysTac's domed fingertip.
    ///
    /// # Errors
    /// None, unless this crate was compiled with another file in its place.
    pub fn phystac_tip() -> Result<Self, SensorError> {
        let (name, text) = PHYSTAC_TIP;
        Self::parse(Path::new(name), text)
    }

    /// The same sensor with another gel material. `material` is the text of a material file (TOML).
    /// The material's constants no longer count as inferred. Comments are lost.
    ///
    /// # Errors
    /// The material cannot be read or is wrong.
    pub fn with_material(&self, material: &str) -> Result<Self, SensorError> {
        let material: Table =
            toml::from_str(material).map_err(|found| self.unreadable("gel.material", &found))?;
        self.edited(|description| {
            if let Some(Value::Table(gel)) = description.get_mut("gel") {
                gel.insert("material".to_owned(), Value::Table(material));
            }
            if let Some(Value::Array(inferred)) = description.get_mut("inferred") {
                let of_material =
                    |path: &Value| path.as_str().is_some_and(|path| path.starts_with("gel.material"));
                inferred.retain(|path| !of_material(path));
            }
        })
    }

    /// The same description with one coefficient of friction between the gel and every indenter.
    ///
    /// # Errors
    /// The coefficient is outside the allowed range.
    pub fn with_friction(&self, friction: f64) -> Result<Self, SensorError> {
        self.edited(|description| {
            if let Some(Value::Array(indenters)) = description.get_mut("indenters") {
                for indenter in indenters.iter_mut().filter_map(Value::as_table_mut) {
                    indenter.insert("friction".to_owned(), Value::Float(friction));
                }
            }
        })
    }

    /// The description with a change to its text.
    fn edited(&self, edit: impl FnOnce(&mut Table)) -> Result<Self, SensorError> {
        let mut description: Table =
            toml::from_str(&self.text).map_err(|found| self.unreadable("", &found))?;
        edit(&mut description);
        let text = toml::to_string(&description).map_err(|found| self.unreadable("", &found))?;
        Self::parse(&self.path(), &text)
    }

    /// The path of the description's file, or the path that it would have if it came from a text.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        self.folder.join(&self.sensor.name).with_extension("toml")
    }

    fn unreadable(&self, field: &str, found: &dyn std::fmt::Display) -> SensorError {
        SensorError {
            file: self.path().display().to_string(),
            line: 0,
            field: field.to_owned(),
            problem: format!("is no TOML table: {found}"),
            hint: "give a table such as those in materials/ and sensors/".to_owned(),
        }
    }

    /// The same description as it is saved in the file `path` together with its surfaces. The
    /// surfaces lie in a folder beside the file, and their names are made from their contents. The
    /// text therefore differs from that of every other description, whatever the contents of other
    /// files. [`surfaces`](Self::surfaces) has the files to write.
    ///
    /// # Errors
    /// None is known: the description was read before.
    pub fn kept_as(&self, path: &Path) -> Result<Self, SensorError> {
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        if self.surfaces.is_empty() {
            return Ok(Self {
                folder,
                ..self.clone()
            });
        }
        let names: BTreeMap<&str, String> = self
            .surfaces
            .iter()
            .map(|(name, bytes)| (name.as_str(), kept_name(bytes)))
            .collect();
        let mut description: Table =
            toml::from_str(&self.text).map_err(|found| self.unreadable("", &found))?;
        for shapes in ["gel", "indenters"] {
            description
                .get_mut(shapes)
                .into_iter()
                .for_each(|value| rename(value, &names));
        }
        let text = toml::to_string(&description).map_err(|found| self.unreadable("", &found))?;
        let surfaces = self.surfaces.values();
        let surfaces: BTreeMap<String, Arc<[u8]>> = surfaces
            .map(|bytes| (kept_name(bytes), Arc::clone(bytes)))
            .collect();
        let load = |name: &str| {
            let bytes = surfaces.get(name).ok_or(std::io::ErrorKind::NotFound)?;
            Ok(bytes.to_vec())
        };
        let sensor = Sensor::parse(&path.display().to_string(), &text, &load)?;
        Ok(Self {
            sensor: Arc::new(sensor),
            text,
            folder,
            surfaces,
        })
    }

    /// Contents of the surface files (STL) that the description names, by their paths relative to
    /// it.
    #[must_use]
    pub fn surfaces(&self) -> &BTreeMap<String, Arc<[u8]>> {
        &self.surfaces
    }

    /// Path of the import description for recordings of the sensor, if the description names one.
    #[must_use]
    pub fn import(&self) -> Option<PathBuf> {
        self.sensor.import.as_ref().map(|path| self.folder.join(path))
    }
}

/// A unique name for a surface.
fn kept_name(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    let digits: String = digest.iter().take(8).map(|byte| format!("{byte:02x}")).collect();
    format!("{SURFACES}/{digits}.stl")
}

/// Renames surfaces wherever a shape names one.
fn rename(value: &mut Value, names: &BTreeMap<&str, String>) {
    match value {
        Value::Table(table) => {
            for (key, value) in table.iter_mut() {
                match value.as_str().and_then(|name| names.get(name)) {
                    Some(name) if key == "path" => *value = Value::String(name.clone()),
                    _ => rename(value, names),
                }
            }
        }
        Value::Array(values) => values.iter_mut().for_each(|value| rename(value, names)),
        _ => (),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The built-in file is a symbolic link to the file in `sensors`. Where links are not kept,
    /// both must be equal.
    #[test]
    fn what_is_built_in_is_what_people_edit() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
        for (name, text) in [PHYSTAC, PHYSTAC_TIP] {
            assert_eq!(text, std::fs::read_to_string(root.join(name)).unwrap());
        }
        for built_in in [SensorFile::phystac(), SensorFile::phystac_tip()] {
            assert_eq!(built_in.unwrap().sensor.taxels.len(), 8);
        }
    }

    #[test]
    fn another_material_changes_nothing_else() {
        let described = SensorFile::phystac().unwrap();
        let yeoh = "model = 'yeoh'\nc10_kpa = 12.0\nc20_kpa = 7.0\nc30_kpa = 0.0\npoissons_ratio = 0.46\nsource = 'a test'";
        let other = described.with_material(yeoh).unwrap();
        let material = &other.sensor.gel.material;
        assert_eq!(material.shear_modulus_kpa(), 24.0);
        assert_eq!(other.sensor.taxels, described.sensor.taxels);
        assert_eq!(other.sensor.indenters, described.sensor.indenters);
        assert!(other.sensor.inferred.contains(&"taxels".to_owned()));
        let again = SensorFile::parse(Path::new("other.toml"), &other.text).unwrap();
        assert_eq!(again.text, other.text);

        let error = described
            .with_material("model = 'yeoh'\nsource = 'a test'")
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("has no constant for the change of volume"),
            "{error}"
        );
    }

    #[test]
    fn friction_goes_to_every_indenter() {
        let rough = SensorFile::phystac().unwrap().with_friction(0.2).unwrap();
        assert!(
            rough
                .sensor
                .indenters
                .iter()
                .all(|indenter| indenter.friction == Some(0.2))
        );
        assert!(rough.with_friction(-0.1).is_err());
    }

    /// Surfaces are saved inside of the folder under names made from their contents, whatever the
    /// description calls them.
    #[test]
    fn surfaces_are_kept_inside_by_content() {
        let folder = tempfile::tempdir().unwrap();
        let parent = folder.path();
        let inside = parent.join("inside");
        std::fs::create_dir(&inside).unwrap();
        let mut surface = String::from("solid s\n");
        for face in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]] {
            surface += "facet normal 0 0 0\nouter loop\n";
            for corner in face {
                surface += [
                    "vertex 0 0 0\n",
                    "vertex 9 0 0\n",
                    "vertex 0 9 0\n",
                    "vertex 0 0 9\n",
                ][corner];
            }
            surface += "endloop\nendfacet\n";
        }
        surface += "endsolid s\n";
        std::fs::write(parent.join("notes.txt"), &surface).unwrap();
        let indenter =
            "\n[[indenters]]\nname = \"own\"\nshape = { kind = \"stl\", path = \"../notes.txt\" }\n";
        let path = inside.join("sensor.toml");
        std::fs::write(&path, format!("{}{indenter}", PHYSTAC.1)).unwrap();
        let read = SensorFile::read(&path).unwrap();
        let kept = read.kept_as(&parent.join("run/sensor.toml")).unwrap();
        let names: Vec<&String> = kept.surfaces().keys().collect();
        assert_eq!(names.len(), 1);
        assert!(
            names[0].starts_with("surfaces/") && names[0].ends_with(".stl"),
            "{names:?}"
        );
        assert!(!kept.text.contains("notes.txt"));
    }
}
