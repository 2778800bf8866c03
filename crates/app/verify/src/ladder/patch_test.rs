//! The patch test: a linear displacement of the boundary gives the same linear displacement inside.

use anyhow::Result;
use glam::{DMat3, DVec3};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use twintac_mesh::{TetMesh, bricks};
use twintac_softbody::{Element, Frame, Material, SoftBody, SolverSettings, State};

use super::rubbers::rubbers;
use crate::rung::{Effort, Figure, Outcome};

/// All kinds of elements.
pub(crate) const ELEMENTS: [(&str, Element); 4] = [
    ("layered", Element::Layered),
    ("composite", Element::Composite),
    ("blended", Element::Blended),
    ("quadratic", Element::Quadratic),
];

/// Tolerance near round-off.
pub(crate) const TIGHT: f64 = 1e-12;

/// Largest random displacement of inner nodes, as a fraction of a cell's size.
const SHAKEN: f64 = 0.15;

/// A block of 3 × 2 × 2.5 mm with randomly displaced inner nodes.
pub(crate) fn irregular_block(cells: [usize; 3]) -> TetMesh {
    let size = DVec3::new(3.0, 2.0, 2.5);
    let [x, y, z] = [0, 1, 2].map(|axis| bricks::even(0.0, size[axis], cells[axis]));
    let mut mesh = bricks::block(&x, &y, &z);
    bricks::bond(&mut mesh, |_| true);
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for (node, at) in (0..).zip(&mut mesh.nodes_mm) {
        if mesh.sets.bonded.binary_search(&node).is_err() {
            for axis in 0..3 {
                at[axis] += size[axis] / cells[axis] as f64 * random.random_range(-SHAKEN..SHAKEN);
            }
        }
    }
    mesh
}

/// A soft body with a solver tolerance.
pub(crate) fn body_of(
    mesh: &TetMesh,
    material: Material,
    element: Element,
    tolerance: f64,
) -> Result<SoftBody> {
    let settings = SolverSettings {
        element,
        tolerance,
        ..SolverSettings::default()
    };
    Ok(SoftBody::new(mesh, material, settings)?)
}

/// Moves the boundary by a deformation gradient.
pub(crate) fn deform(body: &SoftBody, state: &mut State, gradient: DMat3) -> Result<Frame> {
    let moved: Vec<DVec3> = linear(body, gradient, &body.mesh().sets.bonded);
    Ok(body.advance_prescribed(state, &moved, 0.0)?)
}

/// Displacements of these nodes by a deformation gradient, mm.
pub(crate) fn linear(body: &SoftBody, gradient: DMat3, nodes: &[u32]) -> Vec<DVec3> {
    let at = |node: &u32| body.mesh().nodes_mm[*node as usize];
    nodes.iter().map(|node| gradient * at(node) - at(node)).collect()
}

pub(super) fn run(effort: Effort) -> Result<Outcome> {
    let mesh = irregular_block(effort.choose([4, 3, 4], [9, 7, 8]));
    let stretches = DVec3::new(1.15, 0.9, 1.05);
    let turn = |axis: DVec3, angle: f64| DMat3::from_axis_angle(axis.normalize(), angle);
    let gradient = turn(DVec3::new(1.0, 2.0, -0.5), 0.1)
        * DMat3::from_diagonal(stretches)
        * turn(DVec3::new(0.3, -1.0, 0.8), 0.2);
    let mut figures = Vec::new();
    let mut n_nodes = 0;
    for (element_name, element) in ELEMENTS {
        for rubber in &rubbers() {
            let body = body_of(&mesh, rubber.material(), element, TIGHT)?;
            n_nodes = body.mesh().nodes_mm.len();
            let mut state = body.rest();
            deform(&body, &mut state, gradient)?;
            let every: Vec<u32> = (0..n_nodes as u32).collect();
            let displacement = linear(&body, gradient, &every)
                .iter()
                .zip(state.displacements_mm())
                .map(|(expected, found)| expected.distance(*found))
                .fold(0.0, f64::max);
            let pressure_kpa = rubber.pressure_kpa(stretches);
            let pressure = body
                .pressure_kpa(&state)
                .iter()
                .map(|found| (found / pressure_kpa - 1.0).abs())
                .fold(0.0, f64::max);
            let name = |what| format!("{element_name}, {}: {what}", rubber.name);
            figures.push(Figure::at_most(1e-9, name("displacement"), displacement, "mm"));
            figures.push(Figure::at_most(1e-9, name("pressure, relative"), pressure, ""));
        }
    }
    Ok(Outcome {
        done: format!(
            "A block of 3 × 2 × 2.5 mm has {n_nodes} nodes; its inner nodes are displaced at random by up \
             to {} % of a cell. Its boundary is displaced by a linear field with stretches, shears and a \
             change of volume of {:.1} %. Inside, displacements must equal that field, and all pressures \
             must have one value. The figures are the largest errors of all nodes.",
            100.0 * SHAKEN,
            100.0 * (gradient.determinant() - 1.0)
        ),
        figures,
        plots: Vec::new(),
    })
}
