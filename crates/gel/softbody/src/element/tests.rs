use glam::{DMat3, DVec3, Mat3};
use proptest::prelude::*;
use twintac_material::{MooneyRivlin, NeoHookean, Ogden, OgdenTerm};

use super::table::{self, Table};
use super::*;
use crate::relaxation::{History, Relaxation};
use crate::wide::LANES;
use crate::{Material, Model, PronyTerm};

/// Pressures of the corners, MPa.
const CORNERS: [f64; 4] = [0.004, -0.002, 0.007, 0.001];

/// One coarse tetrahedron, and its eight parts.
pub(super) fn one(element: Element) -> (Vec<DVec3>, Elements) {
    let mesh = twintac_mesh::TetMesh {
        nodes_mm: vec![
            DVec3::ZERO,
            DVec3::new(1.1, 0.1, 0.0),
            DVec3::new(0.2, 0.9, -0.1),
            DVec3::new(0.1, 0.3, 0.8),
        ],
        tets: vec![[0, 1, 2, 3]],
        ..twintac_mesh::TetMesh::default()
    };
    let refined = mesh.refined();
    let parent: [u32; NODES] = std::array::from_fn(|node| match node.checked_sub(4) {
        Some(edge) => {
            let ends = EDGES[edge].map(u32::from);
            4 + refined.midpoints.iter().position(|other| *other == ends).unwrap() as u32
        }
        None => node as u32,
    });
    let children = std::array::from_fn(|child| refined.mesh.tets[child]);
    let elements = Elements::new(
        element,
        &refined.mesh.nodes_mm,
        &[0],
        &[parent],
        &[children],
        &[Side::First],
    );
    (refined.mesh.nodes_mm, elements)
}

pub(super) fn material(model: Model, prony: Vec<PronyTerm>) -> Material {
    Material {
        model,
        bulk_modulus_kpa: 1200.0,
        prony,
    }
}

/// Energy at fixed pressures, and its derivatives by the displacements.
fn energy(elements: &Elements, response: &Response, u: &[DVec3]) -> (f64, [DVec3; NODES]) {
    let (mut forces, mut volumes) = (Forces::default(), Volumes::default());
    elements.volumes(u, &mut volumes);
    elements.forces(response, u, &[CORNERS; LANES], &mut forces);
    let work: f64 = CORNERS
        .iter()
        .zip(volumes.changes_mm3[0])
        .map(|(p, g)| p * g)
        .sum();
    let mut by_node = [DVec3::ZERO; NODES];
    for node in 0..NODES {
        by_node[elements.packs[0].nodes[node][0] as usize] = forces.forces_n[0][node];
    }
    (forces.energies[0] - work, by_node)
}

/// Keeps the blocks of the first lane.
struct Keep<'a>(&'a mut Vec<(usize, usize, Mat3)>, [u32; NODES]);

impl Sink for Keep<'_> {
    fn take(&mut self, _: usize, table: &Table, blocks: &[NodeBlock], _: &[NodeSlopes; NODES]) {
        for ([a, b], block) in table.pairs.iter().zip(blocks) {
            let entry = |i: usize, j: usize| block[i][j].0[0];
            let column = |j: usize| glam::Vec3::new(entry(0, j), entry(1, j), entry(2, j));
            let [a, b] = [*a, *b].map(|node| self.1[node as usize] as usize);
            self.0
                .push((a, b, Mat3::from_cols(column(0), column(1), column(2))));
        }
    }
}

/// Keeps nothing.
struct Drop;

impl Sink for Drop {
    fn take(&mut self, _: usize, _: &Table, _: &[NodeBlock], _: &[NodeSlopes; NODES]) {}
}

/// Blocks of pairs of nodes, those of the first lane.
fn tangent(elements: &Elements, response: &Response, u: &[DVec3]) -> Vec<(usize, usize, Mat3)> {
    let mut blocks = Vec::new();
    let nodes = elements.packs[0].nodes.map(|lanes| lanes[0]);
    elements.tangents(
        response,
        u,
        &[CORNERS; LANES],
        [&mut Keep(&mut blocks, nodes), &mut Drop],
    );
    blocks
}

