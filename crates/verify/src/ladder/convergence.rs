//! Convergence with the mesh of what a sensor gives.

use anyhow::{Context, Result};
use glam::DVec3;
use twintac_mesh::bricks;
use twintac_sensor::Sensor;
use twintac_shape::{Pose, Shape, Surfaces};
use twintac_simulate::PortReadout;
use twintac_softbody::{Material, SoftBody, SolverSettings};

use super::Effort;
use super::outcome::{Figure, Outcome, Plot};
use super::plots;

const BALL: Shape = Shape::Sphere { radius_mm: 12.5 };
const DEPTH_MM: f64 = 2.0;
const PLACE_MM: [f64; 2] = [1.0, -2.0];

/// Taxels whose pressure is followed: below the ball, and beside it.
const TAXELS: [&str; 2] = ["t1", "t3"];

/// Force, N, and pressure at the taxels, kPa, with this many pressure cells over the gel's height; and the nodes of the mesh.
fn solve(sensor: &Sensor, n: usize) -> Result<([f64; 3], usize)> {
    let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
    let mesh = bricks::block(
        &bricks::even(low.x, high.x, 4 * n),
        &bricks::even(low.y, high.y, 2 * n),
        &bricks::even(low.z, high.z, n),
    );
    let body = SoftBody::new(
        &mesh,
        Material::neo_hookean(70.0, 0.49),
        SolverSettings::default(),
    )?;
    let mut state = body.rest();
    let ball = BALL.signed_distance_field(&Surfaces::new())?;
    let pose = Pose::from_position(DVec3::new(PLACE_MM[0], PLACE_MM[1], high.z - DEPTH_MM));
    let mut found = [0.0; 3];
    // Once more in place, so that nothing penetrates that the force depends on.
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
    let cells: &[usize] = effort.choose(&[2, 3, 4, 6, 8], &[2, 3, 4, 6, 8, 12]);
    let sensor = Sensor::read("sensors/phystac.toml").context("run this where the folder `sensors` is")?;
    let mut all = Vec::new();
    for &n in cells {
        all.push(solve(&sensor, n)?);
    }
    let finest = cells[cells.len() - 1];
    let [coarse, middle, fine] = [finest / 4, finest / 2, finest].map(|n| {
        let index = cells.iter().position(|&cells| cells == n);
        all[index.unwrap_or_default()].0
    });
    let mut figures = Vec::new();
    let mut series = Vec::new();
    let names = [
        "force".to_owned(),
        format!("pressure at {}", TAXELS[0]),
        format!("pressure at {}", TAXELS[1]),
    ];
    for (color, name) in names.into_iter().enumerate() {
        let order = ((coarse[color] - middle[color]) / (middle[color] - fine[color]))
            .abs()
            .log2();
        let limit = fine[color] + (fine[color] - middle[color]) / (order.exp2() - 1.0);
        let unit = if color == 0 { "N" } else { "kPa" };
        figures.push(Figure::told(format!("{name}, extrapolated"), limit, unit));
        figures.push(Figure::at_least(
            1.0,
            format!("{name}: observed order"),
            order,
            "",
        ));
        let errors: Vec<[f64; 2]> = all
            .iter()
            .zip(cells)
            .map(|((found, _), n)| [*n as f64, 100.0 * (found[color] / limit - 1.0).abs()])
            .collect();
        figures.push(Figure::at_most(
            2.0,
            format!("{name}: error of the finest mesh, by extrapolation"),
            errors[errors.len() - 1][1],
            "%",
        ));
        series.push(plots::line(name, color, errors));
    }
    let labels = ["pressure cells over the height", "size of the error, %"];
    Ok(Outcome {
        done: format!(
            "A ball of 12.5 mm is pressed {DEPTH_MM} mm into the gel of `phystac` (ν = 0.49, no shell), on meshes of {} to {} nodes whose \
             cells are all alike. The observed order is that of three meshes, each twice as fine as the one before; with it the values \
             are extrapolated to cells of no size (Richardson), and errors are the distances from that.",
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
