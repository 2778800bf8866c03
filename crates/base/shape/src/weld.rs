//! Turns corners of triangles into vertices.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::manifold::open_edges;

/// Corners at open edges that are nearer to each other than this fraction of the surface's diagonal
/// are the same.
const TOLERANCE: f64 = 1e-5;

/// Vertices, and triangles as indices of them.
pub(crate) struct Welded {
    pub(crate) vertices_mm: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// Makes equal corners one vertex, numbered in order of appearance. Nearly equal corners become one
/// as well where edges would otherwise stay open.
///
/// Triangles that lose a corner by this are left out. So are duplicates: one of two triangles that
/// face the same way, as in a body that is listed twice, and both of two that face each other, as
/// where two bodies share a face.
pub(crate) fn weld(corners_mm: &[[DVec3; 3]]) -> Welded {
    let mut numbers = BTreeMap::new();
    let mut vertices_mm = Vec::new();
    let mut all = Vec::new();
    for corners in corners_mm {
        all.push(corners.map(|corner| {
            // Adding zero makes -0 equal to 0.
            let key = (corner + DVec3::ZERO).to_array().map(f64::to_bits);
            *numbers.entry(key).or_insert_with(|| {
                vertices_mm.push(corner);
                vertices_mm.len() as u32 - 1
            })
        }));
    }
    let triangles = single(&all);
    let open = open_edges(&triangles);
    if open.is_empty() {
        return Welded {
            vertices_mm,
            triangles,
        };
    }
    let at_open_edges = open.into_iter().flatten().collect();
    let kept = nearest_kept(&vertices_mm, &at_open_edges);
    let all: Vec<_> = all
        .iter()
        .map(|triangle| triangle.map(|vertex| kept[vertex as usize]))
        .collect();
    Welded {
        triangles: single(&all),
        vertices_mm,
    }
}

/// For each vertex its representative: itself, or the first of the given vertices within the
/// tolerance.
fn nearest_kept(vertices_mm: &[DVec3], some: &BTreeSet<u32>) -> Vec<u32> {
    let low = vertices_mm.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = vertices_mm.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let tolerance_mm = TOLERANCE * low.distance(high);
    let mut kept: Vec<u32> = (0..vertices_mm.len() as u32).collect();
    let mut cells: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
    for &vertex in some {
        let at_mm = vertices_mm[vertex as usize];
        let cell = ((at_mm - low) / tolerance_mm)
            .floor()
            .to_array()
            .map(|index| index as i64);
        let near = (0..27).find_map(|shift| {
            let around = [0, 1, 2].map(|axis| cell[axis] + shift / 3_i64.pow(axis as u32) % 3 - 1);
            let others = cells.get(&around)?;
            let is_near = |&&other: &&u32| vertices_mm[other as usize].distance(at_mm) <= tolerance_mm;
            others.iter().find(is_near).copied()
        });
        match near {
            Some(other) => kept[vertex as usize] = other,
            None => cells.entry(cell).or_default().push(vertex),
        }
    }
    kept
}

/// Triangles with three different corners, without duplicates.
fn single(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    // For the triangles with the same corners: the index of the first, and whether all face the
    // same way.
    let mut found: BTreeMap<[u32; 3], (usize, bool)> = BTreeMap::new();
    let turned = |&[a, b, c]: &[u32; 3]| {
        if a < b && a < c {
            [a, b, c]
        } else if b < c {
            [b, c, a]
        } else {
            [c, a, b]
        }
    };
    for (index, triangle) in triangles.iter().enumerate() {
        let mut sorted = *triangle;
        sorted.sort_unstable();
        let (first, is_alike) = found.entry(sorted).or_insert((index, true));
        *is_alike &= turned(&triangles[*first]) == turned(triangle);
    }
    let has_area = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    let mut kept: Vec<usize> = found
        .into_values()
        .filter(|(_, is_alike)| *is_alike)
        .map(|(first, _)| first)
        .collect();
    kept.sort_unstable();
    kept.into_iter()
        .map(|index| triangles[index])
        .filter(has_area)
        .collect()
}
