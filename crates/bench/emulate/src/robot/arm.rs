//! Motion of the arm.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};
use twintac_rig::TcpPose;

use crate::EmulateError;
use crate::error::{check_not_negative, check_positive};
use crate::mix::mix_poses;

/// Tolerance within which a goal counts as reached, mm and radians.
const THERE_MM: f64 = 0.01;
const THERE_RAD: f64 = 1e-4;

/// How the arm follows its goal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ArmSettings {
    /// Time constant of a first-order lag behind the commanded pose, s.
    pub lag_s: f64,
    /// Largest speed of the tool, mm/s.
    pub max_speed_mm_per_s: f64,
    /// Largest angular speed of the tool, rad/s.
    pub max_turn_rad_per_s: f64,
}

impl Default for ArmSettings {
    /// 30 ms of lag, 1000 mm/s and half a turn a second. The lag is a guess, the speed is the
    /// manufacturer's limit.
    fn default() -> Self {
        Self {
            lag_s: 0.03,
            max_speed_mm_per_s: 1000.0,
            max_turn_rad_per_s: std::f64::consts::PI,
        }
    }
}

impl ArmSettings {
    pub(crate) fn check(&self) -> Result<(), EmulateError> {
        check_not_negative(&[("arm.lag_s", self.lag_s)])?;
        check_positive(&[
            ("arm.max_speed_mm_per_s", self.max_speed_mm_per_s),
            ("arm.max_turn_rad_per_s", self.max_turn_rad_per_s),
        ])
    }
}

/// A line to move along.
#[derive(Clone, Copy, Debug)]
struct Line {
    to: TcpPose,
    speed_mm_per_s: f64,
}

/// The arm: the pose of its tool, and its goal.
#[derive(Clone, Debug)]
pub(crate) struct Arm {
    settings: ArmSettings,
    pose: TcpPose,
    /// What it follows: the latest servo pose, or a point that moves along the lines.
    goal: TcpPose,
    lines: VecDeque<Line>,
    is_paused: bool,
}

impl Arm {
    pub(crate) fn new(pose: TcpPose, settings: ArmSettings) -> Self {
        Self {
            settings,
            pose,
            goal: pose,
            lines: VecDeque::new(),
            is_paused: false,
        }
    }

    pub(crate) fn pose(&self) -> TcpPose {
        self.pose
    }

    /// The latest goal.
    pub(crate) fn goal(&self) -> TcpPose {
        self.goal
    }

    /// Number of lines that are not finished.
    pub(crate) fn n_lines(&self) -> usize {
        self.lines.len()
    }

    pub(crate) fn is_moving(&self) -> bool {
        !self.lines.is_empty() || !self.is_there(&self.goal)
    }

    pub(crate) fn follow(&mut self, goal: TcpPose) {
        self.goal = goal;
    }

    pub(crate) fn go_along_line(&mut self, to: TcpPose, speed_mm_per_s: f64) {
        let speed_mm_per_s = speed_mm_per_s.clamp(0.1, self.settings.max_speed_mm_per_s);
        self.lines.push_back(Line { to, speed_mm_per_s });
    }

    /// Holds its position until it is resumed.
    pub(crate) fn pause(&mut self) {
        self.is_paused = true;
        self.goal = self.pose;
    }

    pub(crate) fn go_on(&mut self) {
        self.is_paused = false;
    }

    /// Holds its position and discards its lines.
    pub(crate) fn halt(&mut self) {
        self.lines.clear();
        self.is_paused = false;
        self.goal = self.pose;
    }

    pub(crate) fn advance(&mut self, step_s: f64) {
        if !self.is_paused
            && let Some(line) = self.lines.front().copied()
        {
            self.goal = nearer(
                &self.goal,
                &line.to,
                1.0,
                line.speed_mm_per_s * step_s,
                self.settings.max_turn_rad_per_s * step_s,
            );
            if self.is_there(&line.to) {
                self.lines.pop_front();
            }
        }
        let fraction = if self.settings.lag_s > 0.0 {
            -(-step_s / self.settings.lag_s).exp_m1()
        } else {
            1.0
        };
        self.pose = nearer(
            &self.pose,
            &self.goal,
            fraction,
            self.settings.max_speed_mm_per_s * step_s,
            self.settings.max_turn_rad_per_s * step_s,
        );
    }

    fn is_there(&self, goal: &TcpPose) -> bool {
        self.pose.distance_mm(goal) <= THERE_MM && self.pose.turn_rad(goal) <= THERE_RAD
    }
}

/// A pose at a fraction of the way from one pose to another, but no farther than allowed, mm and
/// radians.
fn nearer(from: &TcpPose, to: &TcpPose, fraction: f64, most_mm: f64, most_rad: f64) -> TcpPose {
    let way = fraction * from.distance_mm(to) / most_mm;
    let turn = fraction * from.turn_rad(to) / most_rad;
    mix_poses(from, to, fraction / way.max(turn).max(1.0))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn at(x_mm: f64, yaw_rad: f64) -> TcpPose {
        TcpPose {
            position_mm: DVec3::new(x_mm, 0.0, 0.0),
            roll_pitch_yaw_rad: DVec3::new(0.0, 0.0, yaw_rad),
        }
    }

    #[test]
    fn a_goal_is_approached_with_its_time_constant() {
        let mut arm = Arm::new(at(0.0, 0.0), ArmSettings::default());
        arm.follow(at(1.0, 0.0));
        for _ in 0..30 {
            arm.advance(1e-3);
        }
        assert!((arm.pose().position_mm.x - (1.0 - (-1.0_f64).exp())).abs() < 1e-12);
    }

    #[test]
    fn speeds_have_limits() {
        let mut arm = Arm::new(at(0.0, 0.0), ArmSettings::default());
        arm.follow(at(500.0, 2.0));
        arm.advance(1e-3);
        let turn_rad = arm.pose().turn_rad(&at(0.0, 0.0));
        assert!(arm.pose().position_mm.x <= 1.0 + 1e-9 && turn_rad <= 1e-3 * std::f64::consts::PI + 1e-9);
        assert!((arm.pose().position_mm.x - 1.0).abs() < 1e-9 || (turn_rad - 3.14e-3).abs() < 1e-5);
    }

    #[test]
    fn lines_are_gone_along_one_after_the_other() {
        let mut arm = Arm::new(at(0.0, 0.0), ArmSettings::default());
        arm.go_along_line(at(10.0, 0.5), 100.0);
        arm.go_along_line(at(0.0, 0.0), 100.0);
        let mut most_mm: f64 = 0.0;
        let mut steps = 0;
        while arm.is_moving() {
            arm.advance(1e-3);
            most_mm = most_mm.max(arm.pose().position_mm.x);
            steps += 1;
        }
        assert!((9.99..=10.0).contains(&most_mm), "{most_mm}");
        assert!((400..900).contains(&steps), "{steps}");
        assert!(arm.pose().distance_mm(&at(0.0, 0.0)) <= THERE_MM);
    }
}
