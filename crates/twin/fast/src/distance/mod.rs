//! Distances to a rigid shape: hundreds of evaluations take a microsecond.

mod field;
mod formulas;
mod open;
mod samples;
mod thickness;
mod upward;

use glam::Vec3;
use twintac_shape::{Shape, ShapeError, Surfaces};

pub(crate) use field::{Field, REACH_MM};
use formulas::{Ball, RoundedBox, RoundedCylinder};
use samples::Samples;
pub(crate) use upward::Upward;

/// A rigid shape, prepared for fast distances: balls, boxes and cylinders by formulas, any other
/// shape by samples on a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    pub(crate) form: Form,
    /// Corners of the shape's bounding box in its own frame, mm.
    pub(crate) bounds_mm: [Vec3; 2],
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Form {
    Ball(Ball),
    Box(RoundedBox),
    Cylinder(RoundedCylinder),
    Sampled(Samples),
}

impl Body {
    /// Prepares a shape. Sampling a shape without a formula takes from a millisecond to a second,
    /// the latter for a surface of many triangles.
    ///
    /// # Errors
    /// A shape that cannot exist.
    pub fn new(shape: &Shape, surfaces: &Surfaces) -> Result<Self, ShapeError> {
        let exact = shape.signed_distance_field(surfaces)?;
        let (low, high) = exact.bounds_mm();
        let form = match *shape {
            Shape::Sphere { radius_mm } => Form::Ball(Ball::new(radius_mm)),
            Shape::Box {
                size_mm,
                edge_radius_mm,
            } => Form::Box(RoundedBox::new(size_mm, edge_radius_mm)),
            Shape::Cylinder {
                radius_mm,
                height_mm,
                edge_radius_mm,
            } => Form::Cylinder(RoundedCylinder::new(radius_mm, height_mm, edge_radius_mm)),
            _ => Form::Sampled(Samples::of(exact.as_ref())),
        };
        Ok(Self {
            form,
            bounds_mm: [low.as_vec3(), high.as_vec3()],
        })
    }

    /// Half of the body's smallest thickness, mm.
    pub(crate) fn half_thickness_mm(&self) -> f32 {
        let [low, high] = self.bounds_mm;
        match &self.form {
            Form::Sampled(samples) => samples.half_thickness_mm(),
            Form::Ball(_) | Form::Box(_) | Form::Cylinder(_) => 0.5 * (high - low).min_element(),
        }
    }

    /// Whether a point at this depth inside the body, mm, may be nearer to the body's top than to
    /// its lower side.
    pub(crate) fn is_thin(&self, depth_mm: f32, upward: Upward) -> bool {
        let is_thin = depth_mm > self.half_thickness_mm();
        match &self.form {
            Form::Sampled(samples) => is_thin && samples.is_thin(depth_mm, upward),
            Form::Ball(_) | Form::Box(_) | Form::Cylinder(_) => is_thin,
        }
    }

    /// Bytes of memory that the body takes.
    #[must_use]
    pub fn n_bytes(&self) -> usize {
        let samples = match &self.form {
            Form::Sampled(samples) => samples.n_bytes(),
            Form::Ball(_) | Form::Box(_) | Form::Cylinder(_) => 0,
        };
        size_of::<Self>() + samples
    }
}
