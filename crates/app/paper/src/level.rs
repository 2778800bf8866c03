//! Finds the tilt of the sensor under the robot, from the points where a ball first touches the
//! gel.
//!
//! A robot that has touched the gel's middle knows the height there, and assumes that the gel is
//! level. First contacts at other locations show the true tilt. Poses are then transformed from the
//! bench's frame into the gel's, by a rotation about the top of its middle.

use glam::{DMat4, DQuat, DVec3, DVec4};
use serde::Serialize;
use twintac_protocol::PressPlan;
use twintac_recording::{Press, Recording};
use twintac_run::{Change, Run};
use twintac_sensor::Sensor;
use twintac_shape::{Pose, Shape};
use twintac_work::WorkError;

use crate::experiments::Paper;

/// Range of forces in which a ball's force over depth follows Hertz closely and noise is
/// negligible, N.
const HERTZ_N: [f64; 2] = [0.05, 0.6];

/// Prior standard deviations: of a first contact, mm, and of the delay of recorded forces, s.
const TOUCH_MM: f64 = 0.02;
const LAG_S: f64 = 0.03;

/// The orientation of the gel in the bench's frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Level {
    /// Rotation of the gel about the bench's x and y axes, radians.
    pub(super) tilt_rad: [f64; 2],
    /// Height of the gel's top above the board, mm.
    top_mm: f64,
}

impl Level {
    /// Fits a plane through the heights at which the sensor's ball first touches the gel. The fit
    /// includes the delay of recorded forces, which makes a fast press seem to touch lower.
    ///
    /// # Errors
    /// Presses of a ball at fewer than three locations, or at locations in one line.
    pub(super) fn found(recording: &Recording, sensor: &Sensor) -> Result<Self, WorkError> {
        let is_ball = |press: &&Press| {
            let indenter = sensor.indenter(&press.indenter);
            indenter.is_some_and(|indenter| matches!(indenter.shape, Shape::Sphere { .. }))
        };
        let touches: Vec<Touch> = recording
            .presses
            .iter()
            .filter(is_ball)
            .filter_map(first_touch)
            .collect();
        let (mut squares, mut sums) = (DMat4::ZERO, DVec4::ZERO);
        for touch in &touches {
            let row = DVec4::new(1.0, touch.at_mm.x, touch.at_mm.y, -touch.speed_mm_per_s);
            squares += DMat4::from_cols(row * row.x, row * row.y, row * row.z, row * row.w);
            sums += row * touch.at_mm.z;
        }
        squares.w_axis.w += (TOUCH_MM / LAG_S).powi(2);
        if touches.len() < 3 || squares.determinant() < 1e-6 {
            return Err(WorkError::Input(format!(
                "a ball touches the gel at {} locations, expected three that are not on one line, to measure its tilt",
                touches.len()
            )));
        }
        let [_, along_x, along_y, _] = (squares.inverse() * sums).to_array();
        Ok(Self {
            tilt_rad: [along_y, -along_x],
            top_mm: sensor.gel.solid.bounds_mm(&sensor.surfaces).1.z,
        })
    }

    fn rotation(&self) -> DQuat {
        let [x_rad, y_rad] = self.tilt_rad;
        DQuat::from_scaled_axis(DVec3::new(x_rad, y_rad, 0.0)).inverse()
    }

    /// Transforms a pose from the bench's frame into the gel's.
    fn pose(&self, bench_from_indenter: &Pose) -> Pose {
        let (rotation, top_mm) = (self.rotation(), self.top_mm * DVec3::Z);
        Pose {
            position_mm: top_mm + rotation * (bench_from_indenter.position_mm - top_mm),
            rotation: rotation * bench_from_indenter.rotation,
        }
    }

    /// A planned press in the gel's frame: rotated. The resulting displacement along the gel, less
    /// than a hundredth of the travel, is neglected.
    pub(super) fn plan(&self, plan: &PressPlan) -> PressPlan {
        PressPlan {
            rotation: self.rotation() * plan.rotation,
            ..plan.clone()
        }
    }
}

impl Change for Level {
    /// The recording with poses in the gel's frame.
    fn changed(&self, mut recording: Recording) -> Recording {
        for press in &mut recording.presses {
            for pose in &mut press.gel_from_indenter {
                *pose = self.pose(pose);
            }
        }
        recording
    }
}

impl Paper {
    /// The orientation of the gel, from the presses of a ball.
    pub(super) fn level(&self, presses: &Run) -> Result<Level, WorkError> {
        Level::found(&presses.recording()?, &self.sensor.sensor)
    }
}

/// A first contact.
struct Touch {
    /// Position of the ball. Its height has an unknown constant offset.
    at_mm: DVec3,
    speed_mm_per_s: f64,
}

