//! The unknowns of a fit: the range of each, and how the material depends on it.

use glam::DVec3;
use twintac_softbody::{Direction, Material};

use crate::constants;
use crate::curve::{Curve, Quantity};
use crate::scale::Scale;
use crate::{CalibrateError, Parameter};

/// Step of the difference quotient of the material, as a fraction of an unknown's reach.
const DIFFERENCE: f64 = 1e-4;

/// One number that a fit seeks.
#[derive(Clone, Debug)]
pub(crate) struct Unknown {
    pub(crate) parameter: Parameter,
    /// The index of the curve or of the taxel that it belongs to; `None` if it belongs to all.
    pub(crate) owner: Option<usize>,
    pub(crate) name: String,
    pub(crate) scale: Scale,
    /// Coordinate to start from.
    pub(crate) start: f64,
    /// Smallest and largest coordinate.
    pub(crate) bounds: [f64; 2],
    /// Largest change in one step.
    pub(crate) reach: f64,
}

/// The unknowns of a fit, and the material that they change.
#[derive(Clone, Debug)]
pub(crate) struct Unknowns {
    pub(crate) all: Vec<Unknown>,
    material: Material,
    /// Whether the bulk modulus follows the shear modulus: Poisson's ratio is fixed, or an unknown
    /// of its own.
    keeps_ratio: bool,
}

/// Ratio of bulk modulus to shear modulus at a Poisson's ratio.
fn bulk_over_shear(ratio: f64) -> f64 {
    2.0 * (1.0 + ratio) / (3.0 * (1.0 - 2.0 * ratio))
}

/// Poisson's ratio at small strain.
pub(crate) fn poissons_ratio(material: &Material) -> f64 {
    let (bulk, shear) = (material.bulk_modulus_kpa, material.model.shear_modulus_kpa());
    (3.0 * bulk - 2.0 * shear) / (6.0 * bulk + 2.0 * shear)
}

impl Unknowns {
    pub(crate) fn new(
        material: &Material,
        curves: &[Curve],
        free: &[Parameter],
        taxel_name: &dyn Fn(usize) -> String,
    ) -> Result<Self, CalibrateError> {
        let refuse = |parameter: &Parameter, reason: &str| {
            Err(CalibrateError::NotFree {
                name: parameter.to_string(),
                reason: reason.to_owned(),
            })
        };
        let signals = curves.iter().flat_map(|curve| &curve.signals);
        let mut taxels: Vec<usize> = signals
            .clone()
            .filter_map(|signal| signal.quantity.taxel())
            .collect();
        taxels.sort_unstable();
        taxels.dedup();
        let mut free = free.to_vec();
        if !taxels.is_empty() && !free.contains(&Parameter::Gain) {
            free.push(Parameter::Gain);
        }
        if let Some(twice) = (1..free.len()).find(|&index| free[..index].contains(&free[index])) {
            return refuse(&free[twice], "it was requested twice");
        }
        let bulk = Parameter::named("bulk_modulus_kpa");
        let keeps_ratio = !free.contains(&bulk);
        if !keeps_ratio && free.contains(&Parameter::PoissonsRatio) {
            return refuse(&bulk, "Poisson's ratio is free already, and determines it");
        }
        if !signals.clone().any(|signal| signal.quantity == Quantity::Force) {
            if free.contains(&Parameter::ForceScale) || free.contains(&Parameter::ForceOffset) {
                return refuse(&Parameter::ForceScale, "no force was measured");
            }
            let mut moduli = constants::names(material);
            moduli.retain(|name| name.ends_with("_kpa") && name != "bulk_modulus_kpa");
            let moduli: Vec<Parameter> = moduli.into_iter().map(Parameter::Constant).collect();
            if moduli.iter().all(|modulus| free.contains(modulus)) {
                let reason = "readings with a free gain for each taxel do not determine the stiffness, only ratios of constants";
                return refuse(&moduli[0], reason);
            }
        }
        let mut unknowns = Self {
            all: Vec::new(),
            material: material.clone(),
            keeps_ratio,
        };
        for parameter in &free {
            let owners: Vec<Option<usize>> = match parameter {
                Parameter::DepthOffset | Parameter::ForceOffset => (0..curves.len()).map(Some).collect(),
                Parameter::Gain => taxels.iter().copied().map(Some).collect(),
                _ => vec![None],
            };
            for owner in owners {
                let name = match (parameter, owner) {
                    (Parameter::Gain, Some(taxel)) => format!("gain of {}", taxel_name(taxel)),
                    (_, Some(curve)) if curves.len() > 1 => format!("{parameter} of {}", curves[curve].name),
                    _ => parameter.to_string(),
                };
                let mut unknown = unknown(material, parameter, owner, name)?;
                if *parameter == Parameter::Friction {
                    unknown.start = curves.iter().map(|curve| curve.friction).fold(0.0, f64::max);
                }
                unknowns.all.push(unknown);
            }
        }
        Ok(unknowns)
    }

