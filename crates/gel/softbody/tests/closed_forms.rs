//! Homogeneous deformations of an irregular mesh, compared with closed forms.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests

mod common;

use common::{block, bond, even};
use glam::{DMat3, DQuat, DVec3};
use twintac_mesh::TetMesh;
use twintac_softbody::{Material, Model, PronyTerm, SoftBody, SolverSettings, State};

const BULK_KPA: f64 = 1200.0;
/// A block whose inner nodes are displaced at random, with all of its boundary bonded.
fn shaken_block() -> TetMesh {
    let mut mesh = block(&even(0.0, 3.0, 4), &even(0.0, 2.0, 3), &even(0.0, 2.5, 4));
    bond(&mut mesh, |_| true);
    let mut seed = 1_u32;
    let mut shake = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        0.2 * (f64::from(seed >> 8) / f64::from(1 << 24) - 0.5)
    };
    for node in 0..mesh.nodes_mm.len() {
        if !mesh.sets.bonded.contains(&(node as u32)) {
            mesh.nodes_mm[node] += DVec3::new(shake(), shake(), shake());
        }
    }
    mesh
}

/// Whether a law itself resists a change of volume; such a law has no relaxation.
fn has_pressure(law: &Model) -> bool {
    matches!(law, Model::LogarithmicNeoHookean(_) | Model::StableNeoHookean(_))
}

fn body(law: Model, prony: Vec<PronyTerm>) -> SoftBody {
    body_to(law, prony, 1e-12)
}

fn body_to(law: Model, prony: Vec<PronyTerm>, tolerance: f64) -> SoftBody {
    let settings = SolverSettings {
        tolerance,
        ..SolverSettings::default()
    };
    SoftBody::new(
        &shaken_block(),
        Material {
            model: law,
            bulk_modulus_kpa: BULK_KPA,
            prony,
        },
        settings,
    )
    .unwrap()
}

/// Moves the boundary by this deformation gradient.
fn deform(body: &SoftBody, state: &mut State, gradient: DMat3, time_step_s: f64) {
    let mesh = body.mesh();
    let moved: Vec<DVec3> = mesh
        .sets
        .bonded
        .iter()
        .map(|&node| gradient * mesh.nodes_mm[node as usize] - mesh.nodes_mm[node as usize])
        .collect();
    body.advance_prescribed(state, &moved, time_step_s).unwrap();
}

/// Mean first Piola–Kirchhoff stress, kPa, from the forces on the boundary: `P_ij = Σ f_i X_j / V`.
fn stress_kpa(body: &SoftBody, state: &State) -> DMat3 {
    let mesh = body.mesh();
    let mut sum = DMat3::ZERO;
    for (&node, force) in mesh.sets.bonded.iter().zip(body.bonded_forces_n(state)) {
        let at = mesh.nodes_mm[node as usize];
        sum += DMat3::from_cols(force * at.x, force * at.y, force * at.z);
    }
    sum * (1000.0 / mesh.volume_mm3())
}

