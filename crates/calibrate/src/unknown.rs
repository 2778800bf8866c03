//! Unknowns: where each is sought, and what it does to the material.

use glam::DVec3;
use twintac_softbody::{Direction, Isochoric, Material};

use crate::curve::{Curve, Quantity};
use crate::scale::Scale;
use crate::{CalibrateError, Parameter};

/// One number that a fit seeks.
#[derive(Clone, Debug)]
pub(crate) struct Unknown {
    pub(crate) parameter: Parameter,
    /// The curve, or the taxel, that it belongs to, if it does not belong to all.
    pub(crate) owner: Option<usize>,
    pub(crate) name: String,
    pub(crate) scale: Scale,
    /// Coordinate to start from.
    pub(crate) start: f64,
    /// Coordinates that are not left.
    pub(crate) bounds: [f64; 2],
    /// Largest step at once.
    pub(crate) reach: f64,
}

/// The unknowns of a fit, and the material that they change.
#[derive(Clone, Debug)]
pub(crate) struct Unknowns {
    pub(crate) all: Vec<Unknown>,
    material: Material,
    /// Whether the bulk modulus follows the shear modulus: Poisson's ratio is fixed, or an unknown of its own.
    keeps_ratio: bool,
}

/// Bulk over shear modulus at a Poisson's ratio.
fn bulk_over_shear(ratio: f64) -> f64 {
    2.0 * (1.0 + ratio) / (3.0 * (1.0 - 2.0 * ratio))
}

fn ratio_of(material: &Material) -> f64 {
    let (bulk, shear) = (material.bulk_modulus_kpa, material.isochoric.shear_modulus_kpa());
    (3.0 * bulk - 2.0 * shear) / (6.0 * bulk + 2.0 * shear)
}

impl Unknowns {
    pub(crate) fn new(
        material: &Material,
        curves: &[Curve],
        free: &[Parameter],
        taxel_name: &dyn Fn(usize) -> String,
    ) -> Result<Self, CalibrateError> {
        let refuse = |parameter: Parameter, reason: &str| {
            Err(CalibrateError::NotFree {
                name: parameter.to_string(),
                reason: reason.to_owned(),
            })
        };
        let quantities = || {
            curves
                .iter()
                .flat_map(|curve| &curve.signals)
                .map(|signal| signal.quantity)
        };
        let has_force = quantities().any(|quantity| quantity == Quantity::Force);
        let mut free = free.to_vec();
        if quantities().any(|quantity| quantity != Quantity::Force) {
            free.push(Parameter::Gain);
        }
        free.sort_unstable();
        free.dedup();
        if free.contains(&Parameter::BulkModulus) && free.contains(&Parameter::PoissonsRatio) {
            return refuse(
                Parameter::BulkModulus,
                "Poisson's ratio is free already, and says the same",
            );
        }
        let mut unknowns = Self {
            all: Vec::new(),
            material: material.clone(),
            keeps_ratio: !free.contains(&Parameter::BulkModulus),
        };
        for parameter in free {
            let owners: Vec<Option<usize>> = match parameter {
                Parameter::DepthOffset | Parameter::ForceOffset => (0..curves.len()).map(Some).collect(),
                Parameter::Gain => {
                    let mut taxels: Vec<usize> = quantities()
                        .filter_map(|quantity| match quantity {
                            Quantity::Force => None,
                            Quantity::Taxel(taxel) => Some(taxel),
                        })
                        .collect();
                    taxels.sort_unstable();
                    taxels.dedup();
                    taxels.into_iter().map(Some).collect()
                }
                Parameter::ForceScale if !has_force => {
                    return refuse(parameter, "no force was measured");
                }
                Parameter::ShearModulus | Parameter::C10 if !has_force => {
                    let reason = "readings with a gain of their own per taxel tell no stiffness, only ratios of constants";
                    return refuse(parameter, reason);
                }
                _ => vec![None],
            };
            for owner in owners {
                let curve = owner
                    .filter(|_| parameter != Parameter::Gain)
                    .map(|curve| curves[curve].name.as_str());
                let name = match (curve, owner) {
                    (Some(curve), _) if curves.len() > 1 => format!("{parameter} of {curve}"),
                    (None, Some(taxel)) => format!("gain of {}", taxel_name(taxel)),
                    _ => parameter.to_string(),
                };
                match unknowns.unknown(parameter, owner, name) {
                    Ok(unknown) => unknowns.all.push(unknown),
                    Err(reason) => return refuse(parameter, &reason),
                }
            }
        }
        Ok(unknowns)
    }