/// Compares forces with differences of the energy, and the tangent with differences of forces.
pub(super) fn check_derivatives(
    elements: &Elements,
    response: &Response,
    u: &[DVec3],
) -> Result<(), TestCaseError> {
    let step = 1e-5;
    let (_, forces) = energy(elements, response, u);
    let blocks = tangent(elements, response, u);
    let largest = blocks
        .iter()
        .flat_map(|(.., block)| block.to_cols_array())
        .fold(0.05_f32, |a, b| a.max(b.abs()));
    let tolerance = 6e-5 * f64::from(largest);
    for b in 0..NODES {
        for j in 0..3 {
            let moved = |sign: f64| {
                let mut u = u.to_vec();
                u[b][j] += sign * step;
                energy(elements, response, &u)
            };
            let (ahead, behind) = (moved(1.0), moved(-1.0));
            let slope = (ahead.0 - behind.0) / (2.0 * step);
            let limit = 2e-7 * f64::from(largest);
            prop_assert!((slope - forces[b][j]).abs() < limit, "{slope} {}", forces[b][j]);
            for a in 0..NODES {
                let expected = (ahead.1[a] - behind.1[a]) / (2.0 * step);
                let found = blocks
                    .iter()
                    .find_map(|(row, column, block)| match (*row, *column) {
                        (row, column) if (row, column) == (a, b) => Some(block.col(j)),
                        (row, column) if (row, column) == (b, a) => Some(block.row(j)),
                        _ => None,
                    });
                let found = found.unwrap_or_default().as_dvec3();
                prop_assert!(
                    (found - expected).length() < tolerance,
                    "{a} {b}: {found} {expected}"
                );
            }
        }
    }
    Ok(())
}

/// Three stretches, of which two or three may be equal or nearly equal.
fn stretches() -> impl Strategy<Value = [f64; 3]> {
    let apart = prop::sample::select(vec![0.0, 1e-9, 1e-6, 1e-3, 0.3]);
    (
        0.6..1.8_f64,
        prop::array::uniform3(0.0..1.0_f64),
        prop::array::uniform3(apart),
    )
        .prop_map(|(mean, part, apart)| std::array::from_fn(|i| mean * (1.0 + part[i] * apart[i])))
}

/// Displacements of a stretch along rotated axes, which is then rotated itself.
fn homogeneous(nodes_mm: &[DVec3], turns: &[[f64; 4]; 2], stretches: [f64; 3]) -> Vec<DVec3> {
    let [u, v] = turns.map(|turn| {
        let length = turn.iter().map(|x| x * x).sum::<f64>().sqrt();
        let turn = if length > 0.1 {
            turn.map(|x| x / length)
        } else {
            [0.0, 0.0, 0.0, 1.0]
        };
        DMat3::from_quat(glam::DQuat::from_array(turn))
    });
    let gradient = u * DMat3::from_diagonal(DVec3::from_array(stretches)) * v;
    nodes_mm.iter().map(|at| gradient * *at - *at).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn forces_and_tangent_are_the_slopes_of_the_energy(
        moves in prop::collection::vec(prop::array::uniform3(-0.04..0.04_f64), NODES),
        before in prop::collection::vec(prop::array::uniform3(-0.04..0.04_f64), NODES),
        element in prop_oneof![
            Just(Element::Layered), Just(Element::Composite),
            Just(Element::Blended), Just(Element::Quadratic)
        ],
    ) {
        let (_, elements) = one(element);
        let vectors = |moves: &[[f64; 3]]| moves.iter().map(|u| DVec3::from_array(*u)).collect::<Vec<_>>();
        let (u, before) = (vectors(&moves), vectors(&before));
        let term = PronyTerm { weight: 0.4, time_s: 0.5 };
        for (model, prony) in Model::examples().into_iter().flat_map(|model| [(model.clone(), vec![]), (model, vec![term])]) {
            let material = material(model, prony);
            if material.check().is_err() {
                continue;
            }
            let relaxation = Relaxation::new(&material.prony, 0.2);
            let mut history = History::new(elements.n_points(), &material.prony);
            update_history(&elements, &material, &relaxation, &before, &mut history);
            let response = Response::new(&material, 0.2, &history);
            check_derivatives(&elements, &response, &u)?;
        }
    }

    #[test]
    fn forces_and_tangent_are_slopes_where_stretches_coincide(
        [u, v] in prop::array::uniform2(prop::array::uniform4(-1.0..1.0_f64)),
        stretches in stretches(),
    ) {
        let (nodes_mm, elements) = one(Element::Composite);
        let displacements = homogeneous(&nodes_mm, &[u, v], stretches);
        for model in Model::examples() {
            let material = material(model, Vec::new());
            let history = History::default();
            let response = Response::new(&material, 0.0, &history);
            check_derivatives(&elements, &response, &displacements)?;
        }
    }

    #[test]
    fn ogden_with_exponents_of_two_is_neo_hooke_and_mooney_rivlin(
        [u, v] in prop::array::uniform2(prop::array::uniform4(-1.0..1.0_f64)),
        stretches in stretches(),
    ) {
        let (nodes_mm, elements) = one(Element::Composite);
        let displacements = homogeneous(&nodes_mm, &[u, v], stretches);
        let ogden = |terms: &[(f64, f64)]| {
            let term = |&(mu_kpa, alpha): &(f64, f64)| OgdenTerm { mu_kpa, alpha };
            Model::from(Ogden { terms: terms.iter().map(term).collect() })
        };
        for (ogden, same) in [
            (ogden(&[(23.5, 2.0)]), Model::from(NeoHookean { shear_modulus_kpa: 23.5 })),
            (ogden(&[(16.0, 2.0), (-7.0, -2.0)]), MooneyRivlin { c10_kpa: 8.0, c01_kpa: 3.5 }.into()),
        ] {
            let [found, expected] = [ogden, same].map(|model| {
                let material = material(model, Vec::new());
                let history = History::default();
                let response = Response::new(&material, 0.0, &history);
                (energy(&elements, &response, &displacements), tangent(&elements, &response, &displacements))
            });
            let scale = stretches.into_iter().fold(1.0, f64::max).powi(4) / stretches.into_iter().fold(1.0, f64::min);
            prop_assert!((found.0.0 - expected.0.0).abs() < 1e-16 * scale);
            for (found, expected) in found.0.1.iter().zip(&expected.0.1) {
                prop_assert!((*found - *expected).length() < 1e-15 * scale);
            }
            let largest = expected.1.iter().flat_map(|(.., block)| block.to_cols_array()).fold(0.0_f32, |a, b| a.max(b.abs()));
            for ((.., found), (.., expected)) in found.1.iter().zip(&expected.1) {
                prop_assert!(found.abs_diff_eq(*expected, 3e-6 * largest), "{found} {expected}");
            }
        }
    }

    #[test]
    fn a_rotated_element_is_free_of_stress(axis in prop::array::uniform3(-1.0..1.0_f64), angle in -3.0..3.0_f64) {
        let (nodes_mm, elements) = one(Element::Composite);
        let turn = DMat3::from_axis_angle(DVec3::from_array(axis).normalize_or(DVec3::X), angle);
        let u: Vec<DVec3> = nodes_mm.iter().map(|at| turn * *at - *at).collect();
        for model in Model::examples() {
            let material = material(model, Vec::new());
            let history = History::new(elements.n_points(), &[]);
            let response = Response::new(&material, 0.0, &history);
            let (mut forces, mut volumes) = (Forces::default(), Volumes::default());
            elements.volumes(&u, &mut volumes);
            elements.forces(&response, &u, &[[0.0; 4]; LANES], &mut forces);
            prop_assert!(forces.energies[0].abs() < 1e-15);
            prop_assert!(forces.forces_n[0].iter().all(|force| force.length() < 1e-14));
            prop_assert!(volumes.changes_mm3[0].iter().all(|change| change.abs() < 1e-14));
        }
    }
}