    /// The material at these coordinates.
    pub(crate) fn material(&self, x: &[f64]) -> Material {
        let mut over_shear = self.material.bulk_modulus_kpa / self.material.model.shear_modulus_kpa();
        let mut changed = Vec::new();
        for (unknown, x) in self.all.iter().zip(x) {
            let value = unknown.scale.value(*x);
            match &unknown.parameter {
                Parameter::Constant(name) => changed.push((name.as_str(), value)),
                Parameter::PoissonsRatio => over_shear = bulk_over_shear(value),
                _ => (),
            }
        }
        let mut material = constants::with(&self.material, changed);
        if self.keeps_ratio {
            material.bulk_modulus_kpa = over_shear * material.model.shear_modulus_kpa();
        }
        material
    }

    /// How a coordinate changes the presses of a curve; `None` where it does not change them.
    pub(crate) fn direction(&self, index: usize, curve: usize, x: &[f64]) -> Option<Direction> {
        let unknown = &self.all[index];
        let (step, indenter_mm) = match unknown.parameter {
            Parameter::Constant(_) | Parameter::PoissonsRatio => (DIFFERENCE * unknown.reach, DVec3::ZERO),
            Parameter::DepthOffset if unknown.owner == Some(curve) => (DIFFERENCE, DVec3::NEG_Z),
            _ => return None,
        };
        let materials = [-step, step].map(|by| {
            let mut x = x.to_vec();
            x[index] += by;
            self.material(&x)
        });
        Some(Direction {
            materials,
            step,
            indenter_mm,
        })
    }

    /// The value of a parameter that belongs to a curve or a taxel, or `usual` if it is not an
    /// unknown of the fit.
    pub(crate) fn value(&self, parameter: &Parameter, owner: Option<usize>, x: &[f64], usual: f64) -> f64 {
        let mut all = self.all.iter().zip(x);
        let found = all.find(|(unknown, _)| unknown.parameter == *parameter && unknown.owner == owner);
        found.map_or(usual, |(unknown, x)| unknown.scale.value(*x))
    }
}

/// The start, range and scale of a parameter.
fn unknown(
    material: &Material,
    parameter: &Parameter,
    owner: Option<usize>,
    name: String,
) -> Result<Unknown, CalibrateError> {
    const ENDLESS: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
    let (scale, value, bounds, reach) = match parameter {
        Parameter::Constant(constant) => {
            let (scale, value) = constant_scale(material, constant)?;
            let x = scale.coordinate(value);
            match scale {
                Scale::Linear => {
                    let usual = if constant.ends_with("_kpa") {
                        material.model.shear_modulus_kpa()
                    } else {
                        1.0
                    };
                    let size = value.abs().max(usual);
                    (scale, value, [x - 10.0 * size, x + 10.0 * size], 0.2 * size)
                }
                Scale::Logit => (scale, value, [-7.0, 3.0], 1.0),
                _ => (scale, value, [x - 1e3_f64.ln(), x + 1e3_f64.ln()], 0.7),
            }
        }
        // Forces are about linear in the ratio. They are not on a scale that stretches values
        // towards 1/2.
        Parameter::PoissonsRatio => (Scale::Linear, poissons_ratio(material), [0.05, 0.4999], 0.05),
        Parameter::Friction => (Scale::Linear, 0.0, [0.0, 1.0], 0.1),
        Parameter::DepthOffset => (Scale::Linear, 0.0, [-1.0, 1.0], 0.1),
        Parameter::ForceOffset => (Scale::Linear, 0.0, ENDLESS, f64::INFINITY),
        Parameter::ForceScale => (Scale::Log, 1.0, [-1e3_f64.ln(), 1e3_f64.ln()], 0.7),
        Parameter::Gain => (Scale::Log, 1.0, ENDLESS, 10.0),
    };
    Ok(Unknown {
        parameter: parameter.clone(),
        owner,
        name,
        scale,
        start: scale.coordinate(value).clamp(bounds[0], bounds[1]),
        bounds,
        reach,
    })
}

