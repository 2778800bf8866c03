//! The forward model of a sensor that contact estimation needs.

use glam::DVec2;

/// Number of values that describe a press: x, y, depth, yaw.
pub(crate) const N: usize = 4;

/// An upright press of a known shape.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Press {
    /// Location of the shape's origin in the gel's plane, mm.
    pub place_mm: DVec2,
    /// Depth below first touch, mm.
    pub depth_mm: f64,
    /// Yaw (rotation about the vertical), radians.
    pub yaw_rad: f64,
}

impl Press {
    pub(crate) fn of([x, y, depth_mm, yaw_rad]: [f64; N]) -> Self {
        Self {
            place_mm: DVec2::new(x, y),
            depth_mm,
            yaw_rad,
        }
    }
}

/// The presses of a shape that are considered. A value whose smallest equals its largest is known,
/// and is not estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain {
    /// Corners of the rectangle of locations, mm.
    pub places_mm: [DVec2; 2],
    /// Smallest and largest depth below first touch, mm.
    pub depths_mm: [f64; 2],
    /// Rotation after which the shape looks the same, radians; `None` for a round shape.
    pub turn_rad: Option<f64>,
}

impl Domain {
    /// Smallest and largest value of each number.
    pub(crate) fn ranges(&self) -> [[f64; 2]; N] {
        let [low, high] = self.places_mm;
        [
            [low.x, high.x],
            [low.y, high.y],
            self.depths_mm,
            [0.0, self.turn_rad.unwrap_or(0.0)],
        ]
    }
}

/// The forward model of a sensor: its readings under known shapes.
pub trait ContactModel: Clone + Send + Sync {
    /// Number of readings of a frame.
    fn n_readings(&self) -> usize;

    /// Number of known shapes.
    fn n_shapes(&self) -> usize;

    /// The presses of a shape that are considered.
    fn domain(&self, shape: usize) -> Domain;

    /// Writes the readings under a shape, kPa above the sensor without contact, `[n_readings]`.
    /// Returns the force into the gel, N; 0 where it is not known.
    fn read(&mut self, shape: usize, press: &Press, readings_kpa: &mut [f32]) -> f64;
}
