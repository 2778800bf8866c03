//! Derivatives of a press, compared with differences of whole presses.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests
#![allow(clippy::needless_range_loop)] // tables are read with indices

mod common;

use std::sync::Arc;

use common::{Ball, Wall, block, even};
use glam::DVec3;
use twintac_material::{MooneyRivlin, Ogden, OgdenTerm, Yeoh};
use twintac_shape::Pose;
use twintac_softbody::{Direction, Material, Model, PronyTerm, SoftBody, SoftBodyError, SolverSettings};

const BALL: Ball = Ball { radius_mm: 6.0 };
const HEIGHT_MM: f64 = 6.0;

/// Depths, mm, at times, s: loading, hold, and unloading by half.
const PRESS: [(f64, f64); 7] = [
    (0.1, 0.2),
    (0.2, 0.5),
    (0.4, 0.9),
    (0.7, 1.5),
    (1.2, 1.5),
    (3.0, 1.5),
    (3.3, 0.8),
];

/// A block between four walls, which it touches when pressed.
fn body(material: &Material) -> SoftBody {
    let mesh = block(&even(-8.0, 8.0, 6), &even(-7.0, 7.0, 5), &even(0.0, HEIGHT_MM, 2));
    let settings = SolverSettings {
        tolerance: 1e-9,
        ..SolverSettings::default()
    };
    let walls = [
        (DVec3::X, 8.0),
        (DVec3::NEG_X, 8.0),
        (DVec3::Y, 7.0),
        (DVec3::NEG_Y, 7.0),
    ];
    let body = SoftBody::new(&mesh, material.clone(), settings).unwrap();
    walls.into_iter().fold(body, |body, (inwards, half_mm)| {
        let wall = Wall {
            inwards,
            from_origin_mm: half_mm + 0.05,
        };
        body.with_obstacle(Arc::new(wall), Pose::IDENTITY)
    })
}

/// Force, N, and pressure at a node of the bottom, kPa, in every frame, followed by their
/// derivatives along each direction.
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
    let mut leans = false;
    let frames = PRESS.iter().map(|&(time_s, depth_mm)| {
        let pose = Pose::from_position(DVec3::new(0.3, 0.2, HEIGHT_MM - depth_mm - shift_mm));
        let frame = body
            .advance(&mut state, &BALL, &pose, time_s - previous_s)
            .unwrap();
        previous_s = time_s;
        leans |= frame.obstacle_reaction_n != DVec3::ZERO;
        let mut row = vec![[-frame.indenter_force_n.z, body.pressure_kpa(&state)[node]]];
        for (index, force) in state.force_sensitivities_n().iter().enumerate() {
            row.push([-force.z, body.pressure_sensitivity_kpa(&state, index)[node]]);
        }
        row
    });
    let frames = frames.collect();
    assert!(leans, "the walls are out of reach");
    frames
}

/// A parameter: its name, the step of a difference, and a function that changes a material by it
/// and returns the change of the depth, mm.
type Parameter<'a> = (&'a str, f64, &'a dyn Fn(&mut Material, f64) -> f64);

