//! Every law that the soft body knows, with its energy written a second time, as a function of the principal stretches.

use glam::DVec3;
use twintac_softbody::{Isochoric, Material};

/// Bulk modulus of all of them, kPa: 50 times the shear modulus.
pub(crate) const BULK_KPA: f64 = 1200.0;

/// A law and its energy of a change of shape, kPa, in `Ī1` and `Ī2`.
pub(crate) struct Rubber {
    pub(crate) name: &'static str,
    pub(crate) law: Isochoric,
    energy_kpa: fn(f64, f64) -> f64,
}

pub(crate) const RUBBERS: &[Rubber] = &[
    Rubber {
        name: "neo-Hookean",
        law: Isochoric::NeoHookean {
            shear_modulus_kpa: 23.5,
        },
        energy_kpa: |first, _| 11.75 * (first - 3.0),
    },
    Rubber {
        name: "Mooney–Rivlin",
        law: Isochoric::MooneyRivlin {
            c10_kpa: 8.0,
            c01_kpa: 3.5,
        },
        energy_kpa: |first, second| 8.0 * (first - 3.0) + 3.5 * (second - 3.0),
    },
    Rubber {
        name: "Yeoh",
        law: Isochoric::Yeoh {
            c10_kpa: 7.9,
            c20_kpa: 0.9,
            c30_kpa: 0.12,
        },
        energy_kpa: |first, _| (first - 3.0) * (7.9 + (first - 3.0) * (0.9 + 0.12 * (first - 3.0))),
    },
];

impl Rubber {
    pub(crate) fn material(&self) -> Material {
        Material {
            isochoric: self.law,
            bulk_modulus_kpa: BULK_KPA,
            prony: Vec::new(),
        }
    }

    /// Energy per reference volume, kPa.
    fn whole_energy_kpa(&self, stretches: DVec3) -> f64 {
        let volume = stretches.element_product();
        let squares = stretches * stretches / volume.cbrt().powi(2);
        let first = squares.element_sum();
        // Of a change of shape the product of the squares is 1.
        let second = squares.recip().element_sum();
        (self.energy_kpa)(first, second) + 0.5 * BULK_KPA * (volume - 1.0).powi(2)
    }

    /// First Piola–Kirchhoff stress, kPa: the slopes `∂W/∂λ_i` by differences of sixth order, good to ten digits.
    pub(crate) fn principal_stress_kpa(&self, stretches: DVec3) -> DVec3 {
        const STEP: f64 = 1e-3;
        let slope = |axis: DVec3| {
            let energy = |steps: f64| self.whole_energy_kpa(stretches + axis * (steps * STEP));
            let difference = |steps: f64| energy(steps) - energy(-steps);
            (45.0 * difference(1.0) - 9.0 * difference(2.0) + difference(3.0)) / (60.0 * STEP)
        };
        DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z))
    }

    /// The stretches of a block pulled along x to `stretch` and, if `is_equibiaxial`, along y as well, while the other sides are free.
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
