//! Homogeneous deformations.

use anyhow::Result;
use glam::{DMat3, DVec3};
use twintac_softbody::{SoftBody, State};

use super::patch_test::{ELEMENTS, TIGHT, body_of, deform, irregular_block};
use super::rubbers::{Rubber, rubbers};
use crate::rung::{Effort, Figure, Outcome, Plot, plots};

/// Deformation gradient of a block and first Piola–Kirchhoff stress, kPa, for an amount of
/// deformation.
type ClosedForm = fn(&Rubber, f64) -> (DMat3, DMat3);

/// Families of deformations, the amount at rest, and the amounts that are tested, each from rest.
const FAMILIES: [(&str, ClosedForm, f64, [f64; 6]); 4] = [
    ("uniaxial", uniaxial, 1.0, [0.6, 0.75, 0.9, 1.1, 1.3, 1.6]),
    (
        "equibiaxial",
        equibiaxial,
        1.0,
        [0.75, 0.85, 0.95, 1.1, 1.2, 1.35],
    ),
    (
        "simple shear",
        simple_shear,
        0.0,
        [-0.8, -0.4, -0.1, 0.2, 0.5, 0.8],
    ),
    (
        "confined compression",
        confined,
        1.0,
        [0.8, 0.9, 0.95, 0.99, 1.02, 1.05],
    ),
];

/// Number of steps from rest. In one step, the surface would move far into tetrahedra whose inner
/// nodes are at rest: quadratic ones fold, and their barrier has other equilibria beyond the fold.
const N_STEPS: u32 = 10;

pub(super) fn run(effort: Effort) -> Result<Outcome> {
    let mesh = irregular_block(effort.choose([4, 3, 4], [6, 5, 6]));
    let mut figures = Vec::new();
    let mut series = Vec::new();
    for (family, closed_form, rest, amounts) in FAMILIES {
        for (element_name, element) in ELEMENTS {
            let mut worst: f64 = 0.0;
            for (color, rubber) in rubbers().iter().enumerate() {
                let body = body_of(&mesh, rubber.material(), element, TIGHT)?;
                let mut found_kpa = Vec::new();
                for amount in amounts {
                    let mut state = body.rest();
                    for step in 1..=N_STEPS {
                        let way = f64::from(step) / f64::from(N_STEPS);
                        deform(
                            &body,
                            &mut state,
                            closed_form(rubber, rest + way * (amount - rest)).0,
                        )?;
                    }
                    let expected_kpa = closed_form(rubber, amount).1;
                    let stress_kpa = mean_stress_kpa(&body, &state);
                    let scale_kpa = size(expected_kpa).max(rubber.law.shear_modulus_kpa());
                    worst = worst.max(size(stress_kpa - expected_kpa) / scale_kpa);
                    found_kpa.push([amount, stress_kpa.x_axis.x]);
                }
                if family == "uniaxial" && element_name == "composite" {
                    let curve = (0..=100).map(|i| 0.6 + 0.01 * f64::from(i));
                    let curve = curve.map(|amount| [amount, closed_form(rubber, amount).1.x_axis.x]);
                    series.push(plots::line(rubber.name, color, curve.collect()));
                    series.extend(found_kpa.into_iter().map(|[x, y]| cross(x, y, color)));
                }
            }
            let name = format!("{family}, {element_name}");
            figures.push(Figure::at_most(1e-6, name, worst, ""));
        }
    }
    let labels = ["stretch", "first Piola–Kirchhoff stress, kPa"];
    Ok(Outcome {
        done: format!(
            "The boundary of an irregular block ({} nodes) is displaced as each closed form prescribes, to \
             six amounts, in {N_STEPS} steps each. The mean stress is that of the forces on the boundary, `P = Σ f ⊗ X / V`. The \
             closed forms are derivatives of the energies with respect to the principal stretches, \
             implemented independently of the solver; free sides are found from zero stress. The figures \
             are the largest errors of all materials and amounts, relative to the stress, or to the shear \
             modulus where the stress is smaller.",
            mesh.n_nodes_refined()
        ),
        figures,
        plots: vec![Plot {
            name: "uniaxial",
            caption: "Lines: closed forms. Ticks: the block.".into(),
            scene: plots::lines("Uniaxial stress", labels, false, series),
        }],
    })
}

/// A short vertical tick for the plot.
fn cross(x: f64, y: f64, color: usize) -> twintac_plot::Series {
    plots::line("", color, vec![[x, y - 2.5], [x, y + 2.5]])
}

fn uniaxial(rubber: &Rubber, stretch: f64) -> (DMat3, DMat3) {
    of_stretches(rubber, rubber.free_stretches(stretch, false))
}

fn equibiaxial(rubber: &Rubber, stretch: f64) -> (DMat3, DMat3) {
    of_stretches(rubber, rubber.free_stretches(stretch, true))
}

fn confined(rubber: &Rubber, stretch: f64) -> (DMat3, DMat3) {
    of_stretches(rubber, DVec3::new(stretch, 1.0, 1.0))
}

fn of_stretches(rubber: &Rubber, stretches: DVec3) -> (DMat3, DMat3) {
    let stress_kpa = rubber.principal_stress_kpa(stretches);
    (DMat3::from_diagonal(stretches), DMat3::from_diagonal(stress_kpa))
}

/// Simple shear of x along z. The stretches in that plane are `λ` and `1/λ` with `λ - 1/λ = γ`.
/// With their axes `N_i` at rest and `n_i` in the deformed state, `F = Σ λ_i n_i ⊗ N_i` and
/// `P = Σ P_i n_i ⊗ N_i`.
fn simple_shear(rubber: &Rubber, amount: f64) -> (DMat3, DMat3) {
    let gradient = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(amount, 0.0, 1.0));
    let stretch = 0.5 * (amount + amount.hypot(2.0));
    let stretches = DVec3::new(stretch, 1.0, 1.0 / stretch);
    // Axes at rest: (1, 0, λ) is stretched by λ, because FᵀF (1, 0, λ) = λ² (1, 0, λ).
    let first = DVec3::new(1.0, 0.0, stretch).normalize();
    let axes = [first, DVec3::Y, first.cross(DVec3::Y)];
    let stress_kpa = rubber.principal_stress_kpa(stretches);
    let mut sum = DMat3::ZERO;
    for (i, axis) in axes.into_iter().enumerate() {
        let now = gradient * axis / stretches[i];
        sum += stress_kpa[i] * DMat3::from_cols(now * axis.x, now * axis.y, now * axis.z);
    }
    (gradient, sum)
}

fn mean_stress_kpa(body: &SoftBody, state: &State) -> DMat3 {
    let mesh = body.mesh();
    let forces_n = body.bonded_forces_n(state);
    let sum: DMat3 = mesh
        .sets
        .bonded
        .iter()
        .zip(forces_n)
        .fold(DMat3::ZERO, |sum, (&node, force)| {
            let at = mesh.nodes_mm[node as usize];
            sum + DMat3::from_cols(force * at.x, force * at.y, force * at.z)
        });
    sum * (1000.0 / mesh.volume_mm3())
}

fn size(matrix: DMat3) -> f64 {
    matrix
        .to_cols_array()
        .into_iter()
        .fold(0.0, |most, entry| most.max(entry.abs()))
}
