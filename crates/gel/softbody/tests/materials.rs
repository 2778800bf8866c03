//! A property of materials beyond their stress: whether they can pass through inverted tetrahedra.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests

mod common;

use common::{block, bond, even};
use glam::DVec3;
use twintac_material::{NeoHookean, StableNeoHookean};
use twintac_softbody::{Frame, Material, Model, SoftBody, SolveError, SolverSettings};

/// Squeezes a block that is bonded at its bottom and its top, so that it has to bulge, in equal
/// steps. Returns the force on its top, N, and the last step.
fn squeeze(
    model: Model,
    bulk_modulus_kpa: f64,
    cells: [usize; 3],
    (by_mm, n_steps): (f64, u32),
) -> Result<(f64, Frame), SolveError> {
    let [x, y] = [0, 1].map(|axis| even(0.0, 8.0, cells[axis]));
    let mut mesh = block(&x, &y, &even(0.0, 4.0, cells[2]));
    bond(&mut mesh, |at| at.z == 0.0 || at.z == 4.0);
    // Steps are done as a whole or not at all.
    let settings = SolverSettings {
        min_substep: 1.0,
        ..SolverSettings::default()
    };
    let material = Material {
        model,
        bulk_modulus_kpa,
        prony: Vec::new(),
    };
    let body = SoftBody::new(&mesh, material, settings).unwrap();
    let bonded = &body.mesh().sets.bonded;
    let is_top = |node: u32| body.mesh().nodes_mm[node as usize].z > 2.0;
    let mut state = body.rest();
    let mut last = None;
    for step in 1..=n_steps {
        let down = DVec3::NEG_Z * by_mm * f64::from(step) / f64::from(n_steps);
        let moved: Vec<DVec3> = bonded
            .iter()
            .map(|&node| if is_top(node) { down } else { DVec3::ZERO })
            .collect();
        last = Some(body.advance_prescribed(&mut state, &moved, 0.0)?);
    }
    let forces = bonded.iter().zip(body.bonded_forces_n(&state));
    let force: DVec3 = forces
        .filter(|(node, _)| is_top(**node))
        .map(|(_, force)| force)
        .sum();
    Ok((-force.z, last.unwrap()))
}

#[test]
fn the_stable_energy_finds_its_way_through_inverted_tetrahedra() {
    let squeeze = |model: Model, n_steps| squeeze(model, 1200.0, [4, 4, 2], (1.5, n_steps));
    let shear_modulus_kpa = 23.5;
    // In one step, the top moves past the next nodes below.
    let plain = squeeze(NeoHookean { shear_modulus_kpa }.into(), 1);
    assert!(matches!(plain, Err(SolveError::Inverted { .. })), "{plain:?}");
    let stable: Model = StableNeoHookean { shear_modulus_kpa }.into();
    let ((at_once, frame), (slowly, _)) = (squeeze(stable.clone(), 1).unwrap(), squeeze(stable, 15).unwrap());
    assert!(frame.smallest_volume_ratio > 0.0);
    assert!((at_once / slowly - 1.0).abs() < 1e-5, "{at_once} {slowly}");
}
