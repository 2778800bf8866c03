//! Rates of a press against differences of whole presses.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests
#![allow(clippy::needless_range_loop)] // tables are read with indices

mod common;

use std::sync::Arc;

use common::{Ball, Walls, block, even};
use glam::DVec3;
use twintac_shape::Pose;
use twintac_softbody::{Direction, Isochoric, Material, PronyTerm, SoftBody, SoftBodyError, SolverSettings};

const BALL: Ball = Ball { radius_mm: 6.0 };
const HEIGHT_MM: f64 = 6.0;

/// Depths, mm, at times, s: down, held, and half up again.
const PRESS: [(f64, f64); 7] = [
    (0.1, 0.2),
    (0.2, 0.5),
    (0.4, 0.9),
    (0.7, 1.5),
    (1.2, 1.5),
    (3.0, 1.5),
    (3.3, 0.8),
];

fn body(material: &Material) -> SoftBody {
    let mesh = block(&even(-8.0, 8.0, 6), &even(-7.0, 7.0, 5), &even(0.0, HEIGHT_MM, 2));
    let settings = SolverSettings {
        tolerance: 1e-9,
        ..SolverSettings::default()
    };
    let walls = Walls { half_mm: [8.1, 7.1] };
    SoftBody::new(&mesh, material.clone(), settings)
        .unwrap()
        .with_obstacle(Arc::new(walls), Pose::IDENTITY)
}

/// Force, N, and pressure at a node of the bottom, kPa, in every frame; then their rates along each direction.
fn press(material: &Material, shift_mm: f64, directions: &[Direction]) -> Vec<Vec<[f64; 2]>> {
    let body = body(material);
    let node = body
        .mesh()
        .nodes_mm
        .iter()
        .position(|at| at.z == 0.0 && at.x.abs() < 1e-9 && (at.y - 1.4).abs() < 1e-9)
        .unwrap();
    let mut state = body.rest_with_sensitivities(directions).unwrap();
    let mut previous_s = 0.0;
    let frames = PRESS.iter().map(|&(time_s, depth_mm)| {
        let pose = Pose::from_position(DVec3::new(0.3, 0.2, HEIGHT_MM - depth_mm - shift_mm));
        let frame = body
            .advance(&mut state, &BALL, &pose, time_s - previous_s)
            .unwrap();
        previous_s = time_s;
        let mut row = vec![[-frame.indenter_force_n.z, body.pressure_kpa(&state)[node]]];
        for (index, force) in state.force_sensitivities_n().iter().enumerate() {
            row.push([-force.z, body.pressure_sensitivity_kpa(&state, index)[node]]);
        }
        row
    });
    frames.collect()
}

