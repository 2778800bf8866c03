//! The pose of the robot's tool and the values that the sensors feel there, over time.

use std::collections::VecDeque;
use std::fmt;
use std::sync::{Arc, Mutex};

use twintac_rig::TcpPose;

use crate::clock::{nanoseconds, seconds};
use crate::mix::mix_poses;
use crate::robot::{Arm, ArmSettings};
use crate::worker::locked;
use crate::{LabClock, Physics, Sensed};

/// Steps that are kept: 2 s. Barometers report the values at the time of their conversion.
const MOST_STEPS: usize = 2000;
const STEP_NS: u64 = 1_000_000;

/// State of the test setup at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Situation {
    /// Pose of the robot's tool.
    pub tool: TcpPose,
    /// Pressures, temperature and wrench at the sensors.
    pub sensed: Sensed,
}

/// The robot's arm and the physics around its tool. Clones share one workcell.
///
/// It advances in equal steps on a fixed time grid, and is interpolated linearly between them. What
/// a device reads therefore does not depend on who else has read, or when.
#[derive(Clone)]
pub struct Workcell {
    clock: LabClock,
    world: Arc<Mutex<World>>,
}

struct World {
    arm: Arm,
    physics: Box<dyn Physics>,
    /// The latest steps. The last one has the number `n_steps`.
    situations: VecDeque<Situation>,
    n_steps: u64,
}

impl Workcell {
    /// Time between two steps, s.
    pub const STEP_S: f64 = STEP_NS as f64 * 1e-9;

    /// A workcell whose arm rests at a pose. Its time is that of the clock, from zero.
    #[must_use]
    pub fn new(clock: LabClock, physics: impl Physics + 'static, tool: TcpPose, arm: ArmSettings) -> Self {
        let mut world = World {
            arm: Arm::new(tool, arm),
            physics: Box::new(physics),
            situations: VecDeque::with_capacity(MOST_STEPS),
            n_steps: 0,
        };
        world.look();
        let world = Arc::new(Mutex::new(world));
        Self { clock, world }
    }

    /// The clock.
    #[must_use]
    pub fn clock(&self) -> &LabClock {
        &self.clock
    }

    /// The present state.
    #[must_use]
    pub fn now(&self) -> Situation {
        self.at_ns(self.clock.now_ns())
    }

    /// The state at a time of the clock, s. States older than two seconds are not kept: the oldest
    /// known state is returned in their place.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Situation {
        self.at_ns(nanoseconds(time_s))
    }

    pub(crate) fn at_ns(&self, time_ns: u64) -> Situation {
        let mut world = locked(&self.world);
        world.advance(time_ns.div_ceil(STEP_NS));
        let from_end = |step: u64| (world.n_steps - step) as usize;
        let newest = world.situations.len() - 1;
        let (before, after) = (time_ns / STEP_NS, time_ns.div_ceil(STEP_NS));
        let before = &world.situations[newest.saturating_sub(from_end(before))];
        let after = &world.situations[newest.saturating_sub(from_end(after))];
        before.mix(after, (time_ns % STEP_NS) as f64 / STEP_NS as f64)
    }

    /// Gives access to the arm at a time. Changes take effect at the next step.
    pub(crate) fn steer<T>(&self, time_ns: u64, tell: impl FnOnce(&mut Arm) -> T) -> T {
        let mut world = locked(&self.world);
        world.advance(time_ns.div_ceil(STEP_NS));
        tell(&mut world.arm)
    }
}

impl World {
    fn advance(&mut self, step: u64) {
        while self.n_steps < step {
            self.n_steps += 1;
            self.arm.advance(Workcell::STEP_S);
            self.look();
        }
    }

    fn look(&mut self) {
        if self.situations.len() == MOST_STEPS {
            self.situations.pop_front();
        }
        let tool = self.arm.pose();
        let sensed = self.physics.at(&tool, seconds(self.n_steps * STEP_NS));
        self.situations.push_back(Situation { tool, sensed });
    }
}

impl Situation {
    fn mix(&self, other: &Self, fraction: f64) -> Self {
        Self {
            tool: mix_poses(&self.tool, &other.tool, fraction),
            sensed: self.sensed.mix(&other.sensed, fraction),
        }
    }
}

impl fmt::Debug for Workcell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let world = locked(&self.world);
        f.debug_struct("Workcell")
            .field("time_s", &seconds(world.n_steps * STEP_NS))
            .field("arm", &world.arm)
            .finish_non_exhaustive()
    }
}
