//! Presses with a given force instead of to a pose.

use glam::DVec3;
use twintac_shape::{Pose, SignedDistance};

use crate::SolveError;
use crate::body::SoftBody;
use crate::frame::Frame;
use crate::state::State;

/// First step into the body, and first step from a position where the stiffness is unknown, mm.
const FIRST_STEP_MM: f64 = 0.1;

/// A gap that counts as contact, mm.
const TOUCH_MM: f64 = 1e-3;

/// Largest ratio of a step to the previous one.
const MAX_GROWTH: f64 = 4.0;

/// Number of attempts after which the search fails.
const MAX_TRIES: u32 = 40;

/// If the missing fraction of the force is below this, or the width of the bracket in mm, the rest
/// is found in steps without duration, each from the last position. The penetration that remains
/// after a large motion changes the force by more than this; after a very small motion it does not.
const NEAR: f64 = 1e-3;

/// Allowed difference between the found force and the requested one, in units of the solver's
/// tolerance.
const TOLERANCES: f64 = 10.0;

/// A force to press with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// The direction, a unit vector in the body's frame, along which the indenter is pushed and may
    /// move.
    pub direction: DVec3,
    /// Force of the indenter on the body along this direction, N; above 0.
    pub force_n: f64,
    /// Largest distance of the indenter from its given pose, to either side along the direction,
    /// mm.
    pub travel_mm: f64,
}

impl SoftBody {
    /// Moves the indenter within a time to the position where it presses with a force: the given
    /// pose, shifted along the direction of the force. [`State::gel_from_indenter`] gives this
    /// position afterwards. The force is accurate to ten times the relative tolerance of the
    /// settings.
    ///
    /// The position is found by secant steps. Each of them is a whole solution from the state
    /// before the call, so that the history of a viscoelastic body contains one motion only. The
    /// last steps, when about a thousandth of the force is missing, start from each other.
    ///
    /// # Errors
    /// [`SolveError::ForceNotReached`] if the force is not reached within the travel, and the
    /// errors of [`SoftBody::advance`] if these stop the indenter. The state is then as it was
    /// before.
    pub fn advance_to_force(
        &self,
        state: &mut State,
        indenter: &dyn SignedDistance,
        gel_from_indenter: &Pose,
        push: &Push,
        time_step_s: f64,
    ) -> Result<Frame, SolveError> {
        push.check()?;
        self.finish(state, indenter, None, &mut 0);
        let pose_at = |offset_mm: f64| Pose {
            position_mm: gel_from_indenter.position_mm + push.direction * offset_mm,
            ..*gel_from_indenter
        };
        let farthest_mm = push.travel_mm;
        let now_mm = state.gel_from_indenter.map_or(-farthest_mm, |pose| {
            let past_mm = (pose.position_mm - gel_from_indenter.position_mm).dot(push.direction);
            past_mm.clamp(-farthest_mm, farthest_mm)
        });
        let now_n = self.indenter_force_n(state).dot(push.direction);
        let mut slope = state.stiffness_n_per_mm.filter(|_| now_n > 0.0);
        let mut next_mm = match slope {
            Some(slope) => now_mm + (push.force_n - now_n) / slope,
            None if now_n > 0.0 => now_mm,
            None => self.approach(state, indenter, &pose_at, now_mm, farthest_mm) + FIRST_STEP_MM,
        };
        let goal_n = (TOLERANCES * self.settings.tolerance * push.force_n).max(self.negligible_load_n());
        let mut search = Search {
            low: None,
            high: None,
            last: None,
        };
        let mut spare = std::mem::take(&mut state.workspace);
        let deadline = state.deadline.take();
        // The state from which the next attempt starts, and its time step.
        let (mut base, mut left_s) = (state.clone(), time_step_s);
        let mut motion = state.last.clone();
        let mut is_near = false;
        let mut iterations = 0;
        let mut failure = None;
        let mut reached_n = now_n;
        for _ in 0..MAX_TRIES {
            next_mm = next_mm.clamp(-farthest_mm, farthest_mm);
            let mut trial = base.clone();
            trial.workspace = std::mem::take(&mut spare);
            trial.last.clone_from(&motion);
            match self.advance(&mut trial, indenter, &pose_at(next_mm), left_s) {
                Ok(frame) => {
                    iterations += frame.iterations;
                    let force_n = frame.indenter_force_n.dot(push.direction);
                    let missing_n = push.force_n - force_n;
                    reached_n = force_n;
                    // Between positions that are too close, the difference of the forces is mostly
                    // that of the penetration.
                    slope = slope
                        .filter(|_| is_near)
                        .or_else(|| search.slope(next_mm, force_n))
                        .or(slope);
                    if missing_n.abs() <= goal_n {
                        trial.stiffness_n_per_mm = slope;
                        trial.deadline = deadline;
                        *state = trial;
                        return Ok(Frame { iterations, ..frame });
                    }
                    let is_at_end = next_mm == farthest_mm.copysign(missing_n);
                    motion.clone_from(&trial.last);
                    spare = std::mem::take(&mut trial.workspace);
                    if is_at_end {
                        break;
                    }
                    let tried = (next_mm, force_n);
                    next_mm = search.next(next_mm, missing_n, slope);
                    search.last = Some(tried);
                    is_near = missing_n.abs() <= NEAR * push.force_n || search.width_mm() <= NEAR;
                    if is_near {
                        (base, left_s) = (trial, 0.0);
                        (search.low, search.high) = (None, None);
                    }
                }
                Err(error) => {
                    spare = std::mem::take(&mut trial.workspace);
                    failure = Some(error);
                    let Some(between_mm) = search.retreat(next_mm, now_mm) else {
                        break;
                    };
                    next_mm = between_mm;
                }
            }
        }
        state.workspace = spare;
        state.deadline = deadline;
        Err(failure.unwrap_or(SolveError::ForceNotReached {
            wanted_n: push.force_n,
            reached_n,
            travel_mm: farthest_mm,
        }))
    }

