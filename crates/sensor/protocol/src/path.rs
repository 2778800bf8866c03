//! A path, in the form of the file: one indenter moves through given poses.

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};
use twintac_config::ConfigError;
use twintac_shape::Pose;

/// Largest distance of an indenter from the gel's origin, mm.
const FARTHEST_MM: f64 = 10_000.0;

/// Largest number of frames of a path.
const MOST_FRAMES: f64 = 100_000.0;

/// A path of an indenter over and into a gel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PressPath {
    /// Its purpose.
    pub summary: String,
    /// Name of the indenter in the sensor description.
    pub indenter: String,
    /// The origin of heights.
    pub zero: Zero,
    /// Frame rate between the poses, Hz. If left out, the poses themselves are the frames.
    #[serde(default)]
    pub rate_hz: Option<f64>,
    /// Poses of the indenter over time, with linear interpolation between them.
    pub poses: Vec<Waypoint>,
    /// Direction of the forces that waypoints ask for, in the gel's frame; its length does not
    /// matter. Default straight down.
    #[serde(default = "down", skip_serializing_if = "is_down")]
    pub force_direction: DVec3,
    /// Largest distance between the indenter and a pose along that direction, to either side, to
    /// reach a force, mm. Default: the gel's height.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_travel_mm: Option<f64>,
    /// Positions in the gel, besides the taxels, at which the pressure is read.
    #[serde(default)]
    pub points: Vec<Point>,
}

/// Why a path is invalid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{field}` {problem}; {hint}")]
pub struct PathError {
    /// The field, with indices from 0: `poses[2].time_s`.
    pub field: String,
    /// What is wrong; it follows the field's name.
    pub problem: String,
    /// What to do about it.
    pub hint: String,
}

impl PathError {
    fn new(field: &str, problem: &str, hint: &str) -> Self {
        Self {
            field: field.to_owned(),
            problem: problem.to_owned(),
            hint: hint.to_owned(),
        }
    }
}

/// The origin of heights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Zero {
    /// The height at which the indenter, at the location and rotation of the first pose, first
    /// touches the gel.
    Touch,
    /// The board.
    Board,
}

/// The pose of the indenter at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Waypoint {
    /// Time, s.
    pub time_s: f64,
    /// Position of the indenter's origin, mm; z counts from [`PressPath::zero`].
    pub position_mm: DVec3,
    /// Rotation from the indenter's upright pose: an axis in the gel's frame, whose length is the
    /// angle, radians.
    #[serde(default)]
    pub turn_rad: DVec3,
    /// Force on the gel along [`PressPath::force_direction`], N. The indenter moves from the given
    /// position along that direction until it presses with this force. The force changes linearly
    /// from that of the last waypoint to this one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_n: Option<f64>,
}

/// One frame of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathFrame {
    /// Time, s.
    pub time_s: f64,
    /// The pose, interpolated between the waypoints before and after; heights as in the file.
    pub pose: Pose,
    /// The fraction of the way between them, 0 to 1.
    pub part: f64,
    /// The forces that the two waypoints ask for, N.
    pub forces_n: [Option<f64>; 2],
}

fn down() -> DVec3 {
    DVec3::NEG_Z
}

fn is_down(direction: &DVec3) -> bool {
    *direction == down()
}

/// A disc parallel to the board over which the gel's pressure is averaged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// A unique name.
    pub name: String,
    /// Its centre, mm.
    pub position_mm: DVec3,
    /// Its radius, mm; 0 for a point.
    pub radius_mm: f64,
}

impl PressPath {
    /// A path through poses of the indenter in the gel's frame, each with a time, s. The poses
    /// themselves are the frames.
    #[must_use]
    pub fn through(indenter: &str, poses: impl IntoIterator<Item = (f64, Pose)>) -> Self {
        let waypoint = |(time_s, pose): (f64, Pose)| Waypoint {
            time_s,
            position_mm: pose.position_mm,
            turn_rad: pose.rotation.to_scaled_axis(),
            force_n: None,
        };
        Self {
            summary: String::new(),
            indenter: indenter.to_owned(),
            zero: Zero::Board,
            rate_hz: None,
            poses: poses.into_iter().map(waypoint).collect(),
            force_direction: down(),
            force_travel_mm: None,
            points: Vec::new(),
        }
    }

    /// Reads a path from the text of a TOML file.
    ///
    /// # Errors
    /// The first field that is wrong, with file and line.
    pub fn parse(file: &str, text: &str) -> Result<Self, ConfigError> {
        let document = twintac_config::parse::<Self>(file, text)?;
        let wrong = |wrong: PathError| document.error(&wrong.field, wrong.problem, wrong.hint);
        document.value.validate().map_err(wrong)?;
        Ok(document.value)
    }

