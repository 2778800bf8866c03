//! Contact of a ball with a half-space, against Hertz's solution.

use anyhow::Result;
use glam::DVec3;
use twintac_shape::{Pose, Shape, Surfaces};
use twintac_softbody::{Material, SoftBody, SolverSettings};

use super::half_space::{HalfSpace, SIZE};
use crate::rung::{Effort, Figure, Outcome, Plot, plots};

const RADIUS_MM: f64 = 200.0;
const DEPTH_MM: f64 = 0.5;
const YOUNGS_KPA: f64 = 70.0;

/// Number of steps at the same pose, which remove the penetration that would affect the force.
const HOLDS: u32 = 3;

/// Largest accepted error, %.
const LIMIT: f64 = 3.0;

pub(super) fn run(effort: Effort) -> Result<Outcome> {
    let edges: &[f64] = effort.choose(&[1.0, 1.5, 2.0, 2.5], &[1.0, 1.5, 2.0, 3.0, 4.0]);
    let mut figures = Vec::new();
    let mut series = Vec::new();
    let mut n_nodes = 0;
    for (color, poissons_ratio) in [0.3, 0.49].into_iter().enumerate() {
        let mut errors = Vec::new();
        for &edges in edges {
            let (error, nodes) = error_percent(poissons_ratio, edges)?;
            errors.push([edges, error]);
            n_nodes = n_nodes.max(nodes);
        }
        // Errors change their sign during refinement, so a coarse mesh can be accurate by chance.
        let last = errors[errors.len() - 1][1];
        let largest = errors.iter().map(|[_, error]| error.abs()).fold(0.0, f64::max);
        let name = |what: &str| format!("ν = {poissons_ratio}: {what}");
        figures.push(Figure::at_most(
            LIMIT,
            name("error in force, finest mesh"),
            last,
            "%",
        ));
        figures.push(Figure::at_most(
            0.8,
            name("size of that over the largest of all meshes"),
            last.abs() / largest,
            "",
        ));
        let sizes = errors
            .into_iter()
            .map(|[edges, error]| [edges, error.abs()])
            .collect();
        series.push(plots::line(format!("ν = {poissons_ratio}"), color, sizes));
    }
    let range = [edges[0], edges[edges.len() - 1]];
    series.push(plots::dashes("limit", 5, range.map(|x| [x, LIMIT]).to_vec()));
    let labels = [
        "pressure edges along the contact radius",
        "magnitude of the error in force, %",
    ];
    Ok(Outcome {
        done: format!(
            "A rigid ball with a radius of {RADIUS_MM} mm is pressed {DEPTH_MM} mm into a half-space, so \
             that the contact radius is {:.2} of the ball's; the force by Hertz (1881) is `4/3 E/(1 - ν²) \
             √R d^1.5`. The half-space is a block that extends {SIZE} contact radii to all sides. Its sides \
             and bottom are held at the displacements of the half-space under that force (Boussinesq), so \
             that no correction for the size of the block is needed. Up to {n_nodes} nodes.",
            (DEPTH_MM / RADIUS_MM).sqrt()
        ),
        figures,
        plots: vec![Plot {
            name: "error",
            caption: "Displacements have twice as many edges as pressures.".into(),
            scene: plots::lines("Force on a ball against Hertz", labels, true, series),
        }],
    })
}

/// Error of the force, %, and number of nodes of the mesh.
fn error_percent(poissons_ratio: f64, edges: f64) -> Result<(f64, usize)> {
    let half_space = HalfSpace {
        youngs_kpa: YOUNGS_KPA,
        poissons_ratio,
        radius_mm: (RADIUS_MM * DEPTH_MM).sqrt(),
    };
    let plane_strain_mpa = 1e-3 * YOUNGS_KPA / (1.0 - poissons_ratio * poissons_ratio);
    let force_n = 4.0 / 3.0 * plane_strain_mpa * RADIUS_MM.sqrt() * DEPTH_MM.powf(1.5);
    let material = Material::neo_hookean(YOUNGS_KPA, poissons_ratio);
    let mesh = half_space.block(edges, 0.75);
    let body = SoftBody::new(&mesh, material, SolverSettings::default())?;
    let mut state = body.rest();
    half_space.move_far(&body, &mut state, force_n)?;
    let ball = Shape::Sphere { radius_mm: RADIUS_MM }.signed_distance_field(&Surfaces::new())?;
    let pose = Pose::from_position(DVec3::NEG_Z * DEPTH_MM);
    let mut found_n = 0.0;
    for _ in 0..=HOLDS {
        found_n = -body
            .advance(&mut state, ball.as_ref(), &pose, 0.0)?
            .indenter_force_n
            .z;
    }
    Ok((100.0 * (found_n / force_n - 1.0), body.mesh().nodes_mm.len()))
}