    /// Distance that the indenter can move before a node of the boundary touches it, mm; at most
    /// `farthest_mm`.
    fn approach(
        &self,
        state: &State,
        indenter: &dyn SignedDistance,
        pose_at: &dyn Fn(f64) -> Pose,
        from_mm: f64,
        farthest_mm: f64,
    ) -> f64 {
        let mut offset_mm = from_mm;
        while offset_mm < farthest_mm {
            let pose = pose_at(offset_mm);
            let gap_mm = self
                .boundary_mm(&state.displacements_mm)
                .map(|(_, at_mm)| {
                    indenter
                        .signed_distance(pose.inverse_transform_point(at_mm))
                        .distance_mm
                })
                .fold(f64::INFINITY, f64::min);
            if gap_mm <= TOUCH_MM {
                break;
            }
            // A signed distance changes by at most the distance that its point moves.
            offset_mm += gap_mm;
        }
        offset_mm.min(farthest_mm)
    }

    /// Force of the indenter in a state, N.
    fn indenter_force_n(&self, state: &State) -> DVec3 {
        let parts = state.contacts[..state.n_indenter_parts(self)].iter();
        let forces = parts.flat_map(|contact| contact.forces_n(&self.boundary));
        forces.map(|(_, force_n)| force_n).sum()
    }
}

impl Push {
    fn check(&self) -> Result<(), SolveError> {
        let problem = |what, expected: &str, found: String| {
            Err(SolveError::Input {
                what,
                expected: expected.into(),
                found,
            })
        };
        let positive = |value: f64| value.is_finite() && value > 0.0;
        if !self.direction.is_normalized() {
            problem(
                "direction of the force",
                "a unit vector",
                self.direction.to_string(),
            )
        } else if !positive(self.force_n) {
            problem(
                "force",
                "a finite number of N above 0",
                format!("{} N", self.force_n),
            )
        } else if !positive(self.travel_mm) {
            problem(
                "travel",
                "a finite number of mm above 0",
                format!("{} mm", self.travel_mm),
            )
        } else {
            Ok(())
        }
    }
}

/// What is known of the force as a function of the travel.
struct Search {
    /// Farthest position that is not far enough, mm.
    low: Option<f64>,
    /// Nearest position that is too far, or that cannot be reached, mm.
    high: Option<f64>,
    /// Last position, mm, and its force, N.
    last: Option<(f64, f64)>,
}

impl Search {
    /// Distance between the two, mm.
    fn width_mm(&self) -> f64 {
        match (self.low, self.high) {
            (Some(low), Some(high)) => high - low,
            _ => f64::INFINITY,
        }
    }

    /// Slope of the force from the last position to this one, N/mm; `None` unless it is finite and
    /// positive.
    fn slope(&self, at_mm: f64, force_n: f64) -> Option<f64> {
        let (last_mm, last_n) = self.last?;
        let slope = (force_n - last_n) / (at_mm - last_mm);
        (slope.is_finite() && slope > 0.0).then_some(slope)
    }

    /// The next position to try after a position at which this much force is missing, mm.
    fn next(&mut self, at_mm: f64, missing_n: f64, slope: Option<f64>) -> f64 {
        let step_mm = self
            .last
            .map_or(FIRST_STEP_MM, |(last_mm, _)| (at_mm - last_mm).abs());
        let most_mm = (MAX_GROWTH * step_mm).max(FIRST_STEP_MM);
        let next_mm = match slope {
            Some(slope) => at_mm + (missing_n / slope).clamp(-most_mm, most_mm),
            None => at_mm + FIRST_STEP_MM.copysign(missing_n),
        };
        if missing_n > 0.0 {
            self.low = Some(self.low.map_or(at_mm, |low| low.max(at_mm)));
        } else {
            self.high = Some(self.high.map_or(at_mm, |high| high.min(at_mm)));
        }
        match (self.low, self.high) {
            (Some(low), Some(high)) if low < high && !(low < next_mm && next_mm < high) => 0.5 * (low + high),
            _ => next_mm,
        }
    }

    /// The next position to try after one that cannot be reached, mm; `None` if there is none.
    fn retreat(&mut self, at_mm: f64, safe_mm: f64) -> Option<f64> {
        self.high = Some(self.high.map_or(at_mm, |high| high.min(at_mm)));
        let low_mm = self.low.unwrap_or(safe_mm);
        (at_mm - low_mm > TOUCH_MM).then_some(0.5 * (low_mm + at_mm))
    }
}