    /// Checks this path.
    ///
    /// # Errors
    /// The first field that is wrong.
    pub fn validate(&self) -> Result<(), PathError> {
        if self.poses.is_empty() {
            return Err(PathError::new("poses", "has none", "give at least one pose"));
        }
        for (index, pose) in self.poses.iter().enumerate() {
            let numbers = [pose.position_mm.to_array(), pose.turn_rad.to_array()];
            if !pose.time_s.is_finite() || !numbers.iter().flatten().all(|number| number.is_finite()) {
                let field = format!("poses[{index}]");
                return Err(PathError::new(
                    &field,
                    "has a number that is not finite",
                    "give finite ones",
                ));
            }
            let farthest_mm = pose.position_mm.abs().max_element();
            if farthest_mm > FARTHEST_MM {
                let field = format!("poses[{index}].position_mm");
                let hint = format!("give positions within {FARTHEST_MM} mm of the gel's origin");
                return Err(PathError::new(
                    &field,
                    &format!("is {farthest_mm} mm away"),
                    &hint,
                ));
            }
        }
        for (index, pair) in self.poses.windows(2).enumerate() {
            if pair[1].time_s <= pair[0].time_s {
                let field = format!("poses[{}].time_s", index + 1);
                let problem = format!("is {} s after {} s", pair[1].time_s, pair[0].time_s);
                return Err(PathError::new(&field, &problem, "give increasing times"));
            }
        }
        if let Some(rate_hz) = self.rate_hz {
            let n_frames = rate_hz * (self.poses[self.poses.len() - 1].time_s - self.poses[0].time_s);
            if !(rate_hz > 0.0 && n_frames <= MOST_FRAMES) {
                let hint = format!("give a rate above zero that makes at most {MOST_FRAMES} frames");
                return Err(PathError::new("rate_hz", &format!("is {rate_hz} Hz"), &hint));
            }
            if self.poses.len() > 1 && n_frames < 1.0 - 1e-9 {
                let problem = format!("is {rate_hz} Hz: the path ends before its second frame");
                return Err(PathError::new(
                    "rate_hz",
                    &problem,
                    "give a higher rate, or leave it out: then each pose is a frame",
                ));
            }
        }
        for (index, force_n) in self.poses.iter().map(|pose| pose.force_n).enumerate() {
            if let Some(force_n) = force_n.filter(|force_n| !(*force_n > 0.0 && force_n.is_finite())) {
                let field = format!("poses[{index}].force_n");
                let problem = format!("is {force_n} N");
                let hint = "give a force above zero, or leave it out and give a position off the gel";
                return Err(PathError::new(&field, &problem, hint));
            }
        }
        if self.force_direction.is_finite() && self.force_direction.try_normalize().is_none() {
            return Err(PathError::new(
                "force_direction",
                "is zero",
                "give a vector of any length",
            ));
        }
        if !self.force_direction.is_finite() {
            let problem = "has a number that is not finite";
            return Err(PathError::new("force_direction", problem, "give finite ones"));
        }
        let is_travel = |travel_mm: f64| travel_mm > 0.0 && travel_mm <= FARTHEST_MM;
        if let Some(travel_mm) = self.force_travel_mm.filter(|travel_mm| !is_travel(*travel_mm)) {
            let problem = format!("is {travel_mm} mm");
            let hint = format!("give a distance above zero, {FARTHEST_MM} mm at most");
            return Err(PathError::new("force_travel_mm", &problem, &hint));
        }
        for (index, point) in self.points.iter().enumerate() {
            if !(0.0..=FARTHEST_MM).contains(&point.radius_mm) {
                let field = format!("points[{index}].radius_mm");
                let problem = format!("is {} mm", point.radius_mm);
                let hint = format!("give zero to {FARTHEST_MM}");
                return Err(PathError::new(&field, &problem, &hint));
            }
            if !point.position_mm.is_finite() {
                let field = format!("points[{index}].position_mm");
                let problem = "has a number that is not finite";
                return Err(PathError::new(&field, problem, "give finite ones"));
            }
            if self.points[..index].iter().any(|other| other.name == point.name) {
                let field = format!("points[{index}].name");
                let problem = format!("is `{}` again", point.name);
                return Err(PathError::new(&field, &problem, "name each point once"));
            }
        }
        Ok(())
    }

    /// All frames, in the order of time.
    #[must_use]
    pub fn frames(&self) -> Vec<PathFrame> {
        let Some(rate_hz) = self.rate_hz else {
            return self.poses.iter().map(|pose| self.at(pose.time_s)).collect();
        };
        let (first_s, last_s) = (self.poses[0].time_s, self.poses[self.poses.len() - 1].time_s);
        let n_frames = ((last_s - first_s) * rate_hz + 1e-9).floor() as usize + 1;
        (0..n_frames)
            .map(|frame| self.at(first_s + frame as f64 / rate_hz))
            .collect()
    }

    /// Whether any waypoint asks for a force.
    #[must_use]
    pub fn asks_for_force(&self) -> bool {
        self.poses.iter().any(|pose| pose.force_n.is_some())
    }

