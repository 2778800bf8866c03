//! Pressure below a uniformly loaded disc.

use std::f64::consts::PI;

use anyhow::Result;
use glam::DVec3;
use twintac_softbody::{Material, SoftBody, SolverSettings};

use super::half_space::{HalfSpace, SIZE};
use crate::rung::{Effort, Figure, Outcome, Plot, plots};

const RADIUS_MM: f64 = 10.0;
const YOUNGS_KPA: f64 = 70.0;

/// A small load, so that strains are small.
const LOAD_KPA: f64 = 0.001 * YOUNGS_KPA;

/// Range of depths in which pressures are compared, in radii.
const DEPTHS: [f64; 2] = [0.25, 2.5];

/// Depth to which the mesh is fine, in radii.
const FINE_DEPTH: f64 = 2.0;

pub(super) fn run(effort: Effort) -> Result<Outcome> {
    let edges = effort.choose(3.0, 4.0);
    let mut figures = Vec::new();
    let mut series = Vec::new();
    let mut n_nodes = 0;
    for (color, poissons_ratio) in [0.3, 0.49].into_iter().enumerate() {
        let (mut found, nodes) = pressures(poissons_ratio, edges)?;
        n_nodes = nodes;
        found.retain(|[depth, _]| *depth <= 1.2 * DEPTHS[1]);
        let closed = |depth: f64| closed_form(poissons_ratio, depth);
        let worst = found
            .iter()
            .filter(|[depth, _]| (DEPTHS[0]..=DEPTHS[1]).contains(depth))
            .map(|[depth, pressure]| 100.0 * (pressure / closed(*depth) - 1.0))
            .fold(
                0.0,
                |worst: f64, error| if error.abs() > worst.abs() { error } else { worst },
            );
        let name = format!("ν = {poissons_ratio}: largest error in pressure on the axis");
        figures.push(Figure::at_most(3.0, name, worst, "%"));
        let curve = (0..=60)
            .map(|i| 0.05 * f64::from(i))
            .map(|depth| [depth, closed(depth)]);
        series.push(plots::dashes("closed form", color, curve.collect()));
        series.push(plots::line(format!("ν = {poissons_ratio}"), color, found));
    }
    let labels = ["depth over radius", "pressure over load"];
    Ok(Outcome {
        done: format!(
            "A disc with a radius of {RADIUS_MM} mm on a half-space has a uniform load of a thousandth of \
             Young's modulus. On its axis the pressure `-tr(σ)/3` is `2(1 + ν)/3 p (1 - z/√(z² + a²))` at \
             the depth `z` (the solution for a point load, Johnson, Contact Mechanics, 1985, section 3.2, \
             integrated over the disc). The half-space is a block of {SIZE} radii whose sides and bottom \
             are held at the displacements that a point load of the same force causes; {n_nodes} nodes, \
             {edges} pressure edges along the radius. Errors are relative to the closed form at the same \
             depth, at all nodes between {} and {} radii deep; nearer to the surface, the pressure is \
             affected by the edge of the disc, which cuts through triangles.",
            DEPTHS[0], DEPTHS[1]
        ),
        figures,
        plots: vec![Plot {
            name: "pressure",
            caption: "Dashed: closed form.".into(),
            scene: plots::lines("Pressure on the axis of a loaded disc", labels, false, series),
        }],
    })
}

/// Pressure divided by load, at a depth in radii.
fn closed_form(poissons_ratio: f64, depth: f64) -> f64 {
    2.0 * (1.0 + poissons_ratio) / 3.0 * (1.0 - depth / depth.hypot(1.0))
}

/// The simulated values of [`closed_form`] at the nodes on the axis from the top down, and the
/// number of nodes of the mesh.
fn pressures(poissons_ratio: f64, edges: f64) -> Result<(Vec<[f64; 2]>, usize)> {
    let half_space = HalfSpace {
        youngs_kpa: YOUNGS_KPA,
        poissons_ratio,
        radius_mm: RADIUS_MM,
    };
    let load_kpa = |at: DVec3| {
        let is_loaded = at.z.abs() < 1e-9 && at.truncate().length() < RADIUS_MM;
        if is_loaded {
            DVec3::NEG_Z * LOAD_KPA
        } else {
            DVec3::ZERO
        }
    };
    let material = Material::neo_hookean(YOUNGS_KPA, poissons_ratio);
    let mesh = half_space.block(edges, FINE_DEPTH);
    let body = SoftBody::new(&mesh, material, SolverSettings::default())?.with_surface_load(&load_kpa);
    let mut state = body.rest();
    let force_n = 1e-3 * LOAD_KPA * PI * RADIUS_MM * RADIUS_MM;
    half_space.move_far(&body, &mut state, force_n)?;
    let on_axis = body.mesh().nodes_mm.iter().zip(body.pressure_kpa(&state));
    let mut found: Vec<[f64; 2]> = on_axis
        .filter(|(at, _)| at.x == 0.0 && at.y == 0.0)
        .map(|(at, pressure_kpa)| [-at.z / RADIUS_MM, pressure_kpa / LOAD_KPA])
        .collect();
    found.sort_by(|a, b| a[0].total_cmp(&b[0]));
    Ok((found, body.mesh().nodes_mm.len()))
}
