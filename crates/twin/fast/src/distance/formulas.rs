//! Signed distances of simple shapes by formulas. All shapes stand on their origin.

use glam::{Vec3, Vec3A};

use super::field::Field;

/// A ball.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ball {
    pub(super) radius_mm: f32,
}

/// A box with rounded edges: a smaller box, enlarged by the radius of the edges in all directions.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RoundedBox {
    /// Half the size of the smaller box.
    pub(super) half_mm: Vec3A,
    pub(super) middle_mm: Vec3A,
    pub(super) edge_radius_mm: f32,
}

/// An upright cylinder with rounded edges: a smaller cylinder, enlarged by the radius of the edges.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RoundedCylinder {
    pub(super) radius_mm: f32,
    pub(super) half_height_mm: f32,
    pub(super) middle_mm: f32,
    pub(super) edge_radius_mm: f32,
}

impl Ball {
    pub(super) fn new(radius_mm: f64) -> Self {
        Self {
            radius_mm: radius_mm as f32,
        }
    }
}

impl RoundedBox {
    pub(super) fn new(size_mm: [f64; 3], edge_radius_mm: f64) -> Self {
        let half_mm = 0.5 * Vec3::from_array(size_mm.map(|size| size as f32));
        Self {
            half_mm: (half_mm - edge_radius_mm as f32).into(),
            middle_mm: Vec3A::new(0.0, 0.0, half_mm.z),
            edge_radius_mm: edge_radius_mm as f32,
        }
    }
}

impl RoundedCylinder {
    pub(super) fn new(radius_mm: f64, height_mm: f64, edge_radius_mm: f64) -> Self {
        Self {
            radius_mm: (radius_mm - edge_radius_mm) as f32,
            half_height_mm: (0.5 * height_mm - edge_radius_mm) as f32,
            middle_mm: 0.5 * height_mm as f32,
            edge_radius_mm: edge_radius_mm as f32,
        }
    }
}

impl Field for Ball {
    #[inline(always)]
    fn distance_mm(&self, point: Vec3A) -> f32 {
        let z = point.z - self.radius_mm;
        (point.x * point.x + point.y * point.y + z * z).sqrt() - self.radius_mm
    }
}

impl RoundedBox {
    /// The distance, mm, from how far a point is beyond the smaller box along each axis.
    #[inline(always)]
    pub(super) fn over_sides_mm(&self, beyond: Vec3A) -> f32 {
        let outside = beyond.max(Vec3A::ZERO).length();
        outside + beyond.max_element().min(0.0) - self.edge_radius_mm
    }
}

impl RoundedCylinder {
    /// The distance, mm, from how far a point is beyond the smaller cylinder's side and its ends.
    #[inline(always)]
    pub(super) fn over_sides_mm(&self, aside: f32, above: f32) -> f32 {
        let [out_aside, out_above] = [aside.max(0.0), above.max(0.0)];
        let outside = (out_aside * out_aside + out_above * out_above).sqrt();
        outside + aside.max(above).min(0.0) - self.edge_radius_mm
    }
}

impl Field for RoundedBox {
    #[inline(always)]
    fn distance_mm(&self, point: Vec3A) -> f32 {
        self.over_sides_mm((point - self.middle_mm).abs() - self.half_mm)
    }
}

impl Field for RoundedCylinder {
    #[inline(always)]
    fn distance_mm(&self, point: Vec3A) -> f32 {
        let aside = (point.x * point.x + point.y * point.y).sqrt() - self.radius_mm;
        let above = (point.z - self.middle_mm).abs() - self.half_height_mm;
        self.over_sides_mm(aside, above)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use twintac_shape::{Shape, Surfaces};

    #[test]
    fn formulas_are_exact() {
        check(&Shape::Sphere { radius_mm: 5.0 }, &Ball::new(5.0));
        let (size_mm, edge_radius_mm) = ([8.0, 6.0, 10.0], 0.8);
        check(
            &Shape::Box {
                size_mm,
                edge_radius_mm,
            },
            &RoundedBox::new(size_mm, edge_radius_mm),
        );
        let (radius_mm, height_mm) = (4.0, 10.0);
        check(
            &Shape::Cylinder {
                radius_mm,
                height_mm,
                edge_radius_mm,
            },
            &RoundedCylinder::new(radius_mm, height_mm, edge_radius_mm),
        );
    }

    fn check(shape: &Shape, formula: &impl Field) {
        let exact = shape.signed_distance_field(&Surfaces::new()).unwrap();
        for step in 0..5000 {
            let turn = |rate: f64| (f64::from(step) * rate).fract();
            let point = DVec3::new(
                14.0 * turn(0.618) - 7.0,
                14.0 * turn(0.755) - 7.0,
                14.0 * turn(0.57) - 2.0,
            );
            let exact_mm = exact.signed_distance(point).distance_mm;
            let found_mm = f64::from(formula.distance_mm(point.as_vec3a()));
            assert!(
                (found_mm - exact_mm).abs() < 1e-5,
                "{shape:?} at {point}: {found_mm}, expected {exact_mm}"
            );
        }
    }
}
