//! Numbers in the byte order that the robot uses for them.

use glam::DVec3;

use crate::TcpPose;

/// Little-endian floats from offset `at`, if the bytes reach that far.
pub(super) fn f32s<const N: usize>(bytes: &[u8], at: usize) -> Option<[f32; N]> {
    let bytes = bytes.get(at..at + 4 * N)?;
    let (words, _) = bytes.as_chunks::<4>();
    let mut numbers = [0.0; N];
    for (number, word) in numbers.iter_mut().zip(words) {
        *number = f32::from_le_bytes(*word);
    }
    Some(numbers)
}

/// Writes little-endian floats from offset `at`, as far as the bytes reach.
pub(super) fn put_f32s(bytes: &mut [u8], at: usize, numbers: &[f32]) {
    let places = bytes.get_mut(at..).unwrap_or_default().chunks_exact_mut(4);
    for (place, number) in places.zip(numbers) {
        place.copy_from_slice(&number.to_le_bytes());
    }
}

/// A pose of three lengths, mm, and three angles, radians.
pub(super) fn pose([x, y, z, roll, pitch, yaw]: [f32; 6]) -> TcpPose {
    TcpPose {
        position_mm: DVec3::new(x.into(), y.into(), z.into()),
        roll_pitch_yaw_rad: DVec3::new(roll.into(), pitch.into(), yaw.into()),
    }
}

/// The six numbers of a pose in single precision, as the robot uses them.
pub(super) fn pose_f32s(pose: &TcpPose) -> [f32; 6] {
    let (position, angles) = (pose.position_mm, pose.roll_pitch_yaw_rad);
    [position.x, position.y, position.z, angles.x, angles.y, angles.z].map(|number| number as f32)
}