/// The ball's position at first contact: the force to the power 2/3 is proportional to the depth
/// (Hertz, 1882).
fn first_touch(press: &Press) -> Option<Touch> {
    let force_n = press.force_n.as_ref()?;
    let largest = force_n.iter().copied().fold(0.0, f64::max);
    let deepest = force_n.iter().position(|force| *force >= largest)?;
    let [low, high] = HERTZ_N;
    let frames: Vec<usize> = (0..deepest)
        .filter(|&frame| (low..high).contains(&force_n[frame]))
        .collect();
    let [first, .., last] = frames[..] else {
        return None;
    };
    let height_mm = |frame: usize| press.gel_from_indenter[frame].position_mm.z;
    let load = |frame: usize| force_n[frame].powf(2.0 / 3.0);
    let mean =
        |of: &dyn Fn(usize) -> f64| frames.iter().map(|&frame| of(frame)).sum::<f64>() / frames.len() as f64;
    let (mean_load, mean_height_mm) = (mean(&load), mean(&height_mm));
    let square = mean(&|frame| (load(frame) - mean_load).powi(2));
    let product = mean(&|frame| (load(frame) - mean_load) * (height_mm(frame) - mean_height_mm));
    let touch_mm = mean_height_mm - product / square * mean_load;
    let place_mm = press.gel_from_indenter[deepest].position_mm;
    let touch = Touch {
        at_mm: DVec3::new(place_mm.x, place_mm.y, touch_mm),
        speed_mm_per_s: (height_mm(first) - height_mm(last)) / (press.time_s[last] - press.time_s[first]),
    };
    (touch.at_mm.is_finite() && touch.speed_mm_per_s.is_finite()).then_some(touch)
}

#[cfg(test)]
mod tests {
    use super::*;
    use twintac_recording::{Control, Provenance};
    use twintac_sensor::SensorFile;

    /// Presses of a ball on a tilted gel, recorded by a robot that does not know the tilt.
    #[test]
    fn the_tilt_of_a_gel_is_found_and_taken_off() {
        let sensor = SensorFile::phystac().unwrap().sensor;
        let (top_mm, radius_mm) = (8.5, 12.5);
        let tilt = DQuat::from_scaled_axis(DVec3::new(0.02, -0.015, 0.0));
        let press = |place_mm: [f64; 2]| {
            let up = tilt * DVec3::Z;
            let top = DVec3::Z * top_mm;
            // The ball's centre is one radius above the tilted plane.
            let height_mm = |x: f64, y: f64| top.z - (up.x * x + up.y * y) / up.z + radius_mm / up.z;
            let depths = (0..60).map(|frame| 0.05 * f64::from(frame) - 0.5);
            let pose = |depth_mm: f64| {
                let [x, y] = place_mm;
                Pose::from_position(DVec3::new(x, y, height_mm(x, y) - depth_mm - radius_mm))
            };
            let n = 60;
            Press {
                name: format!("{place_mm:?}"),
                mounting: "lab".into(),
                indenter: "sphere-25".into(),
                control: Control::Pose,
                time_s: (0..n).map(f64::from).collect(),
                gel_from_indenter: depths.clone().map(pose).collect(),
                force_n: Some(depths.map(|depth_mm| 0.5 * depth_mm.max(0.0).powf(1.5)).collect()),
                taxels_kpa: vec![vec![0.0; 8]; n as usize],
                temperature_c: None,
                taxels_raw: vec![vec![0.0; 8]; n as usize],
                valid: vec![vec![true; 8]; n as usize],
            }
        };
        let places = [[-9.0, -3.0], [9.0, -3.0], [0.0, 3.0], [5.0, 1.0]];
        let mut recording = Recording {
            sensor: sensor.name.clone(),
            provenance: Provenance::Emulated,
            taxels: sensor.taxels.iter().map(|taxel| taxel.name.clone()).collect(),
            presses: places.map(press).to_vec(),
        };
        let level = Level::found(&recording, &sensor).unwrap();
        let [x_rad, y_rad] = level.tilt_rad;
        assert!(
            (x_rad - 0.02).abs() < 2e-4 && (y_rad + 0.015).abs() < 2e-4,
            "{level:?}"
        );

        let again = Level::found(&level.changed(recording.clone()), &sensor).unwrap();
        assert!(again.tilt_rad.iter().all(|tilt| tilt.abs() < 2e-4), "{again:?}");

        recording.presses.truncate(2);
        let error = Level::found(&recording, &sensor).unwrap_err().to_string();
        assert!(error.contains("at 2 locations"), "{error}");
    }
}
