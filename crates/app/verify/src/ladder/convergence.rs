//! Mesh convergence of a sensor's force and pressures.

use anyhow::{Context, Result};
use glam::DVec3;
use twintac_mesh::bricks;
use twintac_sensor::Sensor;
use twintac_shape::{Pose, Shape, Surfaces};
use twintac_simulate::PortReadout;
use twintac_softbody::{Element, Material, SoftBody, SolverSettings};

use crate::rung::{Effort, Figure, Outcome, Plot, plots};

const BALL: Shape = Shape::Sphere { radius_mm: 12.5 };
const DEPTH_MM: f64 = 2.0;
const PLACE_MM: [f64; 2] = [1.0, -2.0];

/// Taxels whose pressure is compared: one below the ball, and one beside it.
const TAXELS: [&str; 2] = ["t1", "t3"];

/// Force, N, and pressure at the taxels, kPa, with `n` pressure cells over the gel's height; and
/// the number of nodes of the mesh.
fn solve(sensor: &Sensor, element: Element, n: usize) -> Result<([f64; 3], usize)> {
    let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
    let mesh = bricks::block(
        &bricks::even(low.x, high.x, 4 * n),
        &bricks::even(low.y, high.y, 2 * n),
        &bricks::even(low.z, high.z, n),
    );
    let settings = SolverSettings {
        element,
        ..SolverSettings::default()
    };
    let body = SoftBody::new(&mesh, Material::neo_hookean(70.0, 0.49), settings)?;
    let mut state = body.rest();
    let ball = BALL.signed_distance_field(&Surfaces::new())?;
    let pose = Pose::from_position(DVec3::new(PLACE_MM[0], PLACE_MM[1], high.z - DEPTH_MM));
    let mut found = [0.0; 3];
    // The second step at the same pose removes the penetration that would affect the force.
    for _ in 0..2 {
        found[0] = -body
            .advance(&mut state, ball.as_ref(), &pose, 0.0)?
            .indenter_force_n
            .z;
    }
    let pressure_kpa = body.pressure_kpa(&state);
    for (found, name) in found[1..].iter_mut().zip(TAXELS) {
        let taxel = sensor.taxels.iter().find(|taxel| taxel.name == name);
        let taxel = taxel.with_context(|| format!("the sensor lacks the taxel {name}"))?;
        *found = PortReadout::of_taxel(body.mesh(), taxel)?.read(&pressure_kpa);
    }
    Ok((found, body.mesh().nodes_mm.len()))
}

pub(super) fn run(effort: Effort) -> Result<Outcome> {
    let cells: &[usize] = effort.choose(&[3, 4, 6, 8], &[3, 4, 5, 6, 8, 10]);
    let sensor = Sensor::read("sensors/phystac.toml").context("run this where the folder `sensors` is")?;
    let mut all = Vec::new();
    for &n in cells {
        all.push(solve(&sensor, Element::Layered, n)?);
    }
    let (reference, n_reference) = solve(&sensor, Element::Quadratic, cells[cells.len() - 1])?;
    let mut figures = Vec::new();
    let mut series = Vec::new();
    let names = ["force".to_owned()]
        .into_iter()
        .chain(TAXELS.map(|taxel| format!("pressure at {taxel}")));
    for (which, name) in names.enumerate() {
        let errors: Vec<[f64; 2]> = all
            .iter()
            .zip(cells)
            .map(|((found, _), n)| [*n as f64, 100.0 * (found[which] / reference[which] - 1.0).abs()])
            .collect();
        let (unit, limit) = if which == 0 { ("N", 3.0) } else { ("kPa", 5.0) };
        let finest = errors[errors.len() - 1][1];
        figures.push(Figure::told(format!("{name}, reference"), reference[which], unit));
        figures.push(Figure::at_most(
            limit,
            format!("{name}: error of the finest mesh"),
            finest,
            "%",
        ));
        figures.push(Figure::told(
            format!("{name}: observed order"),
            order(&errors),
            "",
        ));
        series.push(plots::line(name, which, errors));
    }
    let labels = ["pressure cells over the height", "magnitude of the error, %"];
    Ok(Outcome {
        done: format!(
            "A ball with a radius of 12.5 mm is pressed {DEPTH_MM} mm into the gel of `phystac` (ν = 0.49, \
             no shell), on meshes of {} to {} nodes with equal cells. Errors are differences from the \
             result of the 10-node tetrahedron on the finest mesh ({n_reference} nodes). The observed order \
             is the slope of a line through the logarithms of all errors over those of the cell size. The \
             force on a coarse mesh is right by chance where nodes come into contact at the right depth. The \
             reference has an error of its own, so that errors below about 1 % show no order.",
            all[0].1,
            all[all.len() - 1].1
        ),
        figures,
        plots: vec![Plot {
            name: "error",
            caption: "Displacements have twice as many cells.".into(),
            scene: plots::lines("Convergence of force and pressure", labels, true, series),
        }],
    })
}

/// Order of convergence: the slope of errors over cell size on logarithmic axes, by least squares.
fn order(errors: &[[f64; 2]]) -> f64 {
    let logarithms = || errors.iter().map(|[n, error]| [n.ln(), error.max(1e-12).ln()]);
    let mean = |of: usize| logarithms().map(|point| point[of]).sum::<f64>() / errors.len() as f64;
    let (x, y) = (mean(0), mean(1));
    let mixed: f64 = logarithms().map(|point| (point[0] - x) * (point[1] - y)).sum();
    let square: f64 = logarithms().map(|point| (point[0] - x).powi(2)).sum();
    -mixed / square
}
