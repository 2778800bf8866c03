//! Steps that end at their deadline. A deadline of zero is reproducible: each part of a step has
//! one iteration.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests

mod common;

use std::time::Duration;

use common::{Ball, block, even, press};
use glam::{DQuat, DVec3};
use twintac_shape::{Distance, Pose, SignedDistance};
use twintac_softbody::{Material, PronyTerm, Push, SoftBody, SolverSettings};

const TOP_MM: f64 = 6.0;
/// Two balls side by side, as two parts.
struct Pair([(DVec3, Ball); 2]);

impl SignedDistance for Pair {
    fn signed_distance(&self, point_mm: DVec3) -> Distance {
        let [first, second] = &self.0;
        let [first, second] = [first, second].map(|(at_mm, ball)| ball.signed_distance(point_mm - *at_mm));
        if first.distance_mm < second.distance_mm {
            first
        } else {
            second
        }
    }

    fn bounds_mm(&self) -> (DVec3, DVec3) {
        (DVec3::new(-6.5, -3.0, 0.0), DVec3::new(6.5, 3.0, 6.0))
    }

    fn parts(&self) -> Vec<(Pose, &dyn SignedDistance)> {
        let balls = self.0.iter();
        balls
            .map(|(at_mm, ball)| (Pose::from_position(*at_mm), ball as &dyn SignedDistance))
            .collect()
    }
}

const NO_TIME: Option<Duration> = Some(Duration::ZERO);

fn gel() -> SoftBody {
    gel_of(Material::neo_hookean(70.0, 0.45))
}

fn gel_of(material: Material) -> SoftBody {
    gel_with(material, SolverSettings::default())
}

fn gel_with(material: Material, settings: SolverSettings) -> SoftBody {
    let mesh = block(&even(-8.0, 8.0, 8), &even(-8.0, 8.0, 8), &even(0.0, TOP_MM, 4));
    SoftBody::new(&mesh, material, settings).unwrap()
}

#[test]
fn a_step_without_time_says_that_it_has_not_settled_and_settles_while_the_indenter_waits() {
    let (gel, ball) = (gel(), Ball { radius_mm: 5.0 });
    let mut settled = gel.rest();
    let mut late = gel.rest();
    late.answer_within(NO_TIME);
    let mut has_been_late = false;
    for step in 1..=8 {
        let depth_mm = 0.2 * f64::from(step);
        press(&gel, &mut settled, &ball, TOP_MM, depth_mm).unwrap();
        let frame = press(&gel, &mut late, &ball, TOP_MM, depth_mm).unwrap();
        println!("{depth_mm:.1} mm: {} {:.1e}", frame.converged, frame.residual);
        let is_there = frame.behind_mm == 0.0;
        assert_eq!(
            frame.converged,
            is_there && frame.residual <= SolverSettings::default().tolerance
        );
        assert!(frame.smallest_volume_ratio > 0.0);
        has_been_late |= !frame.converged;
    }
    assert!(has_been_late);
    let whole = press(&gel, &mut settled, &ball, TOP_MM, 1.6).unwrap();
    let waited = (0..30)
        .map(|_| press(&gel, &mut late, &ball, TOP_MM, 1.6).unwrap())
        .find(|frame| frame.converged)
        .unwrap();
    let ratio = waited.indenter_force_n.z / whole.indenter_force_n.z;
    assert!((ratio - 1.0).abs() < 2e-3, "{ratio}");
}

/// Down, aside with a turn, and up again, in steps of about 0.1 mm.
fn slide() -> Vec<Pose> {
    let down = (1..=16).map(|step| (DVec3::new(-1.0, 0.0, -0.1 * f64::from(step)), 0.0));
    let aside = (1..=20).map(|step| {
        let part = f64::from(step) / 20.0;
        (DVec3::new(-1.0 + 2.0 * part, 0.0, -1.6), 0.2 * part)
    });
    let up = (1..=18).map(|step| (DVec3::new(1.0, 0.0, -1.6 + 0.1 * f64::from(step)), 0.2));
    let moved = down.chain(aside).chain(up);
    moved
        .map(|(at_mm, turn_rad)| Pose {
            position_mm: DVec3::Z * TOP_MM + at_mm,
            rotation: DQuat::from_rotation_y(turn_rad),
        })
        .collect()
}

