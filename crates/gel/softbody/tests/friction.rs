//! Friction: sticking, slipping and twisting, no friction without a coefficient.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests

mod common;

use common::{Ball, block, even, press, walled};
use glam::{DQuat, DVec3};
use twintac_shape::{Pose, Shape, SignedDistance, Surfaces};
use twintac_softbody::{Frame, Material, PronyTerm, SoftBody, SolverSettings, State};

const TOP_MM: f64 = 4.0;
const FRICTION: f64 = 0.4;

fn gel(settings: SolverSettings) -> SoftBody {
    let mesh = block(&even(-8.0, 8.0, 8), &even(-8.0, 8.0, 8), &even(0.0, TOP_MM, 2));
    SoftBody::new(&mesh, Material::neo_hookean(70.0, 0.49), settings).unwrap()
}

fn rough() -> SolverSettings {
    SolverSettings {
        friction: FRICTION,
        ..SolverSettings::default()
    }
}

/// A plate wider than the gel: the normal is the same everywhere.
fn plate() -> Box<dyn SignedDistance> {
    Shape::Box {
        size_mm: [40.0, 40.0, 4.0],
        edge_radius_mm: 0.0,
    }
    .signed_distance_field(&Surfaces::default())
    .unwrap()
}

fn step(
    body: &SoftBody,
    state: &mut State,
    shape: &dyn SignedDistance,
    at_mm: DVec3,
    turn_rad: f64,
) -> Frame {
    let pose = Pose {
        position_mm: at_mm + DVec3::Z * TOP_MM,
        rotation: DQuat::from_rotation_z(turn_rad),
    };
    body.advance(state, shape, &pose, 0.0).unwrap()
}

/// Friction divided by its limit.
fn mobilised(frame: &Frame) -> f64 {
    frame.indenter_force_n.truncate().length() / (FRICTION * -frame.indenter_force_n.z)
}

#[test]
fn a_dragged_plate_sticks_then_slips_then_turns_back() {
    let (body, plate) = (gel(rough()), plate());
    let mut state = body.rest();
    let down_mm = -0.1;
    let frame = step(&body, &mut state, plate.as_ref(), DVec3::Z * down_mm, 0.0);
    assert!(frame.indenter_force_n.truncate().length() < 1e-3 * -frame.indenter_force_n.z);
    let mut drag = |x_mm: f64| {
        let frame = step(
            &body,
            &mut state,
            plate.as_ref(),
            DVec3::new(x_mm, 0.0, down_mm),
            0.0,
        );
        println!(
            "{x_mm} mm: {:.4} of the limit, {} iterations, residual {:.1e}",
            mobilised(&frame),
            frame.iterations,
            frame.residual
        );
        let sum = frame.indenter_force_n + frame.board_reaction_n;
        assert!(sum.length() < 1e-5 * frame.indenter_force_n.length());
        frame
    };
    let sticking = drag(0.02);
    assert!(sticking.indenter_force_n.x > 0.0, "the gel is dragged along");
    assert!(mobilised(&sticking) < 0.9);
    // While it sticks, twice the distance gives twice the force.
    let twice = drag(0.04).indenter_force_n.x / sticking.indenter_force_n.x;
    assert!((twice - 2.0).abs() < 0.2, "{twice}");
    let mut slipping = sticking;
    for x_mm in [0.5, 1.0, 1.5] {
        slipping = drag(x_mm);
        assert!(mobilised(&slipping) < 1.0 + 1e-5);
    }
    assert!(mobilised(&slipping) > 1.0 - 1e-5);
    let mut back = slipping;
    for x_mm in [1.4, 1.0, 0.5, 0.0] {
        back = drag(x_mm);
    }
    assert!(back.indenter_force_n.x < 0.0);
    assert!(
        (back.indenter_force_n.x / slipping.indenter_force_n.x + 1.0).abs() < 0.03,
        "{}",
        back.indenter_force_n
    );
}

