//! A press as it is asked for.

use glam::DQuat;
use twintac_protocol::PressPlan;

/// A straight press: down to a depth, a hold, and back up. Without anything else said it is made in the middle of the gel, 1 mm deep, at
/// 2 mm/s, with no hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Press {
    pub(crate) plan: PressPlan,
}

impl Press {
    /// With one of the sensor's indenters.
    #[must_use]
    pub fn with(indenter: &str) -> Self {
        Self {
            plan: PressPlan {
                name: format!("{indenter}#1"),
                indenter: indenter.to_owned(),
                x_mm: 0.0,
                y_mm: 0.0,
                rotation: DQuat::IDENTITY,
                clearance_mm: 0.0,
                depth_mm: 1.0,
                speed_mm_per_s: 2.0,
                hold_s: 0.0,
            },
        }
    }

    /// At a place in the gel's plane, mm from its middle.
    #[must_use]
    pub fn at_mm(mut self, x_mm: f64, y_mm: f64) -> Self {
        (self.plan.x_mm, self.plan.y_mm) = (x_mm, y_mm);
        self
    }

    /// With the indenter turned about the axis of the press, radians.
    #[must_use]
    pub fn spin_rad(mut self, spin_rad: f64) -> Self {
        self.plan.rotation = DQuat::from_rotation_z(spin_rad);
        self
    }

    /// To a depth below first touch, mm.
    #[must_use]
    pub fn depth_mm(mut self, depth_mm: f64) -> Self {
        self.plan.depth_mm = depth_mm;
        self
    }

    /// Down and up at a speed, mm/s.
    #[must_use]
    pub fn speed_mm_per_s(mut self, speed_mm_per_s: f64) -> Self {
        self.plan.speed_mm_per_s = speed_mm_per_s;
        self
    }

    /// Held at full depth, s.
    #[must_use]
    pub fn hold_s(mut self, hold_s: f64) -> Self {
        self.plan.hold_s = hold_s;
        self
    }
}