#[test]
fn without_time_a_slide_falls_behind_and_is_right_where_it_is() {
    let (gel, ball) = (gel(), Ball { radius_mm: 5.0 });
    let force_n = |pose: &Pose| {
        let frame = gel.advance(&mut gel.rest(), &ball, pose, 0.0).unwrap();
        frame.indenter_force_n
    };
    let mut late = gel.rest();
    late.answer_within(NO_TIME);
    let (mut farthest_mm, mut n_nearly) = (0.0_f64, 0);
    let path = slide();
    for pose in &path {
        let frame = gel.advance(&mut late, &ball, pose, 0.0).unwrap();
        farthest_mm = farthest_mm.max(frame.behind_mm);
        let at = late.gel_from_indenter().unwrap();
        assert_eq!(frame.behind_mm == 0.0, at == *pose);
        if frame.residual < 0.01 {
            n_nearly += 1;
            let right_n = force_n(&at);
            let error_n = (frame.indenter_force_n - right_n).length();
            println!(
                "{:.3} mm behind: {right_n:.3} N, {error_n:.4} off",
                frame.behind_mm
            );
            assert!(
                error_n < 0.02 * right_n.length() + 0.005,
                "{error_n} of {right_n}"
            );
        }
    }
    assert!(farthest_mm > 0.05 && farthest_mm < 2.5, "{farthest_mm}");
    assert!(n_nearly > path.len() / 4, "{n_nearly}");
    let end = path.last().unwrap();
    let waited = (0..60)
        .map(|_| gel.advance(&mut late, &ball, end, 0.0).unwrap())
        .find(|frame| frame.converged);
    assert!(waited.unwrap().indenter_force_n.length() < 1e-3);
}

#[test]
fn another_indenter_finds_the_gel_as_it_was_before_an_unfinished_step() {
    let (gel, ball) = (gel(), Ball { radius_mm: 5.0 });
    let pair = Pair([-3.5, 3.5].map(|x_mm| (DVec3::X * x_mm, Ball { radius_mm: 3.0 })));
    let mut late = gel.rest();
    late.answer_within(NO_TIME);
    let frame = press(&gel, &mut late, &ball, TOP_MM, 1.0).unwrap();
    assert!(frame.residual > 0.01, "{frame:?}");
    late.answer_within(None);
    let found = press(&gel, &mut late, &pair, TOP_MM, 0.5).unwrap();
    let alone = press(&gel, &mut gel.rest(), &pair, TOP_MM, 0.5).unwrap();
    let error_n = (found.indenter_force_n - alone.indenter_force_n).length();
    assert!(
        found.converged && error_n < 0.02 * alone.indenter_force_n.length(),
        "{error_n}"
    );
}

fn relaxing() -> SoftBody {
    gel_of(Material {
        prony: vec![PronyTerm {
            weight: 0.5,
            time_s: 5.0,
        }],
        ..Material::neo_hookean(70.0, 0.45)
    })
}

#[test]
fn time_that_passes_behind_a_deadline_is_counted_once() {
    let (gel, ball) = (relaxing(), Ball { radius_mm: 5.0 });
    let pose = Pose::from_position(DVec3::Z * (TOP_MM - 0.2));
    let mut settled = gel.rest();
    let mut late = gel.rest();
    late.answer_within(NO_TIME);
    gel.advance(&mut settled, &ball, &pose, 0.0).unwrap();
    gel.advance(&mut settled, &ball, &pose, 2.0).unwrap();
    let frames = [0.0, 0.4, 0.4, 0.4, 0.4, 0.4].map(|time_step_s| {
        let frame = gel.advance(&mut late, &ball, &pose, time_step_s).unwrap();
        frame.converged
    });
    assert!(frames.contains(&false));
    late.answer_within(None);
    let forces = [&mut settled, &mut late].map(|state| {
        let frame = gel.advance(state, &ball, &pose, 0.0).unwrap();
        frame.indenter_force_n.z
    });
    // A time step of 0.4 s more or less would change the force by 2 %.
    assert!((forces[1] / forces[0] - 1.0).abs() < 0.01, "{forces:?}");
}

