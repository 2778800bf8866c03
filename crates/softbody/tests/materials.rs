//! What materials promise beyond their stress: no locking, and a way through inverted tetrahedra.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests

mod common;

use common::{block, bond, even, models};
use glam::DVec3;
use twintac_material::{NeoHookean, StableNeoHookean};
use twintac_softbody::{Frame, Material, Model, SoftBody, SolveError, SolverSettings};

/// Squeezes a block bonded at its bottom and its top, so that it has to bulge. The settings are those of the solver but for the substeps.
fn squeeze(
    model: Model,
    bulk_modulus_kpa: f64,
    cells: [usize; 3],
    by_mm: f64,
    min_substep: f64,
) -> Result<Frame, SolveError> {
    let mut mesh = block(
        &even(0.0, 8.0, cells[0]),
        &even(0.0, 8.0, cells[1]),
        &even(0.0, 4.0, cells[2]),
    );
    bond(&mut mesh, |at| at.z == 0.0 || at.z == 4.0);
    let settings = SolverSettings {
        tolerance: 1e-8,
        min_substep,
        ..SolverSettings::default()
    };
    let material = Material {
        model,
        bulk_modulus_kpa,
        prony: Vec::new(),
    };
    let body = SoftBody::new(&mesh, material, settings).unwrap();
    let mut state = body.rest();
    let nodes = body.mesh().sets.bonded.iter();
    let moved: Vec<DVec3> = nodes
        .map(|&node| {
            DVec3::NEG_Z
                * if body.mesh().nodes_mm[node as usize].z > 2.0 {
                    by_mm
                } else {
                    0.0
                }
        })
        .collect();
    let mut frame = body.advance_prescribed(&mut state, &moved, 0.0)?;
    // The force on the top alone: all bonded nodes together feel none.
    let forces = body.bonded_forces_n(&state);
    let nodes = body.mesh().sets.bonded.iter();
    frame.board_reaction_n = nodes
        .zip(forces)
        .filter(|(node, _)| body.mesh().nodes_mm[**node as usize].z > 2.0)
        .map(|(_, force)| force)
        .sum();
    Ok(frame)
}

#[test]
fn no_material_locks() {
    for model in models() {
        // ν = 0.49 and 0.4999: K = 2 μ (1 + ν)/(3 (1 - 2 ν)).
        let shear_kpa = model.shear_modulus_kpa();
        let [soft, coarse, fine] =
            [(0.49, [4, 4, 2]), (0.4999, [4, 4, 2]), (0.4999, [8, 8, 4])].map(|(ratio, cells)| {
                let bulk_kpa = 2.0 * shear_kpa * (1.0 + ratio) / (3.0 * (1.0 - 2.0 * ratio));
                -squeeze(model.clone(), bulk_kpa, cells, 0.6, 0.0625)
                    .unwrap()
                    .board_reaction_n
                    .z
            });
        println!("{}: {soft:.4} N, {coarse:.4} N, {fine:.4} N", model.name());
        assert!(coarse > soft && coarse / fine - 1.0 < 0.03, "{}", model.name());
    }
}

#[test]
fn the_stable_energy_finds_its_way_through_inverted_tetrahedra() {
    let squeeze = |model: Model, min_substep| squeeze(model, 1200.0, [4, 4, 2], 1.5, min_substep);
    let shear_modulus_kpa = 23.5;
    // In one step, the top goes past the next nodes below.
    let plain = squeeze(NeoHookean { shear_modulus_kpa }.into(), 1.0);
    assert!(matches!(plain, Err(SolveError::Inverted { .. })), "{plain:?}");
    let stable: Model = StableNeoHookean { shear_modulus_kpa }.into();
    let (at_once, slowly) = (
        squeeze(stable.clone(), 1.0).unwrap(),
        squeeze(stable, 0.0625).unwrap(),
    );
    assert!(at_once.smallest_volume_ratio > 0.0);
    assert!((at_once.board_reaction_n.z / slowly.board_reaction_n.z - 1.0).abs() < 1e-6);
}