fn compare(material: &Material, parameters: &[Parameter]) {
    let moved = |change: &dyn Fn(&mut Material, f64) -> f64, by: f64| {
        let mut moved = material.clone();
        let depth_mm = change(&mut moved, by);
        (moved, depth_mm)
    };
    let directions: Vec<Direction> = parameters
        .iter()
        .map(|(_, step, change)| Direction {
            materials: [-0.1, 0.1].map(|part| moved(change, part * step).0),
            step: 0.1 * step,
            indenter_mm: DVec3::NEG_Z * moved(change, 1.0).1,
        })
        .collect();
    let found = press(material, 0.0, &directions);
    for (index, (name, step, change)) in parameters.iter().enumerate() {
        let [before, after] = [-1.0, 1.0].map(|sign| {
            let (material, depth_mm) = moved(change, sign * step);
            press(&material, depth_mm, &[])
        });
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

fn bulk(material: &mut Material, by: f64) -> f64 {
    material.bulk_modulus_kpa += by;
    0.0
}

fn shift(_: &mut Material, by: f64) -> f64 {
    by
}

#[test]
fn rates_in_the_constants_of_every_law_are_differences_of_presses() {
    for model in Model::examples() {
        let material = Material {
            model,
            bulk_modulus_kpa: 800.0,
            prony: Vec::new(),
        };
        let name = material.model.name();
        let first = |material: &mut Material, by: f64| {
            match &mut material.model {
                Model::NeoHookean(law) => law.shear_modulus_kpa += by,
                Model::LogarithmicNeoHookean(law) => law.shear_modulus_kpa += by,
                Model::StableNeoHookean(law) => law.shear_modulus_kpa += by,
                Model::MooneyRivlin(MooneyRivlin { c01_kpa, .. }) => *c01_kpa += by,
                Model::Yeoh(Yeoh { c20_kpa, .. }) => *c20_kpa += by,
                Model::Ogden(law) => law.terms[0].mu_kpa += by,
            }
            0.0
        };
        compare(&material, &[(name, 0.01, &first), ("bulk modulus", 2.0, &bulk)]);
    }
}

#[test]
fn rates_in_an_exponent_are_differences_of_presses() {
    let terms = [(9.0, 1.3), (-3.0, -2.0)].map(|(mu_kpa, alpha)| OgdenTerm { mu_kpa, alpha });
    let material = Material {
        model: Ogden {
            terms: terms.to_vec(),
        }
        .into(),
        bulk_modulus_kpa: 800.0,
        prony: Vec::new(),
    };
    let alpha = |material: &mut Material, by: f64| {
        if let Model::Ogden(law) = &mut material.model {
            law.terms[1].alpha += by;
        }
        0.0
    };
    compare(&material, &[("alpha", 1e-3, &alpha), ("depth", 0.0002, &shift)]);
}

#[test]
fn rates_of_a_relaxing_press_are_differences_of_presses() {
    let material = Material {
        model: Model::examples().remove(2),
        bulk_modulus_kpa: 500.0,
        prony: [(0.2, 0.3), (0.15, 2.0)]
            .map(|(weight, time_s)| PronyTerm { weight, time_s })
            .to_vec(),
    };
    let stiffening = |material: &mut Material, by: f64| {
        if let Model::Yeoh(law) = &mut material.model {
            law.c20_kpa += by;
        }
        0.0
    };
    let weight = |material: &mut Material, by: f64| {
        material.prony[0].weight += by;
        0.0
    };
    let time = |material: &mut Material, by: f64| {
        material.prony[1].time_s += by;
        0.0
    };
    compare(
        &material,
        &[
            ("C20", 0.005, &stiffening),
            ("weight", 1e-4, &weight),
            ("time", 0.01, &time),
            ("depth", 0.0002, &shift),
        ],
    );
}

#[test]
fn a_stiffer_gel_of_the_same_kind_moves_alike() {
    // All constants in proportion: forces rise in proportion, and displacements do not change.
    let alike = Direction {
        materials: [0.999, 1.001].map(|times| Material::neo_hookean(60.0 * times, 0.48)),
        step: 0.001,
        indenter_mm: DVec3::ZERO,
    };
    for row in press(&Material::neo_hookean(60.0, 0.48), 0.0, &[alike]) {
        for (value, rate) in row[0].iter().zip(&row[1]) {
            assert!((rate - value).abs() < 1e-5 * value.abs());
        }
    }
}

#[test]
fn directions_that_make_no_sense_are_refused() {
    let material = Material::neo_hookean(60.0, 0.4);
    let body = body(&material);
    let good = Direction {
        materials: [material.clone(), material],
        step: 1e-3,
        indenter_mm: DVec3::NEG_Z,
    };
    let refused = |change: fn(&mut Direction)| {
        let mut direction = good.clone();
        change(&mut direction);
        body.rest_with_sensitivities(&[direction]).err()
    };
    assert_eq!(refused(|_| ()), None);
    assert_eq!(
        refused(|direction| direction.step = 0.0),
        Some(SoftBodyError::Direction)
    );
    let relaxing = refused(|direction| {
        let term = PronyTerm {
            weight: 0.1,
            time_s: 1.0,
        };
        direction.materials[1].prony.push(term);
    });
    assert_eq!(relaxing, Some(SoftBodyError::Direction));
    let soft = refused(|direction| direction.materials[0].bulk_modulus_kpa = -1.0);
    assert!(matches!(soft, Some(SoftBodyError::Material(_))));
}
