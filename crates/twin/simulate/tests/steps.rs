//! A press has the same result in few steps as in many.

#![allow(clippy::unwrap_used)] // helpers of tests

use std::sync::Arc;

use glam::DVec3;
use twintac_protocol::PressPath;
use twintac_sensor::Sensor;
use twintac_shape::Pose;
use twintac_simulate::{Gel, SimulateSettings};

const DEPTH_MM: f64 = 1.2;

/// The force of a shape that is pressed in so many steps, at once and after a hold of three frames,
/// N.
fn forces_n(gel: &Gel, indenter: &str, n_steps: u32) -> [f64; 2] {
    let pose = |depth_mm: f64| Pose::from_position(DVec3::new(-1.0, 0.5, gel.height_mm() - depth_mm));
    let path = PressPath::through(indenter, [(0.0, pose(0.0)), (1.0, pose(DEPTH_MM))]);
    let mut state = gel.state_along(gel.shape(indenter).unwrap(), &path).unwrap();
    let mut step = |depth_mm: f64| state.step(0.02, &pose(depth_mm)).unwrap().force_n.length();
    let pressed_n = (0..=n_steps)
        .map(|done| step(DEPTH_MM * f64::from(done) / f64::from(n_steps)))
        .last()
        .unwrap();
    let held_n = (0..3).map(|_| step(DEPTH_MM)).last().unwrap();
    [pressed_n, held_n]
}

#[test]
fn a_rim_presses_as_hard_in_one_step_as_in_many_and_goes_on_to_while_it_is_held() {
    let sensor = Sensor::read("../../../sensors/phystac.toml").unwrap();
    let settings = SimulateSettings {
        max_path_nodes: 2000,
        ..SimulateSettings::default()
    };
    let gel = Gel::new(Arc::new(sensor), settings);
    for indenter in ["wedge", "cube", "cylinder", "sphere-25"] {
        let in_steps = [24, 3, 1].map(|n_steps| (n_steps, forces_n(&gel, indenter, n_steps)));
        let expected_n = in_steps[0].1[1];
        for (n_steps, found_n) in in_steps {
            for found_n in found_n {
                let off = (found_n / expected_n - 1.0).abs();
                assert!(
                    off < 0.008,
                    "{indenter} in {n_steps} steps: {found_n} N, expected {expected_n} N"
                );
            }
        }
    }
}