#[test]
fn a_twisted_punch_reaches_the_torque_of_its_pressure() {
    // The torque under a sharp flat punch that twists with full slip is μ ∫ p r dA. For even
    // pressure, which a stiff thin layer of low Poisson's ratio has, this is 2/3 μ N R.
    let radius_mm = 5.0;
    let mesh = block(&even(-7.0, 7.0, 21), &even(-7.0, 7.0, 21), &even(0.0, 0.5, 1));
    let body = SoftBody::new(&mesh, Material::neo_hookean(70.0, 0.01), rough()).unwrap();
    let shape = Shape::Cylinder {
        radius_mm,
        height_mm: 6.0,
        edge_radius_mm: 0.01,
    };
    let punch = shape.signed_distance_field(&Surfaces::default()).unwrap();
    let mut state = body.rest();
    let mut turn = |turn_rad: f64| {
        let pose = Pose {
            position_mm: DVec3::Z * 0.48,
            rotation: DQuat::from_rotation_z(turn_rad),
        };
        let frame = body.advance(&mut state, punch.as_ref(), &pose, 0.0).unwrap();
        let even_n_mm = 2.0 / 3.0 * FRICTION * -frame.indenter_force_n.z * radius_mm;
        frame.indenter_torque_n_mm.z / even_n_mm
    };
    turn(0.0);
    let ratios = [0.0005, 0.05, 0.1, 0.0, -0.05].map(turn);
    println!("torque over 2/3 μ N R: {ratios:.4?}");
    assert!(ratios[0] > 0.0 && ratios[0] < 0.5);
    assert!((ratios[2] - 1.0).abs() < 0.05, "{}", ratios[2]);
    assert!((ratios[4] + 1.0).abs() < 0.05, "{}", ratios[4]);
}

#[test]
fn a_closed_loop_gives_no_energy() {
    let body = gel(SolverSettings {
        tolerance: 1e-8,
        penetration_mm: 5e-5,
        ..rough()
    });
    for (depth_mm, aside_mm) in [(0.5, 0.01), (0.5, 0.3), (1.0, 0.6)] {
        let mut state = body.rest();
        let ball = Ball { radius_mm: 5.0 };
        // Down, sideways, up and back in small steps, with the work by the trapezoidal rule.
        let corners = [
            [0.0, 0.0],
            [0.0, 1.0],
            [1.0, 1.0],
            [1.0, 0.4],
            [0.0, 0.4],
            [0.0, 0.0],
        ];
        let (mut work_n_mm, mut spent_n_mm) = (0.0, 0.0_f64);
        let (mut at_mm, mut force_n) = (DVec3::ZERO, DVec3::ZERO);
        for corner in corners.windows(2) {
            for part in 1..=16 {
                let part = f64::from(part) / 16.0;
                let [across, down] =
                    [0, 1].map(|axis| corner[0][axis] * (1.0 - part) + corner[1][axis] * part);
                let next_mm = DVec3::new(across * aside_mm, 0.0, -down * depth_mm);
                let frame = step(&body, &mut state, &ball, next_mm, 0.0);
                work_n_mm += 0.5 * (force_n + frame.indenter_force_n).dot(next_mm - at_mm);
                spent_n_mm = spent_n_mm.max(work_n_mm);
                (at_mm, force_n) = (next_mm, frame.indenter_force_n);
            }
        }
        println!("{depth_mm} mm down, {aside_mm} mm aside: {work_n_mm:.5} of {spent_n_mm:.5} N mm lost");
        assert!(work_n_mm > -1e-3 * spent_n_mm);
        if aside_mm > 0.1 {
            assert!(work_n_mm > 0.01 * spent_n_mm, "slipping costs");
        }
    }
}

#[test]
fn left_and_right_are_the_same() {
    // The penetration that remains depends on the order of nodes; here it must not matter.
    let body = gel(SolverSettings {
        tolerance: 1e-8,
        penetration_mm: 5e-5,
        ..rough()
    });
    let ball = Ball { radius_mm: 5.0 };
    let drag = |sign: f64| {
        let mut state = body.rest();
        let mut frame = step(&body, &mut state, &ball, DVec3::Z * -0.5, 0.0);
        for x_mm in [0.1, 0.3] {
            frame = step(
                &body,
                &mut state,
                &ball,
                DVec3::new(sign * x_mm, -sign * x_mm, -0.5),
                0.0,
            );
        }
        frame.indenter_force_n
    };
    // The block's tetrahedra are the same when x and y are swapped.
    let (right, left) = (drag(1.0), drag(-1.0));
    println!("{right} {left}");
    assert!((right - DVec3::new(left.y, left.x, left.z)).length() < 1e-3 * right.length());
}