    fn unknown(&self, parameter: Parameter, owner: Option<usize>, name: String) -> Result<Unknown, String> {
        let material = &self.material;
        let term = |index: usize| {
            let n = material.prony.len();
            material.prony.get(index).ok_or_else(|| {
                format!("the material has {n} Prony terms; describe as many as are sought, with rough values")
            })
        };
        let foreign = || {
            format!(
                "the material's model has no such constant; it has {}",
                constants(material)
            )
        };
        let positive = |value: f64, name: &str| {
            if value > 0.0 {
                Ok((Scale::Log, value))
            } else {
                Err(format!(
                    "the sensor's {name} is {value}; describe a rough value above 0 to start from"
                ))
            }
        };
        let (scale, value) = match (parameter, material.isochoric) {
            (Parameter::ShearModulus, Isochoric::NeoHookean { shear_modulus_kpa }) => {
                positive(shear_modulus_kpa, "shear modulus")?
            }
            (Parameter::C10, Isochoric::MooneyRivlin { c10_kpa, .. } | Isochoric::Yeoh { c10_kpa, .. }) => {
                positive(c10_kpa, "C10")?
            }
            (Parameter::C01, Isochoric::MooneyRivlin { c01_kpa, .. }) => positive(c01_kpa, "C01")?,
            (Parameter::C20, Isochoric::Yeoh { c20_kpa, .. }) => (Scale::Linear, c20_kpa),
            (Parameter::C30, Isochoric::Yeoh { c30_kpa, .. }) => (Scale::Linear, c30_kpa),
            (
                Parameter::ShearModulus | Parameter::C10 | Parameter::C01 | Parameter::C20 | Parameter::C30,
                _,
            ) => return Err(foreign()),
            (Parameter::BulkModulus, _) => (Scale::Log, material.bulk_modulus_kpa),
            (Parameter::PoissonsRatio, _) => (Scale::Linear, ratio_of(material)),
            (Parameter::PronyWeight(index), _) => (Scale::Logit, term(index)?.weight),
            (Parameter::PronyTime(index), _) => (Scale::Log, term(index)?.time_s),
            (Parameter::DepthOffset | Parameter::ForceOffset, _) => (Scale::Linear, 0.0),
            (Parameter::ForceScale | Parameter::Gain, _) => (Scale::Log, 1.0),
        };
        let start = scale.coordinate(value);
        let shear_kpa = material.isochoric.shear_modulus_kpa();
        let (bounds, reach) = match (parameter, scale) {
            // Forces are about straight in the ratio, on any scale that opens up towards 1/2 they are not.
            (Parameter::PoissonsRatio, _) => ([0.05, 0.4999], 0.05),
            (Parameter::DepthOffset, _) => ([-1.0, 1.0], 0.1),
            (Parameter::C20 | Parameter::C30, _) => ([-10.0 * shear_kpa, 10.0 * shear_kpa], 0.2 * shear_kpa),
            (Parameter::Gain, _) => ([f64::NEG_INFINITY, f64::INFINITY], 10.0),
            (_, Scale::Linear) => ([f64::NEG_INFINITY, f64::INFINITY], f64::INFINITY),
            (_, Scale::Logit) => ([-7.0, 3.0], 1.0),
            _ => ([start - 1e3_f64.ln(), start + 1e3_f64.ln()], 0.7),
        };
        Ok(Unknown {
            parameter,
            owner,
            name,
            scale,
            start: start.clamp(bounds[0], bounds[1]),
            bounds,
            reach,
        })
    }

    /// The material at these coordinates.
    pub(crate) fn material(&self, x: &[f64]) -> Material {
        let mut material = self.material.clone();
        let mut over_shear = self.material.bulk_modulus_kpa / self.material.isochoric.shear_modulus_kpa();
        for (unknown, x) in self.all.iter().zip(x) {
            let value = unknown.scale.value(*x);
            match (unknown.parameter, &mut material.isochoric) {
                (
                    Parameter::ShearModulus,
                    Isochoric::NeoHookean {
                        shear_modulus_kpa: constant,
                    },
                )
                | (
                    Parameter::C10,
                    Isochoric::MooneyRivlin {
                        c10_kpa: constant, ..
                    }
                    | Isochoric::Yeoh {
                        c10_kpa: constant, ..
                    },
                )
                | (
                    Parameter::C01,
                    Isochoric::MooneyRivlin {
                        c01_kpa: constant, ..
                    },
                )
                | (
                    Parameter::C20,
                    Isochoric::Yeoh {
                        c20_kpa: constant, ..
                    },
                )
                | (
                    Parameter::C30,
                    Isochoric::Yeoh {
                        c30_kpa: constant, ..
                    },
                ) => *constant = value,
                (Parameter::BulkModulus, _) => material.bulk_modulus_kpa = value,
                (Parameter::PoissonsRatio, _) => over_shear = bulk_over_shear(value),
                (Parameter::PronyWeight(term), _) => material.prony[term].weight = value,
                (Parameter::PronyTime(term), _) => material.prony[term].time_s = value,
                _ => {}
            }
        }
        if self.keeps_ratio {
            material.bulk_modulus_kpa = over_shear * material.isochoric.shear_modulus_kpa();
        }
        material
    }

