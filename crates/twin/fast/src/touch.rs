//! A body at a pose.

use twintac_shape::Pose;

/// A body at a pose relative to a sensor; it may touch the sensor or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Number of the body in the slice of bodies.
    pub body: u32,
    /// Pose of the body in the frame of the sensor's gel.
    pub gel_from_body: Pose,
}