/// The scale of a constant and its initial value. A constant keeps its sign if the material is
/// invalid with the opposite sign.
fn constant_scale(material: &Material, name: &str) -> Result<(Scale, f64), CalibrateError> {
    let Some(value) = constants::get(material, name) else {
        let mut known = constants::names(material);
        known.extend(Parameter::names().map(String::from));
        return Err(CalibrateError::Parameter {
            name: name.to_owned(),
            known: known.join(", "),
        });
    };
    if name.starts_with("prony") && name.ends_with("weight") {
        return Ok((Scale::Logit, value));
    }
    let makes_material = |value: f64| constants::with(material, [(name, value)]).check().is_ok();
    let size = if value == 0.0 { f64::MIN_POSITIVE } else { value };
    match (makes_material(-size), value) {
        (true, _) => Ok((Scale::Linear, value)),
        (false, 0.0) => Err(CalibrateError::NotFree {
            name: name.to_owned(),
            reason: "its described value is 0; describe an approximate value above 0 as a start".into(),
        }),
        (false, value) if value < 0.0 => Ok((Scale::NegativeLog, value)),
        (false, _) => Ok((Scale::Log, value)),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
    use super::*;

    fn scale_of(json: &str, name: &str) -> Scale {
        let model = serde_json::from_str(json).unwrap();
        let material = Material {
            model,
            bulk_modulus_kpa: 800.0,
            prony: Vec::new(),
        };
        constant_scale(&material, name).unwrap().0
    }

    #[test]
    fn what_must_keep_its_sign_does() {
        let yeoh = r#"{"model": "yeoh", "c10_kpa": 8.0, "c20_kpa": 0.0, "c30_kpa": 0.1}"#;
        assert_eq!(scale_of(yeoh, "c10_kpa"), Scale::Log);
        assert_eq!(scale_of(yeoh, "c20_kpa"), Scale::Linear);
        assert_eq!(scale_of(yeoh, "bulk_modulus_kpa"), Scale::Log);
        let ogden = r#"{"model": "ogden", "terms": [{"mu_kpa": -8.0, "alpha": -3.0}]}"#;
        assert_eq!(scale_of(ogden, "terms[0].mu_kpa"), Scale::NegativeLog);
        assert_eq!(scale_of(ogden, "terms[0].alpha"), Scale::NegativeLog);
    }

    #[test]
    fn materials_are_where_coordinates_say() {
        let material = Material::neo_hookean(60.0, 0.47);
        let free = ["shear_modulus_kpa", "poissons_ratio"].map(Parameter::named);
        let curve = Curve {
            name: "a".into(),
            shape: twintac_shape::Shape::Sphere { radius_mm: 3.0 },
            friction: 0.0,
            x_mm: 0.0,
            y_mm: 0.0,
            rotation: glam::DQuat::IDENTITY,
            time_s: vec![0.0, 1.0],
            depth_mm: vec![0.0, 1.0],
            signals: vec![crate::Signal {
                quantity: Quantity::Force,
                values: vec![0.0, 1.0],
            }],
        };
        let unknowns = Unknowns::new(&material, &[curve], &free, &|taxel| taxel.to_string()).unwrap();
        let found = unknowns.material(&[30.0_f64.ln(), 0.4]);
        assert!((found.model.shear_modulus_kpa() - 30.0).abs() < 1e-12);
        assert!((poissons_ratio(&found) - 0.4).abs() < 1e-12);
        let direction = unknowns.direction(0, 0, &[30.0_f64.ln(), 0.4]).unwrap();
        let [before, after] = direction
            .materials
            .map(|material| material.model.shear_modulus_kpa());
        assert!(((after - before) / (2.0 * direction.step) - 30.0).abs() < 1e-6);
    }
}
