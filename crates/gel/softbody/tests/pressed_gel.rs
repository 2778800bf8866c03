//! A block of gel under a ball: reference forces and pressures, balance, robustness, repeatability.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests

mod common;

use common::{Ball, block, by_place, disc_mean, even, graded, mirrored, press, walled};
use glam::{DQuat, DVec3};
use twintac_material::Yeoh;
use twintac_shape::Pose;
use twintac_softbody::{Element, Frame, Material, Model, PronyTerm, SoftBody, SolveError, SolverSettings};

const BALL: Ball = Ball { radius_mm: 12.5 };

/// Worst relative errors in force and pressure, compared with the converged results of two other
/// programs (20-node hexahedra, and quadratic tetrahedra with a pressure field): 34 × 18 × 8.5 mm,
/// E = 70 kPa, ν = 0.49, pressure at the bottom over a disc of 1 mm.
fn errors(element: Element, cells: [usize; 3]) -> [f64; 2] {
    let (x, y, z) = (
        even(-17.0, 17.0, cells[0]),
        even(-9.0, 9.0, cells[1]),
        even(0.0, 8.5, cells[2]),
    );
    // The bottom nodes of the body, at half the spacing.
    let (fine_x, fine_y) = (even(-17.0, 17.0, 2 * cells[0]), even(-9.0, 9.0, 2 * cells[1]));
    let body = SoftBody::new(
        &block(&x, &y, &z),
        Material::neo_hookean(70.0, 0.49),
        SolverSettings {
            element,
            ..SolverSettings::default()
        },
    )
    .unwrap();
    let mut state = body.rest();
    let mut worst = [0.0_f64; 2];
    for (depth_mm, force_n, pressure_kpa) in [
        (0.5, 0.2155, 0.642),
        (1.0, 0.7100, 2.109),
        (2.0, 2.4585, 7.00),
        (4.0, 8.881, 21.96),
    ] {
        let frame = press(&body, &mut state, &BALL, 8.5, depth_mm).unwrap();
        let bottom_kpa = by_place(&body, &body.pressure_kpa(&state), &fine_x, &fine_y);
        let pressure = disc_mean(&fine_x, &fine_y, &bottom_kpa, [4.0, 4.0], 1.0);
        let found = [
            -frame.indenter_force_n.z / force_n - 1.0,
            pressure / pressure_kpa - 1.0,
        ];
        println!(
            "{element:?}, {depth_mm} mm: force {:+.2} %, pressure {:+.2} %",
            100.0 * found[0],
            100.0 * found[1]
        );
        worst = [worst[0].max(found[0].abs()), worst[1].max(found[1].abs())];
    }
    worst
}

/// Pressure at the bottom below a ball, kPa, over a disc of 1 mm: after a press, and after a hold.
fn held_pressure_kpa(material: &Material, element: Element, cells: [usize; 3]) -> [f64; 2] {
    let sides = [[-8.0, 8.0], [-7.0, 7.0], [0.0, 6.0]];
    let lines = |axis: usize, n: usize| even(sides[axis][0], sides[axis][1], n);
    let mesh = block(&lines(0, cells[0]), &lines(1, cells[1]), &lines(2, cells[2]));
    let settings = SolverSettings {
        element,
        ..SolverSettings::default()
    };
    let body = SoftBody::new(&mesh, material.clone(), settings).unwrap();
    let (fine_x, fine_y) = (lines(0, 2 * cells[0]), lines(1, 2 * cells[1]));
    let mut state = body.rest();
    [0.0, 1.0].map(|hold_s| {
        let pose = Pose::from_position(DVec3::new(0.0, 0.0, 6.0 - 1.5));
        body.advance(&mut state, &BALL, &pose, hold_s).unwrap();
        let bottom_kpa = by_place(&body, &body.pressure_kpa(&state), &fine_x, &fine_y);
        disc_mean(&fine_x, &fine_y, &bottom_kpa, [1.0, 1.0], 1.0)
    })
}