/// A parameter: its name, a difference to take, and what it does to a material and to the depth.
type Parameter = (&'static str, f64, fn(&mut Material, f64) -> f64);

fn compare(material: &Material, parameters: &[Parameter]) {
    let directions: Vec<Direction> = parameters
        .iter()
        .map(|(_, _, change)| {
            let mut moved = material.clone();
            let depth_mm = change(&mut moved, 1.0);
            let minus = |after: f64, before: f64| after - before;
            let prony = moved.prony.iter().zip(&material.prony);
            Direction {
                material: Material {
                    isochoric: match (moved.isochoric, material.isochoric) {
                        (
                            Isochoric::NeoHookean { shear_modulus_kpa: a },
                            Isochoric::NeoHookean { shear_modulus_kpa: b },
                        ) => Isochoric::NeoHookean {
                            shear_modulus_kpa: minus(a, b),
                        },
                        (
                            Isochoric::MooneyRivlin {
                                c10_kpa: a,
                                c01_kpa: b,
                            },
                            Isochoric::MooneyRivlin {
                                c10_kpa: c,
                                c01_kpa: d,
                            },
                        ) => Isochoric::MooneyRivlin {
                            c10_kpa: minus(a, c),
                            c01_kpa: minus(b, d),
                        },
                        (
                            Isochoric::Yeoh {
                                c10_kpa: a,
                                c20_kpa: b,
                                c30_kpa: c,
                            },
                            Isochoric::Yeoh {
                                c10_kpa: d,
                                c20_kpa: e,
                                c30_kpa: f,
                            },
                        ) => Isochoric::Yeoh {
                            c10_kpa: minus(a, d),
                            c20_kpa: minus(b, e),
                            c30_kpa: minus(c, f),
                        },
                        _ => panic!("two laws"),
                    },
                    bulk_modulus_kpa: minus(moved.bulk_modulus_kpa, material.bulk_modulus_kpa),
                    prony: prony
                        .map(|(after, before)| PronyTerm {
                            weight: minus(after.weight, before.weight),
                            time_s: minus(after.time_s, before.time_s),
                        })
                        .collect(),
                },
                indenter_mm: DVec3::NEG_Z * depth_mm,
            }
        })
        .collect();
    let found = press(material, 0.0, &directions);
    for (index, (name, step, change)) in parameters.iter().enumerate() {
        let moved = |sign: f64| {
            let mut moved = material.clone();
            let depth_mm = change(&mut moved, sign * step);
            press(&moved, depth_mm, &[])
        };
        let (after, before) = (moved(1.0), moved(-1.0));
        for quantity in 0..2 {
            let difference =
                |frame: usize| (after[frame][0][quantity] - before[frame][0][quantity]) / (2.0 * step);
            let largest = (0..PRESS.len())
                .map(|frame| difference(frame).abs())
                .fold(0.0, f64::max);
            for frame in 0..PRESS.len() {
                let (rate, difference) = (found[frame][1 + index][quantity], difference(frame));
                let error = (rate - difference).abs() / largest;
                println!("{name} {quantity} {frame}: {rate:.6e} {difference:.6e} {error:.1e}");
                assert!(error < 1e-4, "{name}, frame {frame}: {rate} for {difference}");
            }
        }
    }
}

fn shift(_: &mut Material, by: f64) -> f64 {
    by
}

#[test]
fn rates_of_an_elastic_press_are_its_differences() {
    let material = Material {
        isochoric: Isochoric::MooneyRivlin {
            c10_kpa: 10.0,
            c01_kpa: 3.0,
        },
        bulk_modulus_kpa: 800.0,
        prony: Vec::new(),
    };
    let c10: fn(&mut Material, f64) -> f64 = |material, by| {
        if let Isochoric::MooneyRivlin { c10_kpa, .. } = &mut material.isochoric {
            *c10_kpa += by;
        }
        0.0
    };
    let c01: fn(&mut Material, f64) -> f64 = |material, by| {
        if let Isochoric::MooneyRivlin { c01_kpa, .. } = &mut material.isochoric {
            *c01_kpa += by;
        }
        0.0
    };
    let bulk: fn(&mut Material, f64) -> f64 = |material, by| {
        material.bulk_modulus_kpa += by;
        0.0
    };
    compare(
        &material,
        &[
            ("C10", 0.02, c10),
            ("C01", 0.02, c01),
            ("K", 2.0, bulk),
            ("depth", 0.0005, shift),
        ],
    );
}

#[test]
fn rates_of_a_relaxing_press_are_its_differences() {
    let material = Material {
        isochoric: Isochoric::Yeoh {
            c10_kpa: 10.0,
            c20_kpa: 2.0,
            c30_kpa: 0.5,
        },
        bulk_modulus_kpa: 500.0,
        prony: vec![
            PronyTerm {
                weight: 0.2,
                time_s: 0.3,
            },
            PronyTerm {
                weight: 0.15,
                time_s: 2.0,
            },
        ],
    };
    let c20: fn(&mut Material, f64) -> f64 = |material, by| {
        if let Isochoric::Yeoh { c20_kpa, .. } = &mut material.isochoric {
            *c20_kpa += by;
        }
        0.0
    };
    let weight: fn(&mut Material, f64) -> f64 = |material, by| {
        material.prony[0].weight += by;
        0.0
    };
    let time: fn(&mut Material, f64) -> f64 = |material, by| {
        material.prony[1].time_s += by;
        0.0
    };
    compare(
        &material,
        &[
            ("C20", 0.005, c20),
            ("weight", 1e-4, weight),
            ("time", 0.01, time),
            ("depth", 0.0005, shift),
        ],
    );
}

#[test]
fn a_stiffer_gel_of_the_same_kind_moves_alike() {
    let material = Material::neo_hookean(60.0, 0.48);
    // All constants in proportion: forces rise in proportion, and nothing moves.
    let alike = Direction {
        material: material.clone(),
        indenter_mm: DVec3::ZERO,
    };
    for row in press(&material, 0.0, &[alike]) {
        for (value, rate) in row[0].iter().zip(&row[1]) {
            assert!((rate - value).abs() < 1e-5 * value.abs());
        }
    }
}

#[test]
fn a_direction_of_another_law_is_refused() {
    let body = body(&Material::neo_hookean(60.0, 0.4));
    let mut other = Direction::zero(body.material());
    other.material.prony.push(PronyTerm {
        weight: 0.1,
        time_s: 1.0,
    });
    assert_eq!(
        body.rest_with_sensitivities(&[other]).err(),
        Some(SoftBodyError::Direction)
    );
}
