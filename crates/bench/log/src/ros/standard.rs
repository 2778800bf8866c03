//! Readings in the standard messages, in SI units (REP 103).

use super::header::put_header;
use super::sample::{put_quaternion, put_vector};
use crate::cdr::Encoder;
use crate::{PoseReading, TactileFrame, WrenchReading};

/// `sensor_msgs/FluidPressure` and `sensor_msgs/Temperature`, which have the same structure: a
/// number and its variance, which is 0 if unknown.
pub(super) fn put_scalar(e: &mut Encoder<'_>, unix_ns: u64, frame: &str, number: f64) {
    put_header(e, unix_ns, frame);
    e.f64(number);
    e.f64(0.0);
}

/// `std_msgs/Float32MultiArray`: the pressures of all taxels, Pa, NaN for a missing one. `label`
/// names their dimension.
pub(super) fn put_pressures(e: &mut Encoder<'_>, label: &str, frame: &TactileFrame) {
    let length = u32::try_from(frame.taxels.len()).unwrap_or(u32::MAX);
    e.sequence(std::iter::once(label), |e, label| {
        e.string(label);
        e.u32(length);
        e.u32(length);
    });
    e.u32(0); // no offset before the numbers
    e.sequence(frame.taxels.iter(), |e, taxel| {
        e.f32(taxel.pressure_pa.unwrap_or(f64::NAN) as f32);
    });
}

/// `geometry_msgs/WrenchStamped`: N and N m.
pub(super) fn put_wrench(e: &mut Encoder<'_>, unix_ns: u64, reading: &WrenchReading) {
    put_header(e, unix_ns, "wrench");
    put_vector(e, reading.force_n);
    put_vector(e, reading.torque_n_mm / 1000.0);
}

/// `geometry_msgs/PoseStamped`: m.
pub(super) fn put_pose(e: &mut Encoder<'_>, unix_ns: u64, reading: &PoseReading) {
    put_header(e, unix_ns, "base");
    put_vector(e, reading.position_mm / 1000.0);
    put_quaternion(e, reading.base_from_tool);
}
