//! What the inverse asks of a model of a sensor.

use glam::DVec2;

/// Numbers that say how a shape presses: x, y, depth, spin.
pub(crate) const N: usize = 4;

/// A known shape that presses upright.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Press {
    /// Place of the shape's origin in the gel's plane, mm.
    pub place_mm: DVec2,
    /// Depth below first touch, mm.
    pub depth_mm: f64,
    /// Turn about the vertical, radians.
    pub spin_rad: f64,
}

impl Press {
    pub(crate) fn of([x, y, depth_mm, spin_rad]: [f64; N]) -> Self {
        Self {
            place_mm: DVec2::new(x, y),
            depth_mm,
            spin_rad,
        }
    }
}

/// Which presses of a shape are thought of. A number whose least is its largest is known, and is not looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain {
    /// Corners of the rectangle of places, mm.
    pub places_mm: [DVec2; 2],
    /// Least and largest depth below first touch, mm.
    pub depths_mm: [f64; 2],
    /// After which turn the shape looks the same, radians; `None` for a round one.
    pub turn_rad: Option<f64>,
}

impl Domain {
    /// Least and largest of each number.
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

/// What a sensor reads of known shapes that press it.
pub trait ContactModel: Clone + Send + Sync {
    /// Readings of a frame.
    fn n_readings(&self) -> usize;

    /// Known shapes.
    fn n_shapes(&self) -> usize;

    /// Which presses of a shape are thought of.
    fn domain(&self, shape: usize) -> Domain;

    /// Writes what is read of a shape that presses, kPa above the untouched sensor, `[n_readings]`. Returns the force into the gel, N; 0 where
    /// it is not known.
    fn read(&mut self, shape: usize, press: &Press, readings_kpa: &mut [f32]) -> f64;
}
