//! One planned press as servo poses.

use std::collections::VecDeque;
use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use twintac_protocol::PressPlan;
use twintac_rig::TcpPose;
use twintac_shape::Pose;

use crate::{PressError, PressSettings};

/// The phase of a press.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Travels above the gel.
    Travel,
    /// Moves down slowly until first touch.
    Approach,
    /// Moves down to the planned depth below first touch.
    Press,
    /// Stays at depth.
    Hold,
    /// Moves up again.
    Retreat,
}

/// A straight segment.
#[derive(Clone, Copy, Debug)]
struct Leg {
    phase: Phase,
    from: Pose,
    to: Pose,
    duration_s: f64,
}

/// The poses of one press, one for each servo period.
///
/// It has no clock: a late period does not make a step larger. Positions are those of the indenter;
/// heights count from the gel's surface at rest.
#[derive(Clone, Debug)]
pub struct Motion {
    settings: PressSettings,
    plan: PressPlan,
    legs: VecDeque<Leg>,
    elapsed_s: f64,
    at: Pose,
}

impl Motion {
    /// A press that begins with the tool at a pose.
    ///
    /// # Errors
    /// [`PressError::Plan`]: a number of the plan that is not finite, or a speed or depth that is
    /// not above zero.
    pub fn new(settings: &PressSettings, plan: &PressPlan, start: &TcpPose) -> Result<Self, PressError> {
        for (field, found, least) in [
            ("x_mm", plan.x_mm, f64::MIN),
            ("y_mm", plan.y_mm, f64::MIN),
            ("clearance_mm", plan.clearance_mm, 0.0),
            ("depth_mm", plan.depth_mm, f64::MIN_POSITIVE),
            ("speed_mm_per_s", plan.speed_mm_per_s, f64::MIN_POSITIVE),
            ("hold_s", plan.hold_s, 0.0),
        ] {
            if !(found >= least && found.is_finite()) {
                let press = plan.name.clone();
                return Err(PressError::Plan { press, field, found });
            }
        }
        let mut motion = Self {
            at: settings.placement.indenter(start),
            settings: settings.clone(),
            plan: plan.clone(),
            legs: VecDeque::new(),
            elapsed_s: 0.0,
        };
        let start = motion.at;
        let height_mm = start.position_mm.z.max(settings.travel_height_mm);
        let over = motion.over_place(height_mm);
        motion.travel_to(Pose {
            position_mm: start.position_mm.with_z(height_mm),
            ..start
        });
        motion.travel_to(over);
        motion.travel_to(motion.over_place(motion.approach_height_mm()));
        let lowest = motion.over_place(-settings.search_mm);
        motion.add(Phase::Approach, lowest, settings.approach_speed_mm_per_s);
        Ok(motion)
    }

    /// The tool's pose with the indenter at first touch, if the surface is where it is described.
    #[must_use]
    pub(crate) fn at_surface(&self) -> TcpPose {
        self.settings.placement.tool(&self.over_place(0.0))
    }

    /// The present phase. `None` at the end.
    #[must_use]
    pub fn phase(&self) -> Option<Phase> {
        self.legs.front().map(|leg| leg.phase)
    }

    /// The pose of the next servo period. `None` at the end. An approach that ends without
    /// [`touch`](Self::touch) ends the motion.
    pub(crate) fn next_pose(&mut self) -> Option<TcpPose> {
        self.elapsed_s += self.settings.servo_period_s;
        while let Some(leg) = self.legs.front()
            && self.elapsed_s >= leg.duration_s
        {
            self.at = leg.to;
            self.elapsed_s -= leg.duration_s;
            self.legs.pop_front();
        }
        let leg = self.legs.front()?;
        self.at = leg.at(self.elapsed_s);
        Some(self.settings.placement.tool(&self.at))
    }

    /// First touch, with the indenter at a height, mm. The depth counts from there. Has no effect
    /// outside of an approach.
    pub fn touch(&mut self, height_mm: f64) {
        if self.phase() != Some(Phase::Approach) {
            return;
        }
        self.legs.clear();
        self.elapsed_s = 0.0;
        let (speed_mm_per_s, hold_s) = (self.plan.speed_mm_per_s, self.plan.hold_s);
        let deepest = self.over_place(height_mm - self.plan.depth_mm);
        self.add(Phase::Press, deepest, speed_mm_per_s);
        self.legs.push_back(Leg {
            phase: Phase::Hold,
            from: deepest,
            to: deepest,
            duration_s: hold_s,
        });
        let clear_mm = height_mm.max(0.0) + self.approach_height_mm();
        self.add(Phase::Retreat, self.over_place(clear_mm), speed_mm_per_s);
        self.travel_to(self.over_place(self.settings.travel_height_mm.max(clear_mm)));
    }

    fn over_place(&self, height_mm: f64) -> Pose {
        Pose {
            position_mm: DVec3::new(self.plan.x_mm, self.plan.y_mm, height_mm),
            rotation: self.plan.rotation.normalize(),
        }
    }

    fn approach_height_mm(&self) -> f64 {
        self.settings.approach_height_mm.max(self.plan.clearance_mm)
    }

    fn end(&self) -> Pose {
        self.legs.back().map_or(self.at, |leg| leg.to)
    }

    fn add(&mut self, phase: Phase, to: Pose, speed_mm_per_s: f64) {
        let from = self.end();
        let duration_s = from.position_mm.distance(to.position_mm) / speed_mm_per_s;
        self.legs.push_back(Leg {
            phase,
            from,
            to,
            duration_s,
        });
    }

    /// Accelerates and decelerates smoothly, so that the highest speed is π/2 of the mean speed.
    fn travel_to(&mut self, to: Pose) {
        let from = self.end();
        let way_s = from.position_mm.distance(to.position_mm) / self.settings.travel_speed_mm_per_s;
        let turn_s = from.rotation.angle_between(to.rotation) / self.settings.turn_speed_rad_per_s;
        self.legs.push_back(Leg {
            phase: Phase::Travel,
            from,
            to,
            duration_s: FRAC_PI_2 * way_s.max(turn_s),
        });
    }
}

impl Leg {
    fn at(&self, elapsed_s: f64) -> Pose {
        let linear = elapsed_s / self.duration_s;
        let fraction = match self.phase {
            Phase::Travel => 0.5 - 0.5 * (PI * linear).cos(),
            _ => linear,
        };
        Pose {
            position_mm: self.from.position_mm.lerp(self.to.position_mm, fraction),
            rotation: self.from.rotation.slerp(self.to.rotation, fraction),
        }
    }
}
