//! Reads and checks a description.

use std::path::Path;
use std::sync::Arc;

use toml::{Table, Value};
use twintac_config::Document;
use twintac_shape::{SurfaceFile, Surfaces, TriangleSurface};

use crate::file::SensorToml;
use crate::material_table::material;
use crate::sensor::surface_files;
use crate::{Gel, GelMaterial, Sensor, SensorError};

impl Sensor {
    /// Reads a description from its text. `file` names it in errors; `load` returns the bytes of an
    /// STL file or a material file, given its path in the description.
    ///
    /// # Errors
    /// A field is wrong, or a file cannot be loaded.
    pub fn parse(
        file: &str,
        text: &str,
        load: &dyn Fn(&str) -> std::io::Result<Vec<u8>>,
    ) -> Result<Self, SensorError> {
        let document = twintac_config::parse::<SensorToml>(file, text)?;
        Self::from_document(document, load)
    }

    /// Reads a description from a file. Paths of other files are relative to its folder.
    ///
    /// # Errors
    /// The file cannot be read; those of [`Sensor::parse`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, SensorError> {
        let folder = path.as_ref().parent().unwrap_or(Path::new("")).to_owned();
        let document = twintac_config::read::<SensorToml>(path)?;
        Self::from_document(document, &|name| std::fs::read(folder.join(name)))
    }

    /// The text of a description with the material table in place of the path of a material file,
    /// so that the text is complete by itself.
    ///
    /// # Errors
    /// Those of [`Sensor::parse`] that concern the material.
    pub fn text_with_material(
        file: &str,
        text: &str,
        load: &dyn Fn(&str) -> std::io::Result<Vec<u8>>,
    ) -> Result<String, SensorError> {
        let document = twintac_config::parse::<SensorToml>(file, text)?;
        let Value::String(path) = &document.value.gel.material else {
            return Ok(text.to_owned());
        };
        let table = load_material(&document, load)?.0;
        let line = document.error(MATERIAL, "", "").line;
        let expanded = text.split_inclusive('\n').enumerate().map(|(index, text)| {
            if index + 1 != line {
                return text.to_owned();
            }
            let table = Value::Table(table.clone()).to_string();
            let quoted = |quote: char| format!("{quote}{path}{quote}");
            text.replacen(&quoted('"'), &table, 1)
                .replacen(&quoted('\''), &table, 1)
        });
        Ok(expanded.collect())
    }

    fn from_document(
        document: Document<SensorToml>,
        load: &dyn Fn(&str) -> std::io::Result<Vec<u8>>,
    ) -> Result<Self, SensorError> {
        let material = load_material(&document, load)?.1;
        let surfaces = load_surfaces(&document, load)?;
        let file = document.value.clone();
        let sensor = Self {
            name: file.name,
            summary: file.summary,
            source: file.source,
            inferred: file.inferred,
            gel: Gel {
                solid: file.gel.solid,
                material,
            },
            inclusions: file.inclusions,
            shell: file.shell,
            taxels: file.taxels,
            readout: file.readout,
            indenters: file.indenters,
            limits: file.limits,
            import: file.import,
            surfaces,
        };
        sensor.check(&document)?;
        Ok(sensor)
    }
}

const MATERIAL: &str = "gel.material";

/// The table of the gel's material, and the material.
fn load_material(
    document: &Document<SensorToml>,
    load: &dyn Fn(&str) -> std::io::Result<Vec<u8>>,
) -> Result<(Table, GelMaterial), SensorError> {
    match &document.value.gel.material {
        Value::Table(table) => Ok((table.clone(), material(table, document, MATERIAL)?)),
        Value::String(path) => {
            let bytes = load(path).map_err(|found| {
                let problem = format!("names `{path}`, which cannot be read: {found}");
                document.error(MATERIAL, problem, "give a path relative to this file")
            })?;
            let file = twintac_config::parse::<Table>(path, &String::from_utf8_lossy(&bytes))?;
            let material = material(&file.value, &file, "")?;
            Ok((file.value, material))
        }
        _ => {
            let hint = "give a table, or the path of a file";
            Err(document.error(MATERIAL, "is neither a table nor a text", hint))
        }
    }
}

fn load_surfaces(
    document: &Document<SensorToml>,
    load: &dyn Fn(&str) -> std::io::Result<Vec<u8>>,
) -> Result<Surfaces, SensorError> {
    let file = &document.value;
    let mut surfaces = Surfaces::new();
    for (field, surface) in surface_files(&file.gel.solid, &file.indenters) {
        let loaded = load_surface(document, &field, surface, load)?;
        surfaces.insert(surface.name().into_owned(), Arc::new(loaded));
    }
    Ok(surfaces)
}

/// Loads the surface of an STL file whose path is in a field.
pub(crate) fn load_surface<T>(
    document: &Document<T>,
    field: &str,
    file: &SurfaceFile,
    load: &dyn Fn(&str) -> std::io::Result<Vec<u8>>,
) -> Result<TriangleSurface, SensorError> {
    file.validate().map_err(|error| {
        let beside = field.strip_suffix("path").expect("the field is a path");
        let (field, hint) = (
            format!("{beside}{}", error.field),
            format!("give {}", error.expected),
        );
        document.error(&field, format!("is {}", error.found), &hint)
    })?;
    let path = &file.path;
    let error =
        |problem: String, hint: &str| document.error(field, format!("names `{path}`, which {problem}"), hint);
    let bytes = load(path).map_err(|found| {
        error(
            format!("cannot be read: {found}"),
            "give a path relative to this file",
        )
    })?;
    TriangleSurface::from_stl(&bytes, file.mm_per_unit()).map_err(|found| {
        let (problem, remedy) = found.problem_and_remedy();
        error(problem, &remedy)
    })
}
