//! A path as people write it: one indenter through given poses.

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};
use twintac_config::{ConfigError, Document};
use twintac_shape::Pose;

/// Most frames of a path.
const MOST_FRAMES: f64 = 100_000.0;

/// A path of an indenter over and into a gel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PressPath {
    /// What the path is for.
    pub summary: String,
    /// Name of the indenter in the sensor description.
    pub indenter: String,
    /// Where heights are counted from.
    pub zero: Zero,
    /// Frames in a second between the poses, Hz; without it, the poses themselves are the frames.
    #[serde(default)]
    pub rate_hz: Option<f64>,
    /// Where the indenter is when; it moves evenly between.
    pub poses: Vec<Waypoint>,
    /// Places in the gel, other than the taxels, at which to read the pressure.
    #[serde(default)]
    pub points: Vec<Point>,
}

/// Where heights are counted from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Zero {
    /// From where the indenter, at the place and turn of the first pose, first touches the gel.
    Touch,
    /// From the board.
    Board,
}

/// Where the indenter is at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Waypoint {
    /// Time, s.
    pub time_s: f64,
    /// The indenter's origin, mm; z counts from [`PressPath::zero`].
    pub position_mm: DVec3,
    /// Turn from the indenter's upright pose: an axis in the gel's frame, its length the angle, radians.
    #[serde(default)]
    pub turn_rad: DVec3,
}

/// A disc, parallel to the board, over which the gel's pressure is averaged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// A name of its own.
    pub name: String,
    /// Its centre, mm.
    pub position_mm: DVec3,
    /// Its radius, mm; 0 for a point.
    pub radius_mm: f64,
}

impl PressPath {
    /// Reads a path from the text of a TOML file.
    ///
    /// # Errors
    /// The first field that is wrong, with file and line.
    pub fn parse(file: &str, text: &str) -> Result<Self, ConfigError> {
        let document = twintac_config::parse::<Self>(file, text)?;
        document.value.check(&document)?;
        Ok(document.value)
    }

    fn check(&self, document: &Document<Self>) -> Result<(), ConfigError> {
        if self.poses.is_empty() {
            return Err(document.error("poses", "has none", "give at least one pose"));
        }
        for (index, pair) in self.poses.windows(2).enumerate() {
            if pair[1].time_s <= pair[0].time_s {
                let field = format!("poses[{}].time_s", index + 1);
                let problem = format!("is {} s after {} s", pair[1].time_s, pair[0].time_s);
                return Err(document.error(&field, problem, "let times increase"));
            }
        }
        if let Some(rate_hz) = self.rate_hz {
            let n_frames = rate_hz * (self.poses[self.poses.len() - 1].time_s - self.poses[0].time_s);
            if rate_hz <= 0.0 || n_frames > MOST_FRAMES {
                let hint = format!("give a rate above zero that makes at most {MOST_FRAMES} frames");
                return Err(document.error("rate_hz", format!("is {rate_hz} Hz"), hint));
            }
        }
        for (index, point) in self.points.iter().enumerate() {
            if point.radius_mm < 0.0 {
                let field = format!("points[{index}].radius_mm");
                let problem = format!("is {} mm", point.radius_mm);
                return Err(document.error(&field, problem, "give zero or more"));
            }
            if self.points[..index].iter().any(|other| other.name == point.name) {
                let field = format!("points[{index}].name");
                let problem = format!("is `{}` again", point.name);
                return Err(document.error(&field, problem, "name each point once"));
            }
        }
        Ok(())
    }

    /// Times, s, and poses of all frames; heights as in the file.
    #[must_use]
    pub fn frames(&self) -> Vec<(f64, Pose)> {
        let Some(rate_hz) = self.rate_hz else {
            return self.poses.iter().map(|pose| (pose.time_s, pose.pose())).collect();
        };
        let (first_s, last_s) = (self.poses[0].time_s, self.poses[self.poses.len() - 1].time_s);
        let n_frames = ((last_s - first_s) * rate_hz + 1e-9).floor() as usize + 1;
        (0..n_frames)
            .map(|frame| {
                let time_s = first_s + frame as f64 / rate_hz;
                (time_s, self.at(time_s))
            })
            .collect()
    }

    fn at(&self, time_s: f64) -> Pose {
        let next = self.poses.partition_point(|pose| pose.time_s <= time_s);
        let Some(to) = self.poses.get(next) else {
            return self.poses[self.poses.len() - 1].pose();
        };
        let from = self.poses[next.saturating_sub(1)];
        let part =
            ((time_s - from.time_s) / (to.time_s - from.time_s).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        Pose {
            position_mm: from.position_mm.lerp(to.position_mm, part),
            rotation: from.pose().rotation.slerp(to.pose().rotation, part),
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
    fn the_indenter_moves_evenly_between_poses() {
        let frames = PressPath::parse("path.toml", PATH).unwrap().frames();
        assert_eq!(frames.len(), 9);
        let (time_s, pose) = frames[2];
        assert!((time_s - 0.5).abs() < 1e-12);
        assert!((pose.position_mm.z + 1.0).abs() < 1e-12);
        assert!((pose.rotation.to_scaled_axis().x - 0.1).abs() < 1e-12);
        assert!((frames[8].1.position_mm - DVec3::new(1.0, 0.0, -2.0)).length() < 1e-12);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (from, to, words) in [
            ("time_s = 2.0", "time_s = 0.5", "path.toml:9: `poses[2].time_s`"),
            ("rate_hz = 4.0", "rate_hz = 0.0", "path.toml:5: `rate_hz`"),
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