#[test]
fn a_held_press_holds_still() {
    let (body, ball) = (gel(rough()), Ball { radius_mm: 5.0 });
    let mut state = body.rest();
    for step_mm in 1..=4 {
        step(
            &body,
            &mut state,
            &ball,
            DVec3::new(0.0, 0.0, -0.2 * f64::from(step_mm)),
            0.0,
        );
    }
    let at_mm = DVec3::new(0.1, 0.0, -0.8);
    step(&body, &mut state, &ball, at_mm, 0.0);
    // The first step without motion removes the penetration that remains.
    let first = step(&body, &mut state, &ball, at_mm, 0.0);
    let mut last = first;
    for _ in 0..50 {
        last = step(&body, &mut state, &ball, at_mm, 0.0);
    }
    let drift = (last.indenter_force_n - first.indenter_force_n).length() / first.indenter_force_n.length();
    println!(
        "drift {drift:.1e}, {} iterations in the last step",
        last.iterations
    );
    assert!(drift < 1e-5);
}

#[test]
fn stiffer_springs_change_little() {
    let drag = |contact_stiffness: f64| {
        let body = gel(SolverSettings {
            contact_stiffness,
            ..rough()
        });
        let mut state = body.rest();
        let ball = Ball { radius_mm: 5.0 };
        step(&body, &mut state, &ball, DVec3::Z * -0.4, 0.0);
        step(&body, &mut state, &ball, DVec3::Z * -0.8, 0.0);
        let partly = step(&body, &mut state, &ball, DVec3::new(0.1, 0.0, -0.8), 0.0);
        step(&body, &mut state, &ball, DVec3::new(0.6, 0.0, -0.8), 0.0);
        let slipping = step(&body, &mut state, &ball, DVec3::new(1.2, 0.0, -0.8), 0.0);
        [partly.indenter_force_n.x, slipping.indenter_force_n.x]
    };
    let (usual, stiff) = (drag(100.0), drag(400.0));
    let changes: Vec<f64> = usual.iter().zip(&stiff).map(|(a, b)| a / b - 1.0).collect();
    println!(
        "sticking {:+.2} %, slipping {:+.2} %",
        100.0 * changes[0],
        100.0 * changes[1]
    );
    assert!(changes[0].abs() < 0.05 && changes[1].abs() < 0.01);
}

#[test]
fn rough_walls_carry_a_part_of_the_load() {
    let mesh = block(&even(-6.0, 6.0, 6), &even(-6.0, 6.0, 6), &even(0.0, 6.0, 3));
    let carried = |obstacle_friction: f64| {
        let settings = SolverSettings {
            obstacle_friction,
            tolerance: 1e-8,
            ..SolverSettings::default()
        };
        let material = Material {
            prony: vec![PronyTerm {
                weight: 0.2,
                time_s: 1.0,
            }],
            ..Material::neo_hookean(70.0, 0.49)
        };
        let body = walled(SoftBody::new(&mesh, material, settings).unwrap(), [6.05, 6.05]);
        let mut state = body.rest();
        let mut frame = press(&body, &mut state, &Ball { radius_mm: 6.0 }, 6.0, 0.5).unwrap();
        for depth_mm in [1.0, 1.5, 2.0] {
            frame = press(&body, &mut state, &Ball { radius_mm: 6.0 }, 6.0, depth_mm).unwrap();
            let sum = frame.indenter_force_n + frame.board_reaction_n + frame.obstacle_reaction_n;
            assert!(sum.length() < 1e-6 * frame.indenter_force_n.length(), "{sum}");
        }
        println!(
            "walls {}, of {}",
            frame.obstacle_reaction_n, frame.indenter_force_n
        );
        frame.obstacle_reaction_n.z / -frame.indenter_force_n.z
    };
    assert!(carried(0.0).abs() < 1e-6);
    // The gel bulges up along the walls, which hold it down.
    let share = carried(FRICTION);
    assert!(share < -0.001, "{share}");
}
