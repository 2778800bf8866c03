//! Presses with a given force.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests

mod common;

use common::{Ball, block, even, press};
use glam::DVec3;
use twintac_shape::Pose;
use twintac_softbody::{Material, PronyTerm, Push, SoftBody, SolveError, SolverSettings, State};

const TOP_MM: f64 = 6.0;
const BALL: Ball = Ball { radius_mm: 6.0 };

fn gel(prony: Vec<PronyTerm>) -> SoftBody {
    let mesh = block(&even(-8.0, 8.0, 6), &even(-8.0, 8.0, 6), &even(0.0, TOP_MM, 3));
    let material = Material {
        prony,
        ..Material::neo_hookean(70.0, 0.49)
    };
    SoftBody::new(&mesh, material, exact()).unwrap()
}

/// The penetration that remains depends on the path to a depth; here it must not matter.
fn exact() -> SolverSettings {
    SolverSettings {
        penetration_mm: 5e-5,
        ..SolverSettings::default()
    }
}

fn down(force_n: f64) -> Push {
    Push {
        direction: DVec3::NEG_Z,
        force_n,
        travel_mm: 5.0,
    }
}

/// Presses with a force; returns the force and the depth that were found.
fn push(body: &SoftBody, state: &mut State, push: &Push, time_s: f64) -> Result<(f64, f64), SolveError> {
    let touch = Pose::from_position(DVec3::Z * TOP_MM);
    let frame = body.advance_to_force(state, &BALL, &touch, push, time_s)?;
    let depth_mm = TOP_MM - state.gel_from_indenter().unwrap().position_mm.z;
    println!(
        "{} N: {:.6} N at {depth_mm:.6} mm, {} iterations",
        push.force_n, -frame.indenter_force_n.z, frame.iterations
    );
    Ok((-frame.indenter_force_n.z, depth_mm))
}

#[test]
fn force_and_depth_belong_together() {
    let body = gel(Vec::new());
    let mut state = body.rest();
    for wanted_n in [0.1, 0.5, 2.0, 2.0, 0.3] {
        let (force_n, depth_mm) = push(&body, &mut state, &down(wanted_n), 0.0).unwrap();
        assert!((force_n / wanted_n - 1.0).abs() < 1e-5);
        let driven = press(&body, &mut body.rest(), &BALL, TOP_MM, depth_mm).unwrap();
        let error = -driven.indenter_force_n.z / wanted_n - 1.0;
        assert!(error.abs() < 1e-4, "{error}");
    }
    // From the air in one call, and from a press that is too deep.
    let (_, expected_mm) = push(&body, &mut body.rest(), &down(1.0), 0.0).unwrap();
    let mut state = body.rest();
    press(&body, &mut state, &BALL, TOP_MM, 2.5).unwrap();
    let (_, depth_mm) = push(&body, &mut state, &down(1.0), 0.0).unwrap();
    assert!((depth_mm / expected_mm - 1.0).abs() < 1e-4);
}

#[test]
fn a_viscoelastic_gel_creeps_under_a_held_force() {
    let weight = 0.4;
    let body = gel(vec![PronyTerm { weight, time_s: 1.0 }]);
    let mut state = body.rest();
    let mut depths_mm = Vec::new();
    for time_s in [0.0, 0.25, 0.25, 0.5, 1.0, 2.0, 10.0, 100.0] {
        let (force_n, depth_mm) = push(&body, &mut state, &down(1.0), time_s).unwrap();
        assert!((force_n - 1.0).abs() < 1e-5);
        depths_mm.push(depth_mm);
    }
    assert!(depths_mm.windows(2).all(|pair| pair[1] > pair[0]));
    // In the end the gel is as deep as one whose shear modulus is smaller by the relaxing fraction.
    let relaxed = Material {
        bulk_modulus_kpa: body.material().bulk_modulus_kpa,
        ..Material::neo_hookean(70.0 * (1.0 - weight), 0.49)
    };
    let mesh = block(&even(-8.0, 8.0, 6), &even(-8.0, 8.0, 6), &even(0.0, TOP_MM, 3));
    let soft = SoftBody::new(&mesh, relaxed, exact()).unwrap();
    let (_, limit_mm) = push(&soft, &mut soft.rest(), &down(1.0), 0.0).unwrap();
    let error = depths_mm[depths_mm.len() - 1] / limit_mm - 1.0;
    assert!(error.abs() < 1e-3, "{error}");
}

#[test]
fn a_force_out_of_reach_is_an_error_and_changes_nothing() {
    let body = gel(Vec::new());
    let mut state = body.rest();
    push(&body, &mut state, &down(0.5), 0.0).unwrap();
    let before = state.displacements_mm().to_vec();
    let near = Push {
        travel_mm: 1.5,
        ..down(50.0)
    };
    let error = push(&body, &mut state, &near, 0.0).unwrap_err();
    println!("{error}");
    assert!(matches!(error, SolveError::ForceNotReached { reached_n, .. } if reached_n > 0.5));
    assert_eq!(before, state.displacements_mm());
    // Beside the gel there is nothing to press on.
    let aside = Pose::from_position(DVec3::new(30.0, 0.0, TOP_MM));
    let error = body
        .advance_to_force(&mut state, &BALL, &aside, &down(1.0), 0.0)
        .unwrap_err();
    println!("{error}");
    assert!(matches!(
        error,
        SolveError::ForceNotReached { .. } | SolveError::Blocked { .. }
    ));
    for wrong in [
        Push {
            direction: DVec3::Z * 2.0,
            ..down(1.0)
        },
        down(-1.0),
        Push {
            travel_mm: f64::NAN,
            ..down(1.0)
        },
    ] {
        let error = push(&body, &mut state, &wrong, 0.0).unwrap_err();
        assert!(matches!(error, SolveError::Input { .. }), "{error}");
    }
    assert_eq!(before, state.displacements_mm());
}
