//! The table of a material, in a sensor's description or in a file of its own.

use serde::Deserialize;
use toml::{Table, Value};
use twintac_config::{ConfigError, Document};
use twintac_material::{Model, NeoHookean};

use crate::GelMaterial;

/// A table that is read field by field. The fields that remain at the end are the model's
/// constants.
struct Reader<'a, T> {
    rest: Table,
    document: &'a Document<T>,
    /// Path of the table in the document; empty if it is the whole file.
    at: &'a str,
}

/// The compressibility, in the form in which the table gives it.
#[derive(Clone, Copy)]
enum Compressibility {
    PoissonsRatio(f64),
    BulkModulusKpa(f64),
}

/// The material of a table.
pub(crate) fn material<T>(
    table: &Table,
    document: &Document<T>,
    at: &str,
) -> Result<GelMaterial, ConfigError> {
    let mut reader = Reader {
        rest: table.clone(),
        document,
        at,
    };
    let source = reader.source()?;
    let prony = reader.prony()?;
    let compressibility = reader.compressibility()?;
    let model = reader.model(compressibility)?;
    let shear_modulus_kpa = model.shear_modulus_kpa();
    let bulk_modulus_kpa = match compressibility {
        Compressibility::BulkModulusKpa(bulk_modulus_kpa) => bulk_modulus_kpa,
        Compressibility::PoissonsRatio(ratio) => {
            2.0 * shear_modulus_kpa * (1.0 + ratio) / (3.0 * (1.0 - 2.0 * ratio))
        }
    };
    let material = twintac_material::Material {
        model,
        bulk_modulus_kpa,
        prony,
    };
    material
        .check()
        .map_err(|found| reader.error(&found.field, found.problem, found.hint))?;
    Ok(GelMaterial {
        model: material.model,
        bulk_modulus_kpa,
        prony: material.prony,
        source,
    })
}

impl<T> Reader<'_, T> {
    fn error(&self, field: &str, problem: impl Into<String>, hint: impl Into<String>) -> ConfigError {
        let path = match (self.at, field) {
            ("", field) => field.to_owned(),
            (at, "") => at.to_owned(),
            (at, field) => format!("{at}.{field}"),
        };
        self.document.error(&path, problem, hint)
    }

    fn number(&mut self, name: &str) -> Result<Option<f64>, ConfigError> {
        match self.rest.remove(name) {
            None => Ok(None),
            Some(Value::Float(number)) => Ok(Some(number)),
            Some(Value::Integer(number)) => Ok(Some(number as f64)),
            Some(_) => Err(self.error(name, "is not a number", "give a number")),
        }
    }

    fn positive(&mut self, name: &str) -> Result<Option<f64>, ConfigError> {
        match self.number(name)? {
            Some(value) if value <= 0.0 => {
                Err(self.error(name, format!("is {value}"), "give a number above 0"))
            }
            value => Ok(value),
        }
    }

    fn source(&mut self) -> Result<String, ConfigError> {
        let problem = match self.rest.remove("source") {
            Some(Value::String(source)) if !source.trim().is_empty() => return Ok(source),
            Some(Value::String(_)) => "is empty",
            Some(_) => "is not a text",
            None => "is missing",
        };
        Err(self.error("source", problem, "say where the constants come from"))
    }

    fn prony(&mut self) -> Result<Vec<twintac_material::PronyTerm>, ConfigError> {
        let Some(terms) = self.rest.remove("prony") else {
            return Ok(Vec::new());
        };
        terms.try_into().map_err(|found: toml::de::Error| {
            let problem = format!("does not fit: {}", found.message());
            self.error("prony", problem, "give a list of { weight = …, time_s = … }")
        })
    }

    fn compressibility(&mut self) -> Result<Compressibility, ConfigError> {
        match (self.number("poissons_ratio")?, self.positive("bulk_modulus_kpa")?) {
            (Some(ratio), None) if ratio > 0.0 && ratio < 0.5 => Ok(Compressibility::PoissonsRatio(ratio)),
            (Some(ratio), None) => {
                let hint = "give more than 0 and less than 0.5";
                Err(self.error("poissons_ratio", format!("is {ratio}"), hint))
            }
            (None, Some(bulk)) => Ok(Compressibility::BulkModulusKpa(bulk)),
            (Some(_), Some(_)) => {
                let problem = "is given beside `poissons_ratio`";
                Err(self.error("bulk_modulus_kpa", problem, "keep one of the two"))
            }
            (None, None) => {
                let hint = "give `poissons_ratio` or `bulk_modulus_kpa`";
                Err(self.error("", "has no constant for the change of volume", hint))
            }
        }
    }

    /// The model. Its shear modulus may be given as Young's modulus.
    fn model(&mut self, volume: Compressibility) -> Result<Model, ConfigError> {
        let youngs_kpa = self.positive("youngs_modulus_kpa")?;
        if let Some(youngs_kpa) = youngs_kpa {
            if self.rest.contains_key("shear_modulus_kpa") {
                let problem = "is given beside `youngs_modulus_kpa`";
                return Err(self.error("shear_modulus_kpa", problem, "keep one of the two"));
            }
            let shear_kpa = shear_from_youngs(youngs_kpa, volume);
            if shear_kpa <= 0.0 {
                let hint = "give less than 9 times the bulk modulus";
                return Err(self.error("youngs_modulus_kpa", "is too large for this bulk modulus", hint));
            }
            self.rest.insert("shear_modulus_kpa".into(), shear_kpa.into());
        }
        let name = Value::String(
            Model::from(NeoHookean {
                shear_modulus_kpa: 1.0,
            })
            .name()
            .into(),
        );
        self.rest.entry("model").or_insert(name);
        let constants = Value::Table(self.rest.clone());
        let model =
            Model::deserialize(constants).map_err(|found| self.misfit(found.message(), youngs_kpa))?;
        model
            .check()
            .map_err(|found| self.error(&found.field, found.problem, found.hint))?;
        Ok(model)
    }

    /// An error of serde about the constants. Its messages name the field.
    fn misfit(&self, message: &str, youngs_kpa: Option<f64>) -> ConfigError {
        let named = |start: &str| {
            message
                .strip_prefix(start)
                .and_then(|rest| rest.split('`').next())
        };
        if let Some(name) = named("unknown field `") {
            let name = match youngs_kpa {
                Some(_) if name == "shear_modulus_kpa" => "youngs_modulus_kpa",
                _ => name,
            };
            let hint = "remove it, or choose the `model` that it belongs to";
            return self.error(name, "is not a constant of this model", hint);
        }
        match named("missing field `") {
            Some("shear_modulus_kpa") => {
                let hint = "give `youngs_modulus_kpa` or `shear_modulus_kpa`";
                self.error("", "has no stiffness", hint)
            }
            Some(name) => self.error("", format!("lacks `{name}`"), format!("give `{name}`")),
            None => {
                let field = if message.starts_with("unknown variant") {
                    "model"
                } else {
                    ""
                };
                self.error(
                    field,
                    format!("does not fit: {message}"),
                    "correct the name or the value",
                )
            }
        }
    }
}

fn shear_from_youngs(youngs_kpa: f64, volume: Compressibility) -> f64 {
    match volume {
        Compressibility::PoissonsRatio(ratio) => youngs_kpa / (2.0 * (1.0 + ratio)),
        Compressibility::BulkModulusKpa(bulk_kpa) => {
            3.0 * bulk_kpa * youngs_kpa / (9.0 * bulk_kpa - youngs_kpa)
        }
    }
}
