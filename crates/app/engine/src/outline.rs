//! The surface of an indenter for drawing: surface nets on a grid of signed distances, so that what
//! is drawn is what presses.

use std::collections::BTreeMap;

use glam::{DVec3, IVec3};
use twintac_shape::SignedDistance;

use crate::arrays::{Array, Arrays};

/// Cells along the longest side of the bounding box.
const CELLS: f64 = 48.0;

/// Number of steps that project a corner onto the surface.
const STEPS: usize = 3;

/// Writes a shape's surface into the arrays.
pub(crate) fn outline(shape: &dyn SignedDistance, arrays: &mut Arrays) {
    let (low, high) = shape.bounds_mm();
    let cell_mm = (high - low).max_element() / CELLS;
    // One cell beyond the bounds on each side closes the surface. The offset of about half a cell
    // keeps faces of the shape out of the planes of the grid.
    let origin = low - 1.47 * cell_mm;
    let counts = ((high - low) / cell_mm).ceil().as_ivec3() + 3;
    let at = |place: IVec3| origin + cell_mm * place.as_dvec3();
    let index = |place: IVec3| ((place.z * (counts.y + 1) + place.y) * (counts.x + 1) + place.x) as usize;
    let mut is_inside = Vec::with_capacity(index(counts) + 1);
    for z in 0..=counts.z {
        for y in 0..=counts.y {
            for x in 0..=counts.x {
                let distance = shape.signed_distance(at(IVec3::new(x, y, z)));
                is_inside.push(distance.distance_mm < 0.0);
            }
        }
    }
    let (mut corners, mut normals) = (Vec::new(), Vec::new());
    let mut corner_of: BTreeMap<usize, u32> = BTreeMap::new();
    let mut corner = |cell: IVec3| {
        *corner_of.entry(index(cell)).or_insert_with(|| {
            let (place, normal) = onto_surface(shape, at(cell) + 0.5 * cell_mm, cell_mm);
            corners.push(place);
            normals.push(normal);
            corners.len() as u32 - 1
        })
    };
    let mut triangles = Vec::new();
    let axes = [IVec3::X, IVec3::Y, IVec3::Z];
    for z in 1..counts.z {
        for y in 1..counts.y {
            for x in 1..counts.x {
                let here = IVec3::new(x, y, z);
                for axis in 0..3 {
                    let [along, u, v] = [axes[axis], axes[(axis + 1) % 3], axes[(axis + 2) % 3]];
                    let inside = [here, here + along].map(|place| is_inside[index(place)]);
                    if inside[0] == inside[1] {
                        continue;
                    }
                    let [a, b, c, d] = [here - u - v, here - v, here, here - u].map(&mut corner);
                    // Counter-clockwise seen from outside.
                    let quads = if inside[0] {
                        [[a, b, c], [a, c, d]]
                    } else {
                        [[a, c, b], [a, d, c]]
                    };
                    triangles.extend(quads);
                }
            }
        }
    }
    arrays.set_points(Array::OutlineMm, &corners);
    arrays.set_points(Array::OutlineNormals, &normals);
    arrays.set_indices(Array::OutlineTriangles, &triangles);
}

/// The point of the surface near a point, at most one cell away, and the normal there.
fn onto_surface(shape: &dyn SignedDistance, start: DVec3, cell_mm: f64) -> (DVec3, DVec3) {
    let mut place = start;
    for _ in 0..STEPS {
        let distance = shape.signed_distance(place);
        place -= distance.gradient * distance.distance_mm;
    }
    let moved = (place - start).clamp_length_max(cell_mm);
    let normal = shape.signed_distance(start + moved).gradient;
    (start + moved, normal)
}
