//! The installation of the sensor under the robot.
//!
//! A setup is calibrated by touching the top of the gel's middle: there the robot knows the
//! position of the gel. It takes the rest from the drawing: that the sensor is level, and how far
//! below the top the board is. The *bench's frame* is the gel's frame under these assumptions;
//! poses are planned and recorded in it. The frame of a sensor that is tilted, or whose gel is
//! thicker than drawn, differs from it.

use glam::{DQuat, DVec2, DVec3};
use twintac_shape::Pose;

/// The pose of the gel in the bench's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mounting {
    bench_from_gel: Pose,
}

impl Mounting {
    /// A gel of a height that differs from its described height, on a sensor that is rotated about
    /// the bench's x and y axes about the touched point.
    pub(crate) fn new(described_height_mm: f64, height_mm: f64, [x_rad, y_rad]: [f64; 2]) -> Self {
        let rotation = DQuat::from_scaled_axis(DVec3::new(x_rad, y_rad, 0.0));
        let top_mm = |height_mm: f64| DVec3::Z * height_mm;
        Self {
            bench_from_gel: Pose {
                position_mm: top_mm(described_height_mm) - rotation * top_mm(height_mm),
                rotation,
            },
        }
    }

    /// The upward direction of the robot in the gel's frame, a unit vector.
    pub(crate) fn upwards(&self) -> DVec3 {
        self.bench_from_gel.rotation.inverse() * DVec3::Z
    }

    /// A rotation of an indenter, converted from the bench's frame to the gel's frame.
    pub(crate) fn turned(&self, bench_from_indenter: DQuat) -> DQuat {
        self.bench_from_gel.rotation.inverse() * bench_from_indenter
    }

    /// The inverse: from the gel's frame to the bench's frame.
    pub(crate) fn as_recorded(&self, gel_from_indenter: DQuat) -> DQuat {
        self.bench_from_gel.rotation * gel_from_indenter
    }

    /// The point on the robot's way down at a location of the bench, mm, that has a given height in
    /// the gel's frame, mm; in the gel's frame.
    pub(crate) fn on_the_way(&self, place_mm: DVec2, height_mm: f64) -> DVec3 {
        let start_mm = self
            .bench_from_gel
            .inverse_transform_point(place_mm.extend(height_mm));
        let upwards = self.upwards();
        start_mm + upwards * ((height_mm - start_mm.z) / upwards.z)
    }

    /// A point of the gel's frame, converted to the bench's frame, mm.
    pub(crate) fn on_the_bench(&self, point_mm: DVec3) -> DVec3 {
        self.bench_from_gel.transform_point(point_mm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_sensor_of_the_described_height_is_where_the_robot_believes_to_the_last_bit() {
        let mounting = Mounting::new(8.5, 8.5, [0.0, 0.0]);
        let point = DVec3::new(0.1, -7.3, 8.49);
        let turn = DQuat::from_rotation_z(0.7) * DQuat::from_rotation_x(0.1);
        assert_eq!(mounting.on_the_bench(point), point);
        assert_eq!(mounting.on_the_way(point.truncate(), point.z), point);
        assert_eq!(mounting.turned(turn), turn);
        assert_eq!(mounting.upwards(), DVec3::Z);
    }

    #[test]
    fn the_top_of_the_middle_is_where_the_robot_touched_it_however_tilted_and_thick() {
        let mounting = Mounting::new(8.5, 10.2, [0.03, -0.02]);
        let top = mounting.on_the_bench(DVec3::Z * 10.2);
        assert!(top.distance(DVec3::Z * 8.5) < 1e-12, "{top}");
    }

    #[test]
    fn the_way_down_is_straight_and_stands_on_its_place() {
        let mounting = Mounting::new(8.5, 8.5, [0.03, -0.02]);
        let place = DVec2::new(7.0, -3.0);
        for height_mm in [0.0, 5.0, 8.5] {
            let point = mounting.on_the_way(place, height_mm);
            assert!((point.z - height_mm).abs() < 1e-12);
            let back = mounting.on_the_bench(point);
            assert!(back.truncate().distance(place) < 1e-12, "{back}");
        }
    }
}
