//! Every material law of the soft body, with its energy written independently as a function of the
//! principal stretches.

use glam::DVec3;
use twintac_material::{
    LogarithmicNeoHookean, Material, Model, MooneyRivlin, NeoHookean, Ogden, OgdenTerm, StableNeoHookean,
    Yeoh,
};

/// Bulk modulus of all laws, kPa: 50 times the shear modulus.
const BULK_KPA: f64 = 1200.0;

/// Shear modulus of the laws with one constant, kPa.
const SHEAR_KPA: f64 = 23.5;

/// Terms of an Ogden series: modulus, kPa, and exponent.
const TERMS: [(f64, f64); 3] = [(9.0, 1.3), (0.6, 4.5), (-3.0, -2.0)];

/// A law and its energy per reference volume, kPa, in the principal stretches. The energy of the
/// mean volume change is added to it.
pub(crate) struct Rubber {
    pub(crate) name: &'static str,
    pub(crate) law: Model,
    energy_kpa: fn(DVec3) -> f64,
}

/// All laws.
pub(crate) fn rubbers() -> Vec<Rubber> {
    let terms = TERMS.map(|(mu_kpa, alpha)| OgdenTerm { mu_kpa, alpha });
    vec![
        Rubber {
            name: "neo-Hookean",
            law: NeoHookean {
                shear_modulus_kpa: SHEAR_KPA,
            }
            .into(),
            energy_kpa: |stretches| 0.5 * SHEAR_KPA * (isochoric(stretches).element_sum() - 3.0),
        },
        Rubber {
            name: "Mooney–Rivlin",
            law: MooneyRivlin {
                c10_kpa: 8.0,
                c01_kpa: 3.5,
            }
            .into(),
            energy_kpa: |stretches| {
                let squares = isochoric(stretches);
                // For an isochoric deformation the product of the squares is 1.
                8.0 * (squares.element_sum() - 3.0) + 3.5 * (squares.recip().element_sum() - 3.0)
            },
        },
        Rubber {
            name: "Yeoh",
            law: Yeoh {
                c10_kpa: 7.9,
                c20_kpa: 0.9,
                c30_kpa: 0.12,
            }
            .into(),
            energy_kpa: |stretches| {
                let first = isochoric(stretches).element_sum() - 3.0;
                first * (7.9 + first * (0.9 + 0.12 * first))
            },
        },
        Rubber {
            name: "Ogden",
            law: Ogden {
                terms: terms.to_vec(),
            }
            .into(),
            energy_kpa: |stretches| {
                let of_term = |(mu, alpha): (f64, f64)| {
                    mu / alpha * (isochoric(stretches).powf(0.5 * alpha).element_sum() - 3.0)
                };
                TERMS.into_iter().map(of_term).sum()
            },
        },
        Rubber {
            name: "logarithmic neo-Hookean",
            law: LogarithmicNeoHookean {
                shear_modulus_kpa: SHEAR_KPA,
            }
            .into(),
            energy_kpa: |stretches| {
                0.5 * SHEAR_KPA * (stretches.length_squared() - 3.0)
                    - SHEAR_KPA * stretches.element_product().ln()
            },
        },
        Rubber {
            name: "stable neo-Hookean",
            law: StableNeoHookean {
                shear_modulus_kpa: SHEAR_KPA,
            }
            .into(),
            energy_kpa: |stretches| {
                let (modulus, first) = (4.0 / 3.0 * SHEAR_KPA, stretches.length_squared());
                0.5 * modulus * (first - 3.0 - ((first + 1.0) / 4.0).ln())
                    - 0.75 * modulus * (stretches.element_product() - 1.0)
            },
        },
    ]
}

/// Squares of the isochoric principal stretches.
fn isochoric(stretches: DVec3) -> DVec3 {
    stretches * stretches / stretches.element_product().cbrt().powi(2)
}

impl Rubber {
    pub(crate) fn material(&self) -> Material {
        Material {
            model: self.law.clone(),
            bulk_modulus_kpa: BULK_KPA,
            prony: Vec::new(),
        }
    }

    /// Energy per reference volume, kPa.
    fn whole_energy_kpa(&self, stretches: DVec3) -> f64 {
        let change = stretches.element_product() - 1.0;
        (self.energy_kpa)(stretches) + 0.5 * self.material().volume_modulus_kpa() * change * change
    }

    /// First Piola–Kirchhoff stress, kPa: the derivatives `∂W/∂λ_i` by differences of sixth order,
    /// accurate to ten digits.
    pub(crate) fn principal_stress_kpa(&self, stretches: DVec3) -> DVec3 {
        const STEP: f64 = 1e-3;
        let slope = |axis: DVec3| {
            let energy = |steps: f64| self.whole_energy_kpa(stretches + axis * (steps * STEP));
            let difference = |steps: f64| energy(steps) - energy(-steps);
            (45.0 * difference(1.0) - 9.0 * difference(2.0) + difference(3.0)) / (60.0 * STEP)
        };
        DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z))
    }

    /// Hydrostatic pressure, kPa: `-Σ λ_i ∂W/∂λ_i / 3J`.
    pub(crate) fn pressure_kpa(&self, stretches: DVec3) -> f64 {
        -self.principal_stress_kpa(stretches).dot(stretches) / (3.0 * stretches.element_product())
    }

    /// The stretches of a block that is pulled along x to `stretch` and, if `is_equibiaxial`, along
    /// y as well, while its other sides are free.
    pub(crate) fn free_stretches(&self, stretch: f64, is_equibiaxial: bool) -> DVec3 {
        let at = |free: f64| DVec3::new(stretch, if is_equibiaxial { stretch } else { free }, free);
        let (mut low, mut high) = (0.2, 3.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.principal_stress_kpa(at(middle)).z < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        at(0.5 * (low + high))
    }
}
