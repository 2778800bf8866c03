//! What touches a sensor.

use twintac_shape::Pose;

/// A body that touches a sensor, or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Number of the body.
    pub body: u32,
    /// Where it is in the frame of the sensor's gel.
    pub gel_from_body: Pose,
}