#[test]
fn pressure_at_the_bottom_is_that_of_a_finer_mesh_for_every_law() {
    let prony = |model: &Model| match model {
        Model::LogarithmicNeoHookean(_) | Model::StableNeoHookean(_) => Vec::new(),
        _ => vec![PronyTerm {
            weight: 0.3,
            time_s: 0.5,
        }],
    };
    for model in Model::examples() {
        let material = Material {
            prony: prony(&model),
            model,
            bulk_modulus_kpa: 800.0,
        };
        let found = held_pressure_kpa(&material, Element::Layered, [8, 7, 3]);
        // Its pressures are the element's own, which are too large on a coarse mesh.
        let finer = held_pressure_kpa(&material, Element::Composite, [16, 14, 7]);
        for (found, finer) in found.iter().zip(finer) {
            println!("{:?}: {found:.3} kPa for {finer:.3} kPa", material.model);
            assert!(
                (found / finer - 1.0).abs() < 0.04,
                "{:?}: {found} for {finer}",
                material.model
            );
        }
    }
}

#[test]
fn force_and_pressure_agree_with_the_reference() {
    // 7,315 nodes. Cells are 2 mm long everywhere.
    let [force, pressure] = errors(Element::Layered, [17, 9, 5]);
    assert!(force < 0.025, "{force}");
    assert!(pressure < 0.03, "{pressure}");
    let [_, of_composite] = errors(Element::Composite, [17, 9, 5]);
    assert!(of_composite > 2.0 * pressure, "{of_composite}");
}

fn coarse(material: Material) -> SoftBody {
    let mesh = block(&even(-17.0, 17.0, 8), &even(-9.0, 9.0, 4), &even(0.0, 8.5, 2));
    SoftBody::new(&mesh, material, SolverSettings::default()).unwrap()
}

#[track_caller]
fn assert_balanced(frame: &Frame) {
    let sum = frame.indenter_force_n + frame.board_reaction_n + frame.obstacle_reaction_n;
    let load = frame.indenter_force_n.length();
    assert!(sum.length() < 1e-6 * load, "{} of {load}", sum.length());
}

#[test]
fn forces_balance_against_board_and_walls() {
    let mesh = block(&even(-8.0, 8.0, 6), &even(-6.0, 6.0, 4), &even(0.0, 6.0, 2));
    let settings = SolverSettings {
        tolerance: 1e-8,
        ..SolverSettings::default()
    };
    let body = SoftBody::new(&mesh, Material::neo_hookean(70.0, 0.49), settings).unwrap();
    let body = walled(body, [8.2, 6.2]);
    let mut state = body.rest();
    let ball = Ball { radius_mm: 5.0 };
    let rotation = DQuat::from_rotation_y(0.1);
    let mut pushed_n = 0.0;
    for depth_mm in [0.5, 1.0, 1.5, 2.0, 2.5] {
        // Off the centre, so that the forces of the walls do not cancel, but nowhere in a wall,
        // which has no upper end.
        let pose = Pose {
            position_mm: DVec3::new(2.5, 0.5, 6.0 - depth_mm),
            rotation,
        };
        let frame = body.advance(&mut state, &ball, &pose, 0.0).unwrap();
        assert_balanced(&frame);
        assert!(frame.penetration_mm <= 0.005, "{}", frame.penetration_mm);
        assert!(frame.smallest_volume_ratio > 0.0);
        // A ball is the same for every rotation about its centre, so there is no torque about its
        // centre.
        let lever = rotation * DVec3::Z * ball.radius_mm;
        let about_center = frame.indenter_torque_n_mm - lever.cross(frame.indenter_force_n);
        assert!(
            about_center.length() < 1e-7 * ball.radius_mm * frame.indenter_force_n.length(),
            "{about_center}"
        );
        pushed_n = frame.obstacle_reaction_n.length();
    }
    assert!(pushed_n > 0.005, "the gel hardly reached a wall: {pushed_n} N");
}

#[test]
fn a_small_ball_goes_deep() {
    // Deeper than its radius: 45 % of the gel's height.
    let half = graded(1.0, 2.0, 1.5, 8.0);
    let heights: Vec<f64> = graded(1.0, 2.0, 1.3, 5.0)
        .iter()
        .rev()
        .map(|down| 5.0 - down)
        .collect();
    let mesh = block(&mirrored(&half), &mirrored(&half), &heights);
    let body = SoftBody::new(
        &mesh,
        Material::neo_hookean(70.0, 0.49),
        SolverSettings::default(),
    )
    .unwrap();
    let ball = Ball { radius_mm: 2.0 };
    let mut state = body.rest();
    let mut last_n = 0.0;
    for step in 1..=5 {
        let frame = press(&body, &mut state, &ball, 5.0, 0.45 * f64::from(step)).unwrap();
        assert!(frame.smallest_volume_ratio > 0.0);
        assert!(-frame.indenter_force_n.z > last_n);
        last_n = -frame.indenter_force_n.z;
    }
    // A single motion from rest must give the same result.
    let frame = press(&body, &mut body.rest(), &ball, 5.0, 2.25).unwrap();
    let ratio = -frame.indenter_force_n.z / last_n;
    assert!((ratio - 1.0).abs() < 0.005, "{ratio}");
}

