//! Steps that end at their deadline. A deadline of zero is reproducible: each part of a step has
//! one iteration.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests

mod common;

use std::time::Duration;

use common::{Ball, block, even, press};
use glam::DVec3;
use twintac_shape::Pose;
use twintac_softbody::{Material, Push, SoftBody, SolverSettings};

const TOP_MM: f64 = 6.0;
const NO_TIME: Option<Duration> = Some(Duration::ZERO);

fn gel() -> SoftBody {
    let mesh = block(&even(-8.0, 8.0, 8), &even(-8.0, 8.0, 8), &even(0.0, TOP_MM, 4));
    SoftBody::new(
        &mesh,
        Material::neo_hookean(70.0, 0.45),
        SolverSettings::default(),
    )
    .unwrap()
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
        assert_eq!(
            frame.converged,
            frame.residual <= SolverSettings::default().tolerance
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