#[test]
fn coarse_tangents_are_those_of_midpoints_that_follow() {
    let (nodes_mm, elements) = one(Element::Composite);
    let material = material(Model::examples()[1].clone(), Vec::new());
    let history = History::new(elements.n_points(), &[]);
    let response = Response::new(&material, 0.0, &history);
    let gradient = DMat3::from_cols_array(&[0.1, 0.1, -0.05, 0.2, -0.1, 0.1, -0.1, 0.05, 0.02]);
    let linear = |moved: [DVec3; 4]| -> Vec<DVec3> {
        let nodes = elements.packs[0].nodes.map(|lanes| lanes[0]);
        let mut u = vec![DVec3::ZERO; NODES];
        for (local, node) in nodes.iter().enumerate() {
            let [a, b] = table::ends(local as u8);
            u[*node as usize] =
                gradient * nodes_mm[*node as usize] + 0.5 * (moved[a as usize] + moved[b as usize]);
        }
        u
    };
    let mut tangents = vec![CoarseTangent::default(); LANES];
    let mut sink = CoarseSink {
        first: 0,
        tangents: &mut tangents,
    };
    let mut rest = CoarseSink {
        first: LANES,
        tangents: &mut [],
    };
    elements.tangents(
        &response,
        &linear([DVec3::ZERO; 4]),
        &[CORNERS; LANES],
        [&mut sink, &mut rest],
    );
    let corner_force = |moved: [DVec3; 4], corner: usize| {
        let (_, forces) = energy(&elements, &response, &linear(moved));
        let nodes = elements.packs[0].nodes.map(|lanes| lanes[0]);
        let mut sum = DVec3::ZERO;
        for (local, node) in nodes.iter().enumerate() {
            for end in table::ends(local as u8) {
                if end as usize == corner {
                    sum += 0.5 * forces[*node as usize];
                }
            }
        }
        sum
    };
    let step = 1e-5;
    for a in 0..4 {
        for b in 0..=a {
            for j in 0..3 {
                let moved = |sign: f64| {
                    let mut moved = [DVec3::ZERO; 4];
                    moved[b][j] = sign * step;
                    corner_force(moved, a)
                };
                let expected = (moved(1.0) - moved(-1.0)) / (2.0 * step);
                let found = tangents[0].stiffness[a * (a + 1) / 2 + b].col(j).as_dvec3();
                assert!((found - expected).length() < 3e-6, "{a} {b}: {found} {expected}");
            }
        }
    }
}