    /// The frame at a time from the first waypoint on. After the last waypoint it is that of the
    /// last one.
    fn at(&self, time_s: f64) -> PathFrame {
        let after = self.poses.partition_point(|pose| pose.time_s < time_s);
        let to = self.poses[after.min(self.poses.len() - 1)];
        let from = self.poses[after.saturating_sub(1)];
        let part =
            ((time_s - from.time_s) / (to.time_s - from.time_s).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let pose = match part {
            1.0 => to.pose(),
            _ => Pose {
                position_mm: from.position_mm.lerp(to.position_mm, part),
                rotation: from.pose().rotation.slerp(to.pose().rotation, part),
            },
        };
        PathFrame {
            time_s,
            pose,
            part,
            forces_n: [from.force_n, to.force_n],
        }
    }
}

impl Waypoint {
    fn pose(&self) -> Pose {
        Pose {
            position_mm: self.position_mm,
            rotation: DQuat::from_scaled_axis(self.turn_rad),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PATH: &str = r#"
summary = "down and aside"
indenter = "ball"
zero = "touch"
rate_hz = 4.0
poses = [
  { time_s = 0.0, position_mm = [0.0, 0.0, 0.0] },
  { time_s = 1.0, position_mm = [0.0, 0.0, -2.0], turn_rad = [0.2, 0.0, 0.0] },
  { time_s = 2.0, position_mm = [1.0, 0.0, -2.0] },
]
points = [{ name = "below", position_mm = [0.0, 0.0, 0.0], radius_mm = 1.0 }]
"#;

    #[test]
    fn a_rate_that_makes_one_frame_is_refused() {
        let at = |rate: &str| PressPath::parse("path.toml", &PATH.replace("rate_hz = 4.0", rate));
        let error = at("rate_hz = 0.4").unwrap_err().to_string();
        assert!(
            error.contains("`rate_hz`") && error.contains("second frame"),
            "{error}"
        );
        assert_eq!(at("rate_hz = 0.5").unwrap().frames().len(), 2);
    }

    #[test]
    fn the_indenter_moves_evenly_between_poses() {
        let frames = PressPath::parse("path.toml", PATH).unwrap().frames();
        assert_eq!(frames.len(), 9);
        let frame = frames[2];
        assert!((frame.time_s - 0.5).abs() < 1e-12);
        assert!((frame.pose.position_mm.z + 1.0).abs() < 1e-12);
        assert!((frame.pose.rotation.to_scaled_axis().x - 0.1).abs() < 1e-12);
        assert_eq!(frames[8].pose.position_mm, DVec3::new(1.0, 0.0, -2.0));
        assert_eq!(frame.forces_n, [None, None]);
    }

    #[test]
    fn frames_know_the_forces_before_and_after() {
        let text = PATH.replace("-2.0] },\n]", "-2.0], force_n = 2.0 },\n]");
        let path = PressPath::parse("path.toml", &text).unwrap();
        let frames = path.frames();
        assert!(path.asks_for_force());
        assert_eq!(frames[4].forces_n, [None, None]);
        assert_eq!(frames[5].forces_n, [None, Some(2.0)]);
        assert!((frames[5].part - 0.25).abs() < 1e-12);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (from, to, words) in [
            ("time_s = 2.0", "time_s = 0.5", "path.toml:9: `poses[2].time_s`"),
            ("rate_hz = 4.0", "rate_hz = 0.0", "path.toml:5: `rate_hz`"),
            ("rate_hz = 4.0", "rate_hz = 1e9", "path.toml:5: `rate_hz`"),
            ("rate_hz = 4.0", "rate_hz = nan", "path.toml:5: `rate_hz`"),
            (
                "rate_hz = 4.0",
                "force_travel_mm = nan",
                "path.toml:5: `force_travel_mm`",
            ),
            (
                "rate_hz = 4.0",
                "force_direction = [nan, 0.0, 1.0]",
                "path.toml:5: `force_direction[0]`",
            ),
            (
                "[1.0, 0.0, -2.0]",
                "[1.0, 0.0, -1e300]",
                "path.toml:9: `poses[2].position_mm`",
            ),
            (
                "radius_mm = 1.0",
                "radius_mm = inf",
                "path.toml:11: `points[0].radius_mm`",
            ),
            (
                "rate_hz = 4.0",
                "force_direction = [0.0, 0.0, 0.0]",
                "path.toml:5: `force_direction`",
            ),
            (
                "-2.0] },\n]",
                "-2.0], force_n = 0.0 },\n]",
                "path.toml:9: `poses[2].force_n`",
            ),
            (
                "radius_mm = 1.0",
                "radius_mm = -1.0",
                "path.toml:11: `points[0].radius_mm`",
            ),
        ] {
            let error = PressPath::parse("path.toml", &PATH.replace(from, to)).unwrap_err();
            assert!(error.to_string().starts_with(words), "{error}");
        }
    }
}
