//! An indenter in a gel, moved from one frame to the next.

use std::time::Duration;

use glam::DVec3;
use twintac_protocol::{PathFrame, PressPath};
use twintac_shape::Pose;
use twintac_softbody::{Frame, Push, SolveError, State};

use crate::GelMesh;

/// A gel, and the indenter that is moved through it.
pub(crate) struct Walk {
    pub(crate) gel: GelMesh,
    pub(crate) state: State,
    direction: DVec3,
    travel_mm: f64,
    deadline: Option<Duration>,
    /// Time of the last frame, s.
    time_s: Option<f64>,
    /// How far the indenter was beyond its pose at the last frame of prescribed force, mm.
    beyond_mm: f64,
    /// Force along the direction at the last frame of prescribed pose, N.
    force_n: f64,
}

impl Walk {
    pub(crate) fn new(gel: GelMesh, path: &PressPath, height_mm: f64) -> Self {
        Self {
            state: gel.body.rest(),
            gel,
            direction: path.force_direction.normalize_or(DVec3::NEG_Z),
            travel_mm: path.force_travel_mm.unwrap_or(height_mm),
            deadline: None,
            time_s: None,
            beyond_mm: 0.0,
            force_n: 0.0,
        }
    }

    /// The same walk with a wall time for each frame.
    pub(crate) fn within(mut self, deadline: Option<Duration>) -> Self {
        self.deadline = deadline;
        self.state.answer_within(deadline);
        self
    }

    /// Releases the gel: nothing presses it, and it has no history.
    pub(crate) fn rest(&mut self) {
        self.state = self.gel.body.rest();
        self.state.answer_within(self.deadline);
        (self.time_s, self.beyond_mm, self.force_n) = (None, 0.0, 0.0);
    }

    /// Time of the last frame, s; 0 before the first.
    pub(crate) fn time_s(&self) -> f64 {
        self.time_s.unwrap_or(0.0)
    }

    /// The indenter's pose; `None` before the first frame.
    pub(crate) fn pose(&self) -> Option<Pose> {
        self.state.gel_from_indenter()
    }

    pub(crate) fn step(&mut self, to: &PathFrame) -> Result<Frame, SolveError> {
        let time_step_s = to.time_s - self.time_s.unwrap_or(to.time_s);
        let (body, indenter) = (&self.gel.body, self.gel.indenter.as_ref());
        let mut pose = to.pose;
        let frame = match to.forces_n {
            [from_n, Some(to_n)] => {
                let from_n = from_n.unwrap_or(self.force_n);
                let push = Push {
                    direction: self.direction,
                    force_n: from_n + to.part * (to_n - from_n),
                    travel_mm: self.travel_mm,
                };
                let frame = body.advance_to_force(&mut self.state, indenter, &pose, &push, time_step_s)?;
                let found_mm = self.pose().map_or(pose.position_mm, |found| found.position_mm);
                self.beyond_mm = (found_mm - pose.position_mm).dot(self.direction);
                frame
            }
            [from_n, None] => {
                if from_n.is_some() {
                    pose.position_mm += self.direction * (self.beyond_mm * (1.0 - to.part));
                }
                let frame = body.advance(&mut self.state, indenter, &pose, time_step_s)?;
                self.force_n = frame.indenter_force_n.dot(self.direction).max(0.0);
                frame
            }
        };
        self.time_s = Some(to.time_s);
        Ok(frame)
    }
}