#[test]
fn a_copy_of_an_unfinished_gel_goes_on_like_it() {
    let (gel, ball) = (gel(), Ball { radius_mm: 5.0 });
    let mut late = gel.rest();
    late.answer_within(NO_TIME);
    let frame = press(&gel, &mut late, &ball, TOP_MM, 1.0).unwrap();
    assert!(frame.residual > 0.01, "{frame:?}");
    late.answer_within(None);
    let mut copy = late.clone();
    let forces_n = [&mut late, &mut copy].map(|state| {
        let frame = press(&gel, state, &ball, TOP_MM, 1.2).unwrap();
        assert!(frame.converged);
        frame.indenter_force_n.z
    });
    assert!((forces_n[0] / forces_n[1] - 1.0).abs() < 2e-3, "{forces_n:?}");
}

#[test]
fn a_press_to_a_force_and_an_impossible_step_start_from_a_finished_one() {
    let (gel, ball) = (gel(), Ball { radius_mm: 5.0 });
    let mut late = gel.rest();
    late.answer_within(NO_TIME);
    press(&gel, &mut late, &ball, TOP_MM, 1.0).unwrap();
    let mut blocked = late.clone();
    let push = Push {
        direction: DVec3::NEG_Z,
        force_n: 0.3,
        travel_mm: 3.0,
    };
    let above = Pose::from_position(DVec3::Z * TOP_MM);
    let frame = gel
        .advance_to_force(&mut late, &ball, &above, &push, 0.0)
        .unwrap();
    assert!(frame.converged && (frame.indenter_force_n.z + 0.3).abs() < 0.003);

    // Into the board; the gel then goes on from where it was.
    blocked.answer_within(None);
    press(&gel, &mut blocked, &ball, TOP_MM, TOP_MM + 1.0).unwrap_err();
    let found = press(&gel, &mut blocked, &ball, TOP_MM, 1.0).unwrap();
    let alone = press(&gel, &mut gel.rest(), &ball, TOP_MM, 1.0).unwrap();
    let ratio = found.indenter_force_n.z / alone.indenter_force_n.z;
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
}

#[test]
fn a_step_that_had_as_many_iterations_as_it_may_is_done_anew_without_a_deadline() {
    let (gel, ball) = (gel(), Ball { radius_mm: 2.0 });
    let few = SolverSettings {
        max_iterations: 3,
        tolerance: 0.005,
        penetration_mm: 0.05,
        ..SolverSettings::default()
    };
    let hasty = gel_with(Material::neo_hookean(70.0, 0.45), few);
    let mut late = hasty.rest();
    late.answer_within(NO_TIME);
    for _ in 0..3 {
        let frame = press(&hasty, &mut late, &ball, TOP_MM, 0.2).unwrap();
        assert!(frame.iterations == 1 && frame.residual > 0.01, "{frame:?}");
    }
    let redone = press(&hasty, &mut late, &ball, TOP_MM, 0.2).unwrap();
    assert!(redone.converged && redone.behind_mm == 0.0, "{redone:?}");
    let alone = press(&gel, &mut gel.rest(), &ball, TOP_MM, 0.2).unwrap();
    let ratio = redone.indenter_force_n.z / alone.indenter_force_n.z;
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
}

#[test]
fn enough_time_changes_no_bit() {
    let (gel, ball) = (gel(), Ball { radius_mm: 5.0 });
    let mut states = [None, Some(Duration::from_secs(600))].map(|deadline| {
        let mut state = gel.rest();
        state.answer_within(deadline);
        state
    });
    for depth_mm in [0.3, 0.8, 0.5] {
        for state in &mut states {
            assert!(press(&gel, state, &ball, TOP_MM, depth_mm).unwrap().converged);
        }
        assert_eq!(states[0].displacements_mm(), states[1].displacements_mm());
    }
}

#[test]
fn a_press_to_a_force_takes_the_time_that_it_needs_and_the_next_step_has_its_deadline() {
    let (gel, ball) = (gel(), Ball { radius_mm: 5.0 });
    let mut state = gel.rest();
    state.answer_within(NO_TIME);
    let push = Push {
        direction: DVec3::NEG_Z,
        force_n: 1.0,
        travel_mm: 3.0,
    };
    let above = Pose::from_position(DVec3::Z * (TOP_MM));
    let frame = gel
        .advance_to_force(&mut state, &ball, &above, &push, 0.0)
        .unwrap();
    assert!(frame.converged);
    assert!((frame.indenter_force_n.z + 1.0).abs() < 0.01, "{frame:?}");
    let deeper_mm = TOP_MM - state.gel_from_indenter().unwrap().position_mm.z + 0.4;
    assert!(
        !press(&gel, &mut state, &ball, TOP_MM, deeper_mm)
            .unwrap()
            .converged
    );
}