/// `λ_i ∂W/∂λ_i` for principal stretches, kPa, including the term of the averaged volume change.
fn principal_kirchhoff_kpa(model: &Model, stretches: DVec3) -> DVec3 {
    let volume = stretches.x * stretches.y * stretches.z;
    let squares = stretches * stretches;
    let first = squares.element_sum();
    let second = squares.x * squares.y + squares.y * squares.z + squares.z * squares.x;
    let (first_bar, second_bar) = (volume.powf(-2.0 / 3.0) * first, volume.powf(-4.0 / 3.0) * second);
    let by_invariants = |[slope_1, slope_2]: [f64; 2]| {
        let isochoric_1 = volume.powf(-2.0 / 3.0) * (2.0 * squares - 2.0 / 3.0 * first);
        let isochoric_2 =
            volume.powf(-4.0 / 3.0) * 2.0 * squares * (first - squares) - 4.0 / 3.0 * second_bar;
        slope_1 * isochoric_1 + slope_2 * isochoric_2
    };
    let by_mean_volume = |modulus_kpa: f64| modulus_kpa * (volume - 1.0) * volume;
    match model {
        Model::NeoHookean(law) => {
            by_invariants([0.5 * law.shear_modulus_kpa, 0.0]) + by_mean_volume(BULK_KPA)
        }
        Model::MooneyRivlin(law) => by_invariants([law.c10_kpa, law.c01_kpa]) + by_mean_volume(BULK_KPA),
        Model::Yeoh(law) => {
            let x = first_bar - 3.0;
            let slope = law.c10_kpa + 2.0 * law.c20_kpa * x + 3.0 * law.c30_kpa * x * x;
            by_invariants([slope, 0.0]) + by_mean_volume(BULK_KPA)
        }
        Model::Ogden(law) => {
            let mut sum = DVec3::ZERO;
            for term in &law.terms {
                let powers = (stretches * volume.powf(-1.0 / 3.0)).powf(term.alpha);
                sum += term.mu_kpa * (powers - powers.element_sum() / 3.0);
            }
            sum + by_mean_volume(BULK_KPA)
        }
        Model::LogarithmicNeoHookean(law) => {
            let mu_kpa = law.shear_modulus_kpa;
            mu_kpa * (squares - 1.0) + by_mean_volume(BULK_KPA - 2.0 / 3.0 * mu_kpa)
        }
        Model::StableNeoHookean(law) => {
            // In the form of Smith, de Goes and Kim (2018), with the quadratic term in the volume
            // in one piece.
            let mu = 4.0 / 3.0 * law.shear_modulus_kpa;
            let lambda = BULK_KPA - 2.0 / 3.0 * law.shear_modulus_kpa + 5.0 / 6.0 * law.shear_modulus_kpa;
            let rest = 1.0 + mu / lambda - mu / (4.0 * lambda);
            mu * (1.0 - 1.0 / (first + 1.0)) * squares + lambda * (volume - rest) * volume
        }
    }
}

/// First Piola–Kirchhoff stress along the axes, kPa, for stretches along the axes.
fn principal_stress_kpa(model: &Model, stretches: DVec3) -> DVec3 {
    principal_kirchhoff_kpa(model, stretches) / stretches
}

/// `-tr(σ)/3` for principal stretches, kPa.
fn hydrostatic_pressure_kpa(model: &Model, stretches: DVec3) -> f64 {
    -principal_kirchhoff_kpa(model, stretches).element_sum() / (3.0 * stretches.element_product())
}

/// The root of an increasing function.
fn bisect(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 {
            low = middle
        } else {
            high = middle
        }
    }
    0.5 * (low + high)
}

#[track_caller]
fn assert_close(found: DMat3, expected: DMat3) {
    let (found, expected) = (found.to_cols_array(), expected.to_cols_array());
    let scale = expected
        .iter()
        .fold(0.0_f64, |scale, value| scale.max(value.abs()));
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-6 * scale, "{found} {expected}");
    }
}

