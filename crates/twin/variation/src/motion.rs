//! The motion that the shifts of all ports have in common: the pose of the sensor on its test
//! setup.

use crate::width::{Width, mean};

/// A rigid motion of ports in their plane, for small rotations.
pub(crate) struct Motion {
    pub shift_mm: [f64; 2],
    pub shift_error_mm: f64,
    pub turn_rad: f64,
    pub turn_error_rad: f64,
    /// Standard deviation of the rest of the ports' shifts along x and along y, mm.
    pub own_mm: Width,
}

impl Motion {
    /// The least-squares motion of ports at these positions; `None` for fewer than three ports, or
    /// if shifts were not fitted along both axes.
    pub(crate) fn of(shifts_mm: &[[f64; 2]], places_mm: &[[f64; 2]]) -> Option<Self> {
        let n = shifts_mm.len();
        let is_fitted = |axis: usize| shifts_mm.iter().any(|mm| mm[axis] != 0.0);
        if n < 3 || !is_fitted(0) || !is_fitted(1) {
            return None;
        }
        let middle = |of: &[[f64; 2]]| {
            [0, 1].map(|axis: usize| mean(&of.iter().map(|mm| mm[axis]).collect::<Vec<_>>()))
        };
        let (shift_mm, center_mm) = (middle(shifts_mm), middle(places_mm));
        let arms_mm = places_mm
            .iter()
            .map(|[x, y]| [x - center_mm[0], y - center_mm[1]]);
        let (mut arm_square, mut moment) = (0.0, 0.0);
        for ([x, y], [dx, dy]) in arms_mm.clone().zip(shifts_mm) {
            arm_square += x * x + y * y;
            moment += x * dy - y * dx;
        }
        let turn_rad = moment / arm_square;
        let own_mm: Vec<f64> = arms_mm
            .zip(shifts_mm)
            .flat_map(|([x, y], [dx, dy])| [dx - shift_mm[0] + turn_rad * y, dy - shift_mm[1] - turn_rad * x])
            .collect();
        // Shift and rotation take three degrees of freedom.
        let (all, freedom) = (2.0 * n as f64, (2 * n - 3) as f64);
        let own_mm = Width::about_zero(&own_mm)?.times((all / freedom).sqrt());
        Some(Self {
            shift_mm,
            shift_error_mm: own_mm.value / (n as f64).sqrt(),
            turn_rad,
            turn_error_rad: own_mm.value / arm_square.sqrt(),
            own_mm,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shift_and_a_turn_are_told_apart() {
        let places_mm = [[-12.0, -4.0], [12.0, -4.0], [-12.0, 4.0], [12.0, 4.0]];
        let shifts_mm = places_mm.map(|[x, y]| [0.3 - 0.01 * y, -0.2 + 0.01 * x]);
        let found = Motion::of(&shifts_mm, &places_mm).unwrap();
        assert!((found.shift_mm[0] - 0.3).abs() < 1e-12 && (found.shift_mm[1] + 0.2).abs() < 1e-12);
        assert!((found.turn_rad - 0.01).abs() < 1e-12 && found.own_mm.value < 1e-12);
        let in_a_row = shifts_mm.map(|[x, _]| [x, 0.0]);
        assert!(Motion::of(&in_a_row, &places_mm).is_none());
    }
}
