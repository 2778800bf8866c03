//! A planned press.

use glam::DQuat;
use twintac_protocol::PressPlan;

/// A straight press: down to a depth, a hold, and back up. By default it is at the origin of the
/// gel's frame, 1 mm deep, at 2 mm/s, without a hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Press {
    pub(crate) plan: PressPlan,
}

impl Press {
    /// A press with one of the sensor's indenters.
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

    /// Sets the location in the gel's frame, x and y, mm.
    #[must_use]
    pub fn at_mm(mut self, x_mm: f64, y_mm: f64) -> Self {
        (self.plan.x_mm, self.plan.y_mm) = (x_mm, y_mm);
        self
    }

    /// Sets the yaw of the indenter about the axis of the press, radians.
    #[must_use]
    pub fn yaw_rad(mut self, yaw_rad: f64) -> Self {
        self.plan.rotation = DQuat::from_rotation_z(yaw_rad);
        self
    }

    /// Sets the depth below first contact, mm.
    #[must_use]
    pub fn depth_mm(mut self, depth_mm: f64) -> Self {
        self.plan.depth_mm = depth_mm;
        self
    }

    /// Sets the speed down and up, mm/s.
    #[must_use]
    pub fn speed_mm_per_s(mut self, speed_mm_per_s: f64) -> Self {
        self.plan.speed_mm_per_s = speed_mm_per_s;
        self
    }

    /// Sets the duration of the hold at full depth, s.
    #[must_use]
    pub fn hold_s(mut self, hold_s: f64) -> Self {
        self.plan.hold_s = hold_s;
        self
    }
}