#[test]
fn a_linear_field_passes_the_patch_test() {
    let stretches = DVec3::new(1.12, 0.87, 1.04);
    let turn = |a: f64, b: f64, c: f64| DMat3::from_quat(DQuat::from_euler(glam::EulerRot::XYZ, a, b, c));
    let gradient = turn(0.2, -0.1, 0.3) * DMat3::from_diagonal(stretches) * turn(-0.4, 0.3, 0.1);
    for law in Model::examples() {
        let body = body(law.clone(), Vec::new());
        let mut state = body.rest();
        deform(&body, &mut state, gradient, 0.0);
        let pressure_kpa = hydrostatic_pressure_kpa(&law, stretches);
        for (node, &at) in body.mesh().nodes_mm.iter().enumerate() {
            let error = state.displacement_mm(node) - (gradient * at - at);
            assert!(error.length() < 1e-9, "node {node}: {error}");
            assert!((body.pressure_kpa(&state)[node] / pressure_kpa - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn uniaxial_equibiaxial_and_confined_stretches_follow_the_closed_forms() {
    for law in Model::examples() {
        let uniaxial = |stretch: f64| {
            let at = |side: f64| DVec3::new(side, side, stretch);
            at(bisect(0.5, 1.5, |side| principal_stress_kpa(&law, at(side)).x))
        };
        let equibiaxial = |stretch: f64| {
            let at = |height: f64| DVec3::new(stretch, stretch, height);
            at(bisect(0.3, 1.5, |height| {
                principal_stress_kpa(&law, at(height)).z
            }))
        };
        let confined = |stretch: f64| DVec3::new(1.0, 1.0, stretch);
        let cases = [
            uniaxial(0.7),
            uniaxial(1.4),
            equibiaxial(1.2),
            equibiaxial(0.9),
            confined(0.9),
            confined(1.05),
        ];
        for stretches in cases {
            let body = body(law.clone(), Vec::new());
            let mut state = body.rest();
            deform(&body, &mut state, DMat3::from_diagonal(stretches), 0.0);
            let expected = DMat3::from_diagonal(principal_stress_kpa(&law, stretches));
            assert_close(stress_kpa(&body, &state), expected);
        }
    }
}

fn sheared(amount: f64) -> DMat3 {
    DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(amount, 0.0, 1.0))
}

/// Simple shear keeps the volume. Its principal stretches are `λ, 1, 1/λ` with `λ - 1/λ = γ`, the
/// first at `tan θ = 1/λ` to the direction of the shear: `σ = Σ τ_i n_i ⊗ n_i`, `P = σ F⁻ᵀ`.
fn shear_stress_kpa(law: &Model, amount: f64) -> DMat3 {
    let largest = 0.5 * amount + (1.0 + 0.25 * amount * amount).sqrt();
    let kirchhoff = principal_kirchhoff_kpa(law, DVec3::new(largest, 1.0, 1.0 / largest));
    let along = DVec3::new(largest, 0.0, 1.0).normalize();
    let axes = DMat3::from_cols(along, DVec3::Y, along.cross(DVec3::Y));
    axes * DMat3::from_diagonal(kirchhoff) * axes.transpose() * sheared(amount).inverse().transpose()
}

#[test]
fn simple_shear_follows_the_closed_form() {
    for law in Model::examples() {
        let body = body(law.clone(), Vec::new());
        let mut state = body.rest();
        deform(&body, &mut state, sheared(0.4), 0.0);
        assert_close(stress_kpa(&body, &state), shear_stress_kpa(&law, 0.4));
        // Where normal stresses are small, σ_xz is √3 times smaller than the von Mises stress; here
        // all components are used.
        let left = shear_stress_kpa(&law, 0.4) * sheared(0.4).transpose();
        let mean = (left.x_axis.x + left.y_axis.y + left.z_axis.z) / 3.0;
        let left = left - DMat3::from_diagonal(DVec3::splat(mean));
        let squares: f64 = left.to_cols_array().iter().map(|value| value * value).sum();
        for von_mises_kpa in body.von_mises_kpa(&state) {
            assert!((von_mises_kpa / (1.5 * squares).sqrt() - 1.0).abs() < 1e-6);
        }
    }
}

const PRONY: [PronyTerm; 2] = [
    PronyTerm {
        weight: 0.2,
        time_s: 0.1,
    },
    PronyTerm {
        weight: 0.15,
        time_s: 2.0,
    },
];

#[test]
fn a_held_shear_relaxes_by_the_prony_series() {
    for law in Model::examples().into_iter().filter(|law| !has_pressure(law)) {
        let body = body(law.clone(), PRONY.to_vec());
        let mut state = body.rest();
        deform(&body, &mut state, sheared(0.4), 0.0);
        assert_close(stress_kpa(&body, &state), shear_stress_kpa(&law, 0.4));
        let mut time_s = 0.0;
        // Steps of very different length: the recurrence is exact while nothing moves.
        for step_s in [0.01, 0.3, 1.0, 20.0] {
            time_s += step_s;
            deform(&body, &mut state, sheared(0.4), step_s);
            let left: f64 = PRONY
                .iter()
                .map(|term| term.weight * (1.0 - (-time_s / term.time_s).exp()))
                .sum();
            assert_close(
                stress_kpa(&body, &state),
                shear_stress_kpa(&law, 0.4) * (1.0 - left),
            );
        }
    }
}

#[test]
fn a_slow_ramp_follows_the_convolution() {
    // The shear is small, so that the stress without relaxation is μγ; then σ(t) = μ γ̇ [(1 - Σw)
    // t + Σ w τ (1 - exp(-t/τ))].
    let (rate, law) = (1e-3, Model::examples().remove(0));
    let body = body_to(law, PRONY.to_vec(), 1e-8);
    let mut state = body.rest();
    for step in 1..=10 {
        let time_s = 0.05 * f64::from(step);
        deform(&body, &mut state, sheared(rate * time_s), 0.05);
        let fading: f64 = PRONY
            .iter()
            .map(|term| term.weight * (term.time_s * (1.0 - (-time_s / term.time_s).exp()) - time_s))
            .sum();
        let expected = 23.5 * rate * (time_s + fading);
        let found = stress_kpa(&body, &state).z_axis.x;
        assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
    }
}
