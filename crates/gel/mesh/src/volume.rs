//! The exact volume of a gel.

use glam::DVec3;
use twintac_shape::{Solid, Surfaces};

use crate::Cuboid;

/// Volume of a solid without its inclusions, mm³. It is exact unless inclusions reach through a
/// curved surface.
#[must_use]
pub fn gel_volume_mm3(solid: &Solid, surfaces: &Surfaces, inclusions: &[Cuboid]) -> f64 {
    let (low_mm, high_mm) = solid.bounds_mm(surfaces);
    solid.volume_mm3(surfaces) - union_volume_mm3(inclusions, [low_mm, high_mm])
}

/// Volume of boxes within bounds, mm³; boxes may overlap.
fn union_volume_mm3(cuboids: &[Cuboid], [low, high]: [DVec3; 2]) -> f64 {
    let clipped: Vec<[DVec3; 2]> = cuboids
        .iter()
        .map(|c| [c.min_mm.clamp(low, high), c.max_mm.clamp(low, high)])
        .collect();
    let planes = |axis: usize| {
        let mut planes: Vec<f64> = clipped.iter().flatten().map(|corner| corner[axis]).collect();
        planes.sort_by(f64::total_cmp);
        planes.dedup();
        planes
    };
    let (xs, ys, zs) = (planes(0), planes(1), planes(2));
    let mut volume_mm3 = 0.0;
    for x in xs.windows(2) {
        for y in ys.windows(2) {
            for z in zs.windows(2) {
                let middle = 0.5 * DVec3::new(x[0] + x[1], y[0] + y[1], z[0] + z[1]);
                if clipped
                    .iter()
                    .any(|[min, max]| middle.cmpgt(*min).all() && middle.cmplt(*max).all())
                {
                    volume_mm3 += (x[1] - x[0]) * (y[1] - y[0]) * (z[1] - z[0]);
                }
            }
        }
    }
    volume_mm3
}
