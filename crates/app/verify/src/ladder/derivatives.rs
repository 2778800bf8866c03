//! Derivatives against finite differences, and rigid rotations.

use anyhow::{Context, Result};
use glam::{DMat3, DVec3};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use twintac_mesh::bricks;

use super::patch_test::{ELEMENTS, TIGHT, body_of, deform, irregular_block, linear};
use super::rubbers::rubbers;
use crate::rung::{Effort, Figure, Outcome};

/// Tolerance without load, relative to the forces of a light touch, so that it is close to
/// round-off.
const UNLOADED: f64 = 1e-9;

/// Number of steps of one full rotation.
const TURNS: u32 = 12;

pub(super) fn run(effort: Effort) -> Result<Outcome> {
    let n_tries = effort.choose(4, 25);
    let mut mesh = irregular_block([4, 3, 4]);
    let mut figures = Vec::new();
    for (element_name, element) in ELEMENTS {
        for rubber in &rubbers() {
            bricks::bond(&mut mesh, |at| at.z == 0.0);
            let body = body_of(&mesh, rubber.material(), element, TIGHT)?;
            let every: Vec<u32> = (0..body.mesh().nodes_mm.len() as u32).collect();
            let mut random = ChaCha8Rng::seed_from_u64(2);
            let (mut force, mut tangent) = (0.0_f64, 0.0_f64);
            for _ in 0..n_tries {
                let mut vectors = |size: f64| -> Vec<DVec3> {
                    let mut number = || random.random_range(-size..size);
                    every
                        .iter()
                        .map(|_| DVec3::new(number(), number(), number()))
                        .collect()
                };
                let gradient = DMat3::IDENTITY + 2.0 * outer(vectors(0.3)[0], vectors(0.3)[1]);
                let from = linear(&body, gradient, &every);
                let from: Vec<DVec3> = from.iter().zip(vectors(0.02)).map(|(a, b)| *a + b).collect();
                let errors = body
                    .derivative_errors(&from, &vectors(1e-4))
                    .context("a random displacement turned an element inside out")?;
                (force, tangent) = (force.max(errors.force), tangent.max(errors.tangent));
            }
            let name = |what| format!("{element_name}, {}: {what}", rubber.name);
            figures.push(Figure::at_most(1e-7, name("forces against energy"), force, ""));
            figures.push(Figure::at_most(1e-5, name("tangent against forces"), tangent, ""));

            bricks::bond(&mut mesh, |_| true);
            let body = body_of(&mesh, rubber.material(), element, UNLOADED)?;
            let mut state = body.rest();
            let axis = DVec3::new(1.0, 2.0, -0.5).normalize();
            for turn in 1..=TURNS {
                let angle = f64::from(turn) / f64::from(TURNS) * std::f64::consts::FRAC_PI_2;
                deform(&body, &mut state, DMat3::from_axis_angle(axis, angle))?;
            }
            let stress_kpa = body
                .pressure_kpa(&state)
                .into_iter()
                .chain(body.von_mises_kpa(&state))
                .fold(0.0, |most: f64, stress_kpa| most.max(stress_kpa.abs()));
            let over_shear = stress_kpa / rubber.law.shear_modulus_kpa();
            figures.push(Figure::at_most(
                1e-9,
                name("stress of a rotation, over the shear modulus"),
                over_shear,
                "",
            ));
        }
    }
    Ok(Outcome {
        done: format!(
            "At {n_tries} random states of an irregular mesh, far from equilibrium, and along random \
             directions, the slope of the energy is compared with the nodal forces, and the slope of the \
             forces with the tangent of the linear system, pressures included. The slopes are differences \
             of fourth order. The tangent is assembled in single precision, whose smallest relative step is \
             6e-8. Then the boundary is rotated by 90° in {TURNS} steps: pressure and von Mises stress must \
             stay zero everywhere."
        ),
        figures,
        plots: Vec::new(),
    })
}

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
