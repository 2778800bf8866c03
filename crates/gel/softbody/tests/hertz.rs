//! A ball on a large block, compared with Hertz (1881), with the correction of Dimitriadis et al.
//! (Biophys. J. 82, 2002) for a layer that is bonded to a rigid board.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests

mod common;

use std::f64::consts::PI;

use common::{Ball, block, graded, mirrored, press};
use twintac_softbody::{Material, SoftBody, SolverSettings};

const RADIUS_MM: f64 = 20.0;
const DEPTH_MM: f64 = 0.2;
const YOUNGS_KPA: f64 = 70.0;

/// Contact radius according to Hertz: a tenth of the ball's radius.
fn contact_radius_mm() -> f64 {
    (RADIUS_MM * DEPTH_MM).sqrt()
}

fn closed_form_n(poissons: f64, thickness_mm: f64) -> f64 {
    let hertz_n =
        4.0 / 3.0 * YOUNGS_KPA / 1000.0 / (1.0 - poissons * poissons) * RADIUS_MM.sqrt() * DEPTH_MM.powf(1.5);
    let chi = contact_radius_mm() / thickness_mm;
    let a = -(1.2876 - 1.4678 * poissons + 1.3442 * poissons * poissons) / (1.0 - poissons);
    let b = (0.6387 - 1.0277 * poissons + 1.5164 * poissons * poissons) / (1.0 - poissons);
    let correction = 1.0 - 2.0 * a / PI * chi + 4.0 * a * a / PI.powi(2) * chi.powi(2)
        - 8.0 / PI.powi(3) * (a.powi(3) + 4.0 * PI * PI / 15.0 * b) * chi.powi(3)
        + 16.0 * a / PI.powi(4) * (a.powi(3) + 3.0 * PI * PI / 5.0 * b) * chi.powi(4);
    hertz_n * correction
}

/// Relative error in force with this number of edges along the contact radius; displacements have
/// twice as many.
fn error(poissons: f64, edges: f64) -> f64 {
    let a = contact_radius_mm();
    let size_mm = 12.0 * a;
    let growth = 1.0 + 1.8 / edges;
    let half = graded(a / edges, 1.25 * a, growth, size_mm);
    let side = mirrored(&half);
    let heights: Vec<f64> = graded(a / edges, 0.75 * a, growth, size_mm)
        .iter()
        .rev()
        .map(|down| size_mm - down)
        .collect();
    let mesh = block(&side, &side, &heights);
    let n_nodes = mesh.n_nodes_refined();
    let body = SoftBody::new(
        &mesh,
        Material::neo_hookean(YOUNGS_KPA, poissons),
        SolverSettings::default(),
    )
    .unwrap();
    let mut state = body.rest();
    let frame = press(
        &body,
        &mut state,
        &Ball { radius_mm: RADIUS_MM },
        size_mm,
        DEPTH_MM,
    )
    .unwrap();
    let error = -frame.indenter_force_n.z / closed_form_n(poissons, size_mm) - 1.0;
    println!(
        "ν = {poissons}, {edges} edges, {n_nodes} nodes: {:+.2} %, {} iterations",
        100.0 * error,
        frame.iterations
    );
    error
}

#[test]
fn the_force_on_a_ball_is_that_of_hertz() {
    for poissons in [0.3, 0.49] {
        let (coarse, fine) = (error(poissons, 1.0), error(poissons, 2.0));
        assert!(fine.abs() < 0.03, "{fine}");
        assert!(fine.abs() < coarse.abs(), "{coarse} {fine}");
    }
}