    /// How a coordinate changes the presses of a curve; none where it does not.
    pub(crate) fn direction(&self, index: usize, curve: usize, x: &[f64]) -> Option<Direction> {
        let unknown = &self.all[index];
        let material = self.material(x);
        let mut direction = Direction::zero(&material);
        let rate = unknown.scale.rate(x[index]);
        match (unknown.parameter, &mut direction.material.isochoric) {
            (
                Parameter::ShearModulus,
                Isochoric::NeoHookean {
                    shear_modulus_kpa: constant,
                },
            )
            | (
                Parameter::C10,
                Isochoric::MooneyRivlin {
                    c10_kpa: constant, ..
                }
                | Isochoric::Yeoh {
                    c10_kpa: constant, ..
                },
            )
            | (
                Parameter::C01,
                Isochoric::MooneyRivlin {
                    c01_kpa: constant, ..
                },
            )
            | (
                Parameter::C20,
                Isochoric::Yeoh {
                    c20_kpa: constant, ..
                },
            )
            | (
                Parameter::C30,
                Isochoric::Yeoh {
                    c30_kpa: constant, ..
                },
            ) => *constant = rate,
            (Parameter::BulkModulus, _) => direction.material.bulk_modulus_kpa = rate,
            (Parameter::PoissonsRatio, _) => {
                // d/dν of 2 (1 + ν)/(3 (1 - 2 ν)) is 2/(1 - 2 ν)².
                let below = 1.0 - 2.0 * unknown.scale.value(x[index]);
                direction.material.bulk_modulus_kpa =
                    rate * material.isochoric.shear_modulus_kpa() * 2.0 / below.powi(2);
            }
            (Parameter::PronyWeight(term), _) => direction.material.prony[term].weight = rate,
            (Parameter::PronyTime(term), _) => direction.material.prony[term].time_s = rate,
            (Parameter::DepthOffset, _) if unknown.owner == Some(curve) => {
                direction.indenter_mm = DVec3::NEG_Z * rate;
            }
            _ => return None,
        }
        if self.keeps_ratio {
            let shear_rate = direction.material.isochoric.shear_modulus_kpa();
            direction.material.bulk_modulus_kpa +=
                material.bulk_modulus_kpa / material.isochoric.shear_modulus_kpa() * shear_rate;
        }
        Some(direction)
    }

    /// The value of a parameter that belongs to a curve or a taxel, or its usual value.
    pub(crate) fn value(&self, parameter: Parameter, owner: Option<usize>, x: &[f64], usual: f64) -> f64 {
        let mut all = self.all.iter().zip(x);
        let found = all.find(|(unknown, _)| unknown.parameter == parameter && unknown.owner == owner);
        found.map_or(usual, |(unknown, x)| unknown.scale.value(*x))
    }
}

fn constants(material: &Material) -> &'static str {
    match material.isochoric {
        Isochoric::NeoHookean { .. } => "shear_modulus_kpa",
        Isochoric::MooneyRivlin { .. } => "c10_kpa and c01_kpa",
        Isochoric::Yeoh { .. } => "c10_kpa, c20_kpa and c30_kpa",
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
    use super::*;

    #[test]
    fn directions_are_differences_of_materials() {
        let material = Material {
            prony: vec![twintac_softbody::PronyTerm {
                weight: 0.2,
                time_s: 3.0,
            }],
            ..Material::neo_hookean(60.0, 0.47)
        };
        let free = [
            Parameter::ShearModulus,
            Parameter::PoissonsRatio,
            Parameter::PronyWeight(0),
            Parameter::PronyTime(0),
        ];
        let curve = Curve {
            name: "a".into(),
            shape: twintac_shape::Shape::Sphere { radius_mm: 3.0 },
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
        let x: Vec<f64> = unknowns.all.iter().map(|unknown| unknown.start).collect();
        for index in 0..x.len() {
            let moved = |by: f64| {
                let mut x = x.clone();
                x[index] += by;
                unknowns.material(&x)
            };
            let (after, before) = (moved(1e-5), moved(-1e-5));
            let direction = unknowns.direction(index, 0, &x).unwrap().material;
            let pairs = [
                (
                    after.bulk_modulus_kpa,
                    before.bulk_modulus_kpa,
                    direction.bulk_modulus_kpa,
                ),
                (
                    after.prony[0].weight,
                    before.prony[0].weight,
                    direction.prony[0].weight,
                ),
                (
                    after.prony[0].time_s,
                    before.prony[0].time_s,
                    direction.prony[0].time_s,
                ),
                (
                    after.isochoric.shear_modulus_kpa(),
                    before.isochoric.shear_modulus_kpa(),
                    direction.isochoric.shear_modulus_kpa(),
                ),
            ];
            for (after, before, rate) in pairs {
                let difference = (after - before) / 2e-5;
                assert!(
                    (difference - rate).abs() <= 1e-6 * rate.abs().max(1e-3),
                    "{index}: {difference} {rate}"
                );
            }
        }
    }
}
