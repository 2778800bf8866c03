//! Bending of a nearly incompressible body.

use anyhow::{Context, Result};
use glam::DVec3;
use twintac_mesh::{TetMesh, bricks};
use twintac_softbody::{Element, Material, SoftBody, SolverSettings};

use crate::rung::{Effort, Figure, Outcome, Plot, plots};

const YOUNGS_KPA: f64 = 70.0;
const NEARLY: f64 = 0.4999;

/// Upward traction on the right end.
const LOAD_KPA: f64 = 0.6;

const LENGTH_MM: f64 = 48.0;
const THICKNESS_MM: f64 = 12.0;

/// Cook's membrane, with `n` cells along each edge and half as many through its thickness: fixed at
/// the left, 44 mm high, loaded at the right, 16 mm high.
fn panel(n: usize) -> TetMesh {
    let lines = bricks::even(0.0, 1.0, n);
    let mut mesh = bricks::block(&lines, &lines, &bricks::even(0.0, THICKNESS_MM, n.div_ceil(2)));
    bricks::bond(&mut mesh, |at| at.x == 0.0);
    for at in &mut mesh.nodes_mm {
        let height_mm = 44.0 - 28.0 * at.x;
        *at = DVec3::new(LENGTH_MM * at.x, 44.0 * at.x + height_mm * at.y, at.z);
    }
    mesh
}

/// Rise of the upper right corner, mm, and number of nodes of the mesh.
fn rise_mm(element: Element, poissons_ratio: f64, n: usize) -> Result<(f64, usize)> {
    let settings = SolverSettings {
        element,
        ..SolverSettings::default()
    };
    let is_right = |at: DVec3| at.x > LENGTH_MM - 1e-9;
    let load_kpa = |at: DVec3| {
        if is_right(at) {
            DVec3::Y * LOAD_KPA
        } else {
            DVec3::ZERO
        }
    };
    let material = Material::neo_hookean(YOUNGS_KPA, poissons_ratio);
    let body = SoftBody::new(&panel(n), material, settings)?.with_surface_load(&load_kpa);
    let mut state = body.rest();
    let still = vec![DVec3::ZERO; body.mesh().sets.bonded.len()];
    body.advance_prescribed(&mut state, &still, 0.0)
        .with_context(|| format!("{element:?}, {n} cells"))?;
    let nodes_mm = &body.mesh().nodes_mm;
    let corner = DVec3::new(LENGTH_MM, 60.0, 0.0);
    let node = (0..nodes_mm.len())
        .min_by(|&a, &b| {
            nodes_mm[a]
                .distance(corner)
                .total_cmp(&nodes_mm[b].distance(corner))
        })
        .context("a mesh without nodes")?;
    Ok((state.displacement_mm(node).y, nodes_mm.len()))
}

pub(super) fn run(effort: Effort) -> Result<Outcome> {
    let cells: &[usize] = effort.choose(&[4, 8, 14], &[2, 4, 6, 8, 12, 16]);
    let reference_cells = effort.choose(8, 16);
    let mut figures = Vec::new();
    let mut series = Vec::new();
    let mut n_reference = 0;
    for (color, poissons_ratio) in [NEARLY, 0.3].into_iter().enumerate() {
        let (reference_mm, nodes) = rise_mm(Element::Quadratic, poissons_ratio, reference_cells)?;
        n_reference = nodes;
        for (name, element) in [("layered", Element::Layered), ("quadratic", Element::Quadratic)] {
            let mut points = Vec::new();
            for &n in cells {
                if element != Element::Quadratic || n < reference_cells {
                    let (found_mm, _) = rise_mm(element, poissons_ratio, n)?;
                    points.push([n as f64, 100.0 * (found_mm / reference_mm - 1.0)]);
                }
            }
            if let (Element::Layered, Some([n, error])) = (element, points.last().copied()) {
                let name = format!("ν = {poissons_ratio}: error in the corner's rise, layered, {n} cells");
                figures.push(Figure::at_most(3.0, name, error, "%"));
            }
            let label = format!("ν = {poissons_ratio}, {name}");
            series.push(match element {
                Element::Quadratic => plots::dashes(label, color, points),
                _ => plots::line(label, color, points),
            });
        }
        figures.push(Figure::told(
            format!("ν = {poissons_ratio}: rise of the reference"),
            reference_mm,
            "mm",
        ));
    }
    let labels = ["pressure cells along an edge", "error in the corner's rise, %"];
    Ok(Outcome {
        done: format!(
            "Cook's tapered panel (1974), 48 mm long and {THICKNESS_MM} mm thick, is held at its left end \
             and pulled up by {LOAD_KPA} kPa at its right one. The reference is the 10-node tetrahedron \
             with {reference_cells} cells along an edge, {n_reference} nodes. An element that locks would \
             be much too stiff at ν = {NEARLY}, but not at ν = 0.3."
        ),
        figures,
        plots: vec![Plot {
            name: "error",
            caption: "Displacements have twice as many cells.".into(),
            scene: plots::lines("Cook's membrane", labels, false, series),
        }],
    })
}
