//! One planned press as servo poses.

use std::collections::VecDeque;
use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use twintac_protocol::PressPlan;
use twintac_rig::TcpPose;
use twintac_shape::Pose;

use crate::{PressError, PressSettings};

/// What a press is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Above the gel.
    Travel,
    /// Slowly down, until first touch.
    Approach,
    /// Down to the planned depth below first touch.
    Press,
    /// At depth.
    Hold,
    /// Up again.
    Retreat,
}

/// A straight way.
#[derive(Clone, Copy, Debug)]
struct Leg {
    phase: Phase,
    from: Pose,
    to: Pose,
    duration_s: f64,
}

/// The poses of one press, one servo period after the other.
///
/// It knows no clock: a period that comes late is no larger step. Positions are the indenter's; heights count from the gel's surface at rest.
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
    /// [`PressError::Plan`]: a number of the plan that is none, or a speed or depth that is not above zero.
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

    /// The tool's pose with the indenter at first touch, were the surface where it is described.
    #[must_use]
    pub(crate) fn at_surface(&self) -> TcpPose {
        self.settings.placement.tool(&self.over_place(0.0))
    }

    /// What comes next; `None` when there is nothing left.
    #[must_use]
    pub fn phase(&self) -> Option<Phase> {
        self.legs.front().map(|leg| leg.phase)
    }

    /// The pose of the next servo period; `None` when there is none left. An approach that ends without [`touch`](Self::touch) is the end.
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

    /// Touched, with the indenter at a height: the depth counts from there. Without effect but in an approach.
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

    /// Eased in and out, so that its highest speed is π/2 of its mean.
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
