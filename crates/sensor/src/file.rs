//! What stands in a description's TOML.

use serde::Deserialize;
use twintac_config::{ConfigError, Document};
use twintac_shape::Solid;

use crate::{Inclusion, Indenter, Material, Model, PronyTerm, Readout, Shell, Taxel};

/// The file as it is written, before anything is checked.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SensorFile {
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
    pub(crate) import: Option<String>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GelFile {
    pub(crate) solid: Solid,
    pub(crate) material: MaterialFile,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MaterialFile {
    #[serde(default)]
    model: ModelName,
    youngs_modulus_kpa: Option<f64>,
    shear_modulus_kpa: Option<f64>,
    c10_kpa: Option<f64>,
    c01_kpa: Option<f64>,
    c20_kpa: Option<f64>,
    c30_kpa: Option<f64>,
    poissons_ratio: Option<f64>,
    bulk_modulus_kpa: Option<f64>,
    #[serde(default)]
    prony: Vec<PronyTerm>,
    source: String,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum ModelName {
    #[default]
    NeoHookean,
    MooneyRivlin,
    Yeoh,
}

/// Volume's part of the stiffness, as it is given.
#[derive(Clone, Copy)]
enum Compressibility {
    PoissonsRatio(f64),
    BulkModulusKpa(f64),
}

const AT: &str = "gel.material";

impl MaterialFile {
    /// The material that the file means.
    pub(crate) fn resolve(&self, document: &Document<SensorFile>) -> Result<Material, ConfigError> {
        let compressibility = self.compressibility(document)?;
        let model = self.model(document, compressibility)?;
        let shear_modulus_kpa = model.shear_modulus_kpa();
        let bulk_modulus_kpa = match compressibility {
            Compressibility::BulkModulusKpa(bulk_modulus_kpa) => bulk_modulus_kpa,
            Compressibility::PoissonsRatio(ratio) => {
                2.0 * shear_modulus_kpa * (1.0 + ratio) / (3.0 * (1.0 - 2.0 * ratio))
            }
        };
        if 3.0 * bulk_modulus_kpa <= 2.0 * shear_modulus_kpa {
            let problem = format!(
                "is {bulk_modulus_kpa}, which with a shear modulus of {shear_modulus_kpa} kPa makes a negative Poisson's ratio"
            );
            return Err(document.error(
                "gel.material.bulk_modulus_kpa",
                problem,
                "give more than 2/3 of the shear modulus",
            ));
        }
        self.check_relaxation(document)?;
        if self.source.trim().is_empty() {
            let hint = "say where the constants come from";
            return Err(document.error("gel.material.source", "is empty", hint));
        }
        Ok(Material {
            model,
            bulk_modulus_kpa,
            prony: self.prony.clone(),
            source: self.source.clone(),
        })
    }

    fn compressibility(&self, document: &Document<SensorFile>) -> Result<Compressibility, ConfigError> {
        match (self.poissons_ratio, self.bulk_modulus_kpa) {
            (Some(ratio), None) if ratio > 0.0 && ratio < 0.5 => Ok(Compressibility::PoissonsRatio(ratio)),
            (Some(ratio), None) => {
                let hint = "give more than 0 and less than 0.5";
                Err(document.error("gel.material.poissons_ratio", format!("is {ratio}"), hint))
            }
            (None, Some(bulk)) => {
                positive(document, "bulk_modulus_kpa", bulk).map(Compressibility::BulkModulusKpa)
            }
            (Some(_), Some(_)) => {
                let problem = "stands beside `poissons_ratio`";
                Err(document.error("gel.material.bulk_modulus_kpa", problem, "keep one of the two"))
            }
            (None, None) => {
                let hint = "give `poissons_ratio` or `bulk_modulus_kpa`";
                Err(document.error(AT, "says nothing about volume", hint))
            }
        }
    }

    fn model(&self, document: &Document<SensorFile>, volume: Compressibility) -> Result<Model, ConfigError> {
        use ModelName::{MooneyRivlin, NeoHookean, Yeoh};
        let given = [
            ("youngs_modulus_kpa", self.youngs_modulus_kpa, NeoHookean),
            ("shear_modulus_kpa", self.shear_modulus_kpa, NeoHookean),
            ("c01_kpa", self.c01_kpa, MooneyRivlin),
            ("c20_kpa", self.c20_kpa, Yeoh),
            ("c30_kpa", self.c30_kpa, Yeoh),
        ];
        let foreign = given
            .iter()
            .find(|(_, value, model)| value.is_some() && *model != self.model)
            .map(|given| given.0);
        let foreign = foreign.or((self.model == NeoHookean && self.c10_kpa.is_some()).then_some("c10_kpa"));
        if let Some(name) = foreign {
            let hint = "remove it, or choose the `model` that it belongs to";
            return Err(document.error(&format!("{AT}.{name}"), "is not a constant of this model", hint));
        }
        let needed = |name: &str, value: Option<f64>| {
            let hint = format!("give `{name}`");
            value.ok_or_else(|| document.error(AT, format!("lacks `{name}`"), hint))
        };
        match self.model {
            NeoHookean => {
                let shear_modulus_kpa = match (self.youngs_modulus_kpa, self.shear_modulus_kpa) {
                    (None, Some(shear)) => positive(document, "shear_modulus_kpa", shear)?,
                    (Some(youngs), None) => {
                        shear_from_youngs(positive(document, "youngs_modulus_kpa", youngs)?, volume)
                    }
                    (Some(_), Some(_)) => {
                        let problem = "stands beside `youngs_modulus_kpa`";
                        return Err(document.error(
                            "gel.material.shear_modulus_kpa",
                            problem,
                            "keep one of the two",
                        ));
                    }
                    (None, None) => {
                        let hint = "give `youngs_modulus_kpa` or `shear_modulus_kpa`";
                        return Err(document.error(AT, "has no stiffness", hint));
                    }
                };
                if shear_modulus_kpa <= 0.0 {
                    let hint = "give less than 9 times the bulk modulus";
                    return Err(document.error(
                        "gel.material.youngs_modulus_kpa",
                        "is too large for this bulk modulus",
                        hint,
                    ));
                }
                Ok(Model::NeoHookean { shear_modulus_kpa })
            }
            MooneyRivlin => {
                let c10_kpa = positive(document, "c10_kpa", needed("c10_kpa", self.c10_kpa)?)?;
                let c01_kpa = needed("c01_kpa", self.c01_kpa)?;
                if c01_kpa < 0.0 {
                    let problem = format!("is {c01_kpa}");
                    return Err(document.error("gel.material.c01_kpa", problem, "give 0 or more"));
                }
                Ok(Model::MooneyRivlin { c10_kpa, c01_kpa })
            }
            Yeoh => Ok(Model::Yeoh {
                c10_kpa: positive(document, "c10_kpa", needed("c10_kpa", self.c10_kpa)?)?,
                c20_kpa: needed("c20_kpa", self.c20_kpa)?,
                c30_kpa: needed("c30_kpa", self.c30_kpa)?,
            }),
        }
    }

    fn check_relaxation(&self, document: &Document<SensorFile>) -> Result<(), ConfigError> {
        for (index, term) in self.prony.iter().enumerate() {
            positive(document, &format!("prony[{index}].weight"), term.weight)?;
            positive(document, &format!("prony[{index}].time_s"), term.time_s)?;
        }
        let relaxing: f64 = self.prony.iter().map(|term| term.weight).sum();
        if relaxing >= 1.0 {
            let problem = format!("relaxes {relaxing} of the stiffness");
            return Err(document.error(
                "gel.material.prony",
                problem,
                "keep the sum of the weights below 1",
            ));
        }
        Ok(())
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

fn positive(document: &Document<SensorFile>, name: &str, value: f64) -> Result<f64, ConfigError> {
    if value > 0.0 {
        return Ok(value);
    }
    Err(document.error(
        &format!("{AT}.{name}"),
        format!("is {value}"),
        "give a number above 0",
    ))
}
