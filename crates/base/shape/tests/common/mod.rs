//! Triangle surfaces, and STL files of them.

#![allow(dead_code)] // each test uses some of it

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

/// A box from `-half` to `half`.
pub(crate) fn box_triangles(half: DVec3) -> Vec<[DVec3; 3]> {
    let corner = |bits: u8| {
        let sign = |bit: u8| if bits >> bit & 1 == 1 { 1.0 } else { -1.0 };
        half * DVec3::new(sign(0), sign(1), sign(2))
    };
    let sides = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    sides
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]].map(|side| side.map(corner)))
        .collect()
}

/// A ball about the origin: rings of quadrilaterals with caps.
pub(crate) fn ball_triangles(radius_mm: f64, n: u32) -> Vec<[DVec3; 3]> {
    let point = |ring: u32, step: u32| {
        let (polar, turn) = (
            PI * f64::from(ring) / f64::from(n),
            TAU * f64::from(step % (2 * n)) / f64::from(2 * n),
        );
        let pole = ring == 0 || ring == n;
        let plan = if pole {
            DVec2::ZERO
        } else {
            DVec2::from_angle(turn) * polar.sin()
        };
        radius_mm * plan.extend(polar.cos())
    };
    let quads = (0..n).flat_map(|ring| (0..2 * n).map(move |step| (ring, step)));
    quads
        .flat_map(|(ring, step)| {
            let (a, b) = (point(ring, step), point(ring + 1, step));
            let (c, d) = (point(ring + 1, step + 1), point(ring, step + 1));
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// The same triangles, moved.
pub(crate) fn moved(triangles: &[[DVec3; 3]], by_mm: DVec3) -> Vec<[DVec3; 3]> {
    triangles
        .iter()
        .map(|corners| corners.map(|corner| corner + by_mm))
        .collect()
}

/// The same triangles, facing the other way.
pub(crate) fn turned(triangles: &[[DVec3; 3]]) -> Vec<[DVec3; 3]> {
    triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

pub(crate) fn binary(triangles: &[[DVec3; 3]]) -> Vec<u8> {
    let mut bytes = b"solid is how some programs start their binary files".to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        for corner in triangle {
            for coordinate in corner.to_array() {
                bytes.extend((coordinate as f32).to_le_bytes());
            }
        }
        bytes.extend([0; 2]);
    }
    bytes
}

pub(crate) fn ascii(triangles: &[[DVec3; 3]]) -> String {
    let facets: String = triangles
        .iter()
        .map(|corners| {
            let vertices: String = corners
                .iter()
                .map(|c| format!("  vertex {} {} {}\n", c.x, c.y, c.z))
                .collect();
            format!("facet normal 0 0 0\n outer loop\n{vertices} endloop\nendfacet\n")
        })
        .collect();
    format!("solid a shape\n{facets}endsolid a shape\n")
}
