use super::*;
use crate::Isochoric;
use crate::material::{Memory, Relaxation, contract};
use proptest::prelude::*;

const LAWS: [Isochoric; 3] = [
    Isochoric::NeoHookean {
        shear_modulus_kpa: 23.5,
    },
    Isochoric::MooneyRivlin {
        c10_kpa: 8.0,
        c01_kpa: 3.5,
    },
    Isochoric::Yeoh {
        c10_kpa: 7.9,
        c20_kpa: 0.9,
        c30_kpa: 0.12,
    },
];
const PRESSURE: f64 = 0.004;

fn element() -> Element {
    let corners = [
        DVec3::ZERO,
        DVec3::new(1.1, 0.1, 0.0),
        DVec3::new(0.2, 0.9, -0.1),
        DVec3::new(0.1, 0.3, 0.8),
    ];
    Element::new([0, 1, 2, 3], corners)
}

/// Energy, and the response it is made of. The offset is what a material remembers.
fn energy(law: &Isochoric, offset: &DMat3, u: &[DVec3]) -> (f64, Deformation, crate::material::Response) {
    let element = element();
    let deformation = element.deformation(u);
    let response =
        Relaxation::new(&[], 0.0).response_mpa(law, offset, &deformation.isochoric_right_cauchy_green());
    let energy = element.volume_mm3 * (response.energy - PRESSURE * (deformation.volume_ratio - 1.0));
    (energy, deformation, response)
}

fn forces(law: &Isochoric, offset: &DMat3, u: &[DVec3]) -> [DVec3; 4] {
    let (_, deformation, response) = energy(law, offset, u);
    element().forces(&deformation, &response, PRESSURE)
}

proptest! {
    #[test]
    fn forces_and_tangent_are_the_slopes_of_the_energy(
        u in prop::array::uniform4(prop::array::uniform3(-0.15..0.15_f64)),
        remembered in prop::array::uniform6(-0.005..0.005_f64),
    ) {
        let u = u.map(DVec3::from_array);
        let [a, b, c, d, e, f] = remembered;
        let offset = DMat3::from_cols(DVec3::new(a, d, e), DVec3::new(d, b, f), DVec3::new(e, f, c));
        let step = 1e-5;
        for law in &LAWS {
            let found = forces(law, &offset, &u);
            let (_, deformation, response) = energy(law, &offset, &u);
            let tangent = element().tangent(&deformation, &response, PRESSURE);
            for b in 0..4 {
                for j in 0..3 {
                    let moved = |sign: f64| {
                        let mut moved = u;
                        moved[b][j] += sign * step;
                        moved
                    };
                    let slope = (energy(law, &offset, &moved(1.0)).0 - energy(law, &offset, &moved(-1.0)).0) / (2.0 * step);
                    prop_assert!((found[b][j] - slope).abs() < 1e-9, "{law:?} force {} {slope}", found[b][j]);
                    let volume = |u: &[DVec3]| element().volume_mm3 * element().deformation(u).volume_ratio;
                    let slope = (volume(&moved(1.0)) - volume(&moved(-1.0))) / (2.0 * step);
                    prop_assert!((tangent.volume_slope[b][j] - slope).abs() < 1e-9);
                    let (after, before) = (forces(law, &offset, &moved(1.0)), forces(law, &offset, &moved(-1.0)));
                    for a in b..4 {
                        for i in 0..3 {
                            let slope = (after[a][i] - before[a][i]) / (2.0 * step);
                            let found = tangent.stiffness[a * (a + 1) / 2 + b].col(j)[i];
                            prop_assert!((found - slope).abs() < 1e-8, "{law:?} stiffness {found} {slope}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_turned_body_feels_nothing(axis in prop::array::uniform3(-1.0..1.0_f64), angle in -3.0..3.0_f64) {
        let axis = DVec3::from_array(axis).normalize_or(DVec3::Z);
        let deformation = Deformation::new(DMat3::from_axis_angle(axis, angle));
        for law in &LAWS {
            let response = law.response_mpa(&deformation.isochoric_right_cauchy_green());
            let stress = deformation.first_piola_kirchhoff(&response, 0.0);
            prop_assert!(contract(&stress, &stress).sqrt() < 1e-15, "{stress}");
            prop_assert!(response.energy.abs() < 1e-15);
        }
    }
}

#[test]
fn an_elastic_material_remembers_nothing() {
    let offset = Relaxation::new(&[], 1.0).offset(&Memory::new(3, &[]), 2);
    assert_eq!(offset, DMat3::ZERO);
}
