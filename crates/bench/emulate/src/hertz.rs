//! A physics in closed form, for tests and trials.

use glam::DVec3;
use twintac_rig::{TcpPose, Wrench};

use crate::{MOST_TAXELS, Physics, Sensed};

/// Hertz's contact: a ball at the tool presses an elastic half-space from above.
///
/// Force `4/3 E* √R d^(3/2)`, contact radius `a = √(R d)`, contact pressure
/// `2/π E* √(d/R) √(1 - r²/a²)` at the distance `r` from the axis (Johnson, Contact Mechanics,
/// 1985, equations 3.39 and 4.22 to 4.24), with the depth `d`. Barometers lie at the surface, and
/// read the pressure of the air outside the contact.
#[derive(Clone, Debug)]
pub struct Hertz {
    /// Positions of the barometers in the robot's base frame, mm. They lie in one plane, the
    /// surface at rest.
    pub taxels_mm: Vec<DVec3>,
    /// Radius `R` of the ball, mm. Its lowest point is the tool centre point.
    pub radius_mm: f64,
    /// Plane-strain modulus `E* = E / (1 - ν²)` of the half-space, kPa.
    pub modulus_kpa: f64,
    /// Pressure of the air, kPa.
    pub air_kpa: f64,
    /// Temperature, °C.
    pub temperature_c: f64,
}

impl Default for Hertz {
    /// A ball with a radius of 20 mm on 60 kPa, over two rows of four barometers 4 mm apart, 200 mm
    /// in front of the robot and 100 mm above its base.
    fn default() -> Self {
        Self {
            taxels_mm: Vec::from_iter((0..8).map(|taxel| {
                let (row, column) = (f64::from(taxel / 4), f64::from(taxel % 4));
                DVec3::new(194.0 + 4.0 * column, -2.0 + 4.0 * row, 100.0)
            })),
            radius_mm: 20.0,
            modulus_kpa: 60.0,
            air_kpa: 101.325,
            temperature_c: 25.0,
        }
    }
}

impl Hertz {
    /// Force at a depth, N.
    #[must_use]
    pub fn force_n(&self, depth_mm: f64) -> f64 {
        let depth_mm = depth_mm.max(0.0);
        4.0 / 3.0 * 1e-3 * self.modulus_kpa * self.radius_mm.sqrt() * depth_mm.powf(1.5)
    }

    /// Contact pressure at a depth, and at a distance from the axis, kPa.
    #[must_use]
    pub fn pressure_kpa(&self, depth_mm: f64, distance_mm: f64) -> f64 {
        let depth_mm = depth_mm.max(0.0);
        let inside = 1.0 - distance_mm.powi(2) / (self.radius_mm * depth_mm).max(f64::MIN_POSITIVE);
        let peak_kpa = std::f64::consts::FRAC_2_PI * self.modulus_kpa * (depth_mm / self.radius_mm).sqrt();
        peak_kpa * inside.max(0.0).sqrt()
    }
}

impl Physics for Hertz {
    fn at(&mut self, tool: &TcpPose, _: f64) -> Sensed {
        let tip_mm = tool.position_mm;
        let surface_mm = self
            .taxels_mm
            .first()
            .map_or(f64::NEG_INFINITY, |taxel_mm| taxel_mm.z);
        let depth_mm = surface_mm - tip_mm.z;
        let force_n = DVec3::NEG_Z * self.force_n(depth_mm);
        let middle_mm = self.taxels_mm.iter().sum::<DVec3>() / self.taxels_mm.len().max(1) as f64;
        let mut taxel_pressures_kpa = [self.air_kpa; MOST_TAXELS];
        for (pressure_kpa, taxel_mm) in taxel_pressures_kpa.iter_mut().zip(&self.taxels_mm) {
            let distance_mm = (taxel_mm - tip_mm).truncate().length();
            *pressure_kpa += self.pressure_kpa(depth_mm, distance_mm);
        }
        Sensed {
            taxel_pressures_kpa,
            temperature_c: self.temperature_c,
            wrench: Wrench {
                force_n,
                torque_n_mm: (tip_mm - middle_mm).with_z(0.0).cross(force_n),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pressure_adds_up_to_the_force() {
        let hertz = Hertz::default();
        let depth_mm = 1.5;
        let step_mm = 1e-3;
        let rings = (0..6000).map(|ring| (f64::from(ring) + 0.5) * step_mm);
        let sum_n: f64 = rings
            .map(|r| 1e-3 * hertz.pressure_kpa(depth_mm, r) * std::f64::consts::TAU * r * step_mm)
            .sum();
        assert!((sum_n / hertz.force_n(depth_mm) - 1.0).abs() < 1e-4, "{sum_n}");
        assert_eq!((hertz.force_n(-1.0), hertz.pressure_kpa(-1.0, 0.0)), (0.0, 0.0));
    }
}
