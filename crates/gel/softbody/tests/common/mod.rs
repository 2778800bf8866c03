//! Blocks, balls and walls for tests.
#![allow(dead_code, unused_imports)] // each test takes what it needs

use std::sync::Arc;

use glam::{DVec2, DVec3};
pub(crate) use twintac_mesh::bricks::{block, bond, even, graded, mirrored};
use twintac_shape::{Distance, Pose, SignedDistance};
use twintac_softbody::{Frame, SoftBody, State};

/// A ball whose lowest point is its origin.
pub(crate) struct Ball {
    pub(crate) radius_mm: f64,
}

impl SignedDistance for Ball {
    fn signed_distance(&self, point_mm: DVec3) -> Distance {
        let from_center = point_mm - DVec3::Z * self.radius_mm;
        let distance_mm = from_center.length() - self.radius_mm;
        Distance {
            distance_mm,
            gradient: from_center.normalize_or(DVec3::Z),
        }
    }

    fn bounds_mm(&self) -> (DVec3, DVec3) {
        let r = DVec3::splat(self.radius_mm);
        (DVec3::Z * self.radius_mm - r, DVec3::Z * self.radius_mm + r)
    }
}

/// Everything behind an upright plane.
pub(crate) struct Wall {
    /// From the wall to the gel, a unit vector.
    pub(crate) inwards: DVec3,
    pub(crate) from_origin_mm: f64,
}

impl SignedDistance for Wall {
    fn signed_distance(&self, point_mm: DVec3) -> Distance {
        Distance {
            distance_mm: self.inwards.dot(point_mm) + self.from_origin_mm,
            gradient: self.inwards,
        }
    }

    fn bounds_mm(&self) -> (DVec3, DVec3) {
        (DVec3::NEG_INFINITY, DVec3::INFINITY)
    }
}

/// The body between four walls around the z axis.
pub(crate) fn walled(body: SoftBody, half_mm: [f64; 2]) -> SoftBody {
    let [x_mm, y_mm] = half_mm;
    [
        (DVec3::X, x_mm),
        (DVec3::NEG_X, x_mm),
        (DVec3::Y, y_mm),
        (DVec3::NEG_Y, y_mm),
    ]
    .into_iter()
    .fold(body, |body, (inwards, from_origin_mm)| {
        let wall = Wall {
            inwards,
            from_origin_mm,
        };
        body.with_obstacle(Arc::new(wall), Pose::IDENTITY)
    })
}

/// Presses straight down, from the height at which the origin touches.
pub(crate) fn press(
    body: &SoftBody,
    state: &mut State,
    indenter: &dyn SignedDistance,
    top_mm: f64,
    depth_mm: f64,
) -> Result<Frame, twintac_softbody::SolveError> {
    body.advance(
        state,
        indenter,
        &Pose::from_position(DVec3::Z * (top_mm - depth_mm)),
        0.0,
    )
}

/// Mean over a disc of a nodal field on the bottom of a block with these lines, by bilinear
/// interpolation.
pub(crate) fn disc_mean(x_mm: &[f64], y_mm: &[f64], field: &[f64], at_mm: [f64; 2], radius_mm: f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for i in -20..=20 {
        for j in -20..=20 {
            let (dx, dy) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
            if dx * dx + dy * dy <= 1.0 {
                let (x, y) = (at_mm[0] + dx * radius_mm, at_mm[1] + dy * radius_mm);
                let cell = |lines: &[f64], at: f64| {
                    let i = lines
                        .partition_point(|line| *line <= at)
                        .clamp(1, lines.len() - 1)
                        - 1;
                    (i, (at - lines[i]) / (lines[i + 1] - lines[i]))
                };
                let ((i, s), (j, t)) = (cell(x_mm, x), cell(y_mm, y));
                let value = |i: usize, j: usize| field[i + x_mm.len() * j];
                sum += (1.0 - s) * (1.0 - t) * value(i, j)
                    + s * (1.0 - t) * value(i + 1, j)
                    + (1.0 - s) * t * value(i, j + 1)
                    + s * t * value(i + 1, j + 1);
                count += 1.0;
            }
        }
    }
    sum / count
}

/// A nodal field at the bottom nodes, x fastest, for positions that are nodes.
pub(crate) fn by_place(body: &SoftBody, nodal: &[f64], x: &[f64], y: &[f64]) -> Vec<f64> {
    let at = |places: &[f64], value: f64| places.iter().position(|place| (place - value).abs() < 1e-9);
    let mut found = vec![f64::NAN; x.len() * y.len()];
    for (node, value) in body.mesh().nodes_mm.iter().zip(nodal) {
        if node.z == 0.0
            && let (Some(i), Some(j)) = (at(x, node.x), at(y, node.y))
        {
            found[j * x.len() + i] = *value;
        }
    }
    found
}