#[test]
fn what_is_pressed_comes_back() {
    let body = coarse(Material::neo_hookean(70.0, 0.49));
    let mut state = body.rest();
    for depth_mm in [1.0, 2.0, 1.0, 0.0, -0.5] {
        press(&body, &mut state, &BALL, 8.5, depth_mm).unwrap();
    }
    let largest = state
        .displacements_mm()
        .iter()
        .map(|u| u.length())
        .fold(0.0, f64::max);
    assert!(largest < 1e-6, "{largest}");
}

#[test]
fn two_runs_agree_bit_for_bit() {
    let prony = vec![PronyTerm {
        weight: 0.2,
        time_s: 0.5,
    }];
    let yeoh = Yeoh {
        c10_kpa: 8.0,
        c20_kpa: 0.1,
        c30_kpa: 0.0,
    };
    let body = coarse(Material {
        model: yeoh.into(),
        bulk_modulus_kpa: 1500.0,
        prony,
    });
    let run = || {
        let mut state = body.rest();
        [0.5, 1.0, 2.0, 2.0, 1.0]
            .map(|depth| {
                let pose = Pose::from_position(DVec3::Z * (8.5 - depth));
                let frame = body.advance(&mut state, &BALL, &pose, 0.1).unwrap();
                let bits = frame.indenter_force_n.to_array().map(f64::to_bits);
                (
                    bits,
                    body.pressure_kpa(&state)
                        .iter()
                        .map(|p| p.to_bits())
                        .collect::<Vec<_>>(),
                )
            })
            .to_vec()
    };
    let first = run();
    assert_eq!(first, run());
    std::thread::scope(|scope| {
        let threads = [scope.spawn(run), scope.spawn(run)];
        threads
            .into_iter()
            .for_each(|thread| assert_eq!(first, thread.join().unwrap()));
    });
}

#[test]
fn an_impossible_press_is_an_error_and_changes_nothing() {
    let body = coarse(Material::neo_hookean(70.0, 0.49));
    let mut state = body.rest();
    press(&body, &mut state, &BALL, 8.5, 1.0).unwrap();
    let before = state.displacements_mm().to_vec();
    // The ball would have to pass through the board.
    let error = press(&body, &mut state, &BALL, 8.5, 9.5).unwrap_err();
    println!("{error}");
    assert!(matches!(error, SolveError::Blocked { .. }), "{error}");
    assert_eq!(before, state.displacements_mm());
    press(&body, &mut state, &BALL, 8.5, 1.2).unwrap();

    let error = press(&body, &mut state, &BALL, 8.5, f64::NAN).unwrap_err();
    assert!(matches!(error, SolveError::Input { .. }), "{error}");
    let error = body
        .advance(&mut state, &BALL, &Pose::from_position(DVec3::Z * 7.0), -1.0)
        .unwrap_err();
    assert!(matches!(error, SolveError::Input { .. }), "{error}");
}

#[test]
fn a_turn_of_the_way_is_foreseen() {
    let mesh = block(&even(-10.0, 10.0, 10), &even(-8.0, 8.0, 8), &even(0.0, 8.0, 4));
    let settings = SolverSettings {
        tolerance: 1e-3,
        ..SolverSettings::default()
    };
    let body = SoftBody::new(&mesh, Material::neo_hookean(70.0, 0.49), settings).unwrap();
    let mut state = body.rest();
    for frame in 1..=20 {
        press(&body, &mut state, &BALL, 8.0, 0.1 * f64::from(frame)).unwrap();
    }
    // From straight down to straight aside, and from there to straight up.
    let mut pose = Pose::from_position(DVec3::new(0.0, 0.0, 6.0));
    for step_mm in [DVec3::X, DVec3::Z].map(|way| 0.1 * way) {
        for _ in 0..3 {
            pose.position_mm += step_mm;
            let frame = body.advance(&mut state, &BALL, &pose, 0.0).unwrap();
            assert!(frame.iterations <= 4, "{}", frame.iterations);
        }
    }
}
