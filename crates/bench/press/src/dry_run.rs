//! Computes what a run would do.

use serde::{Deserialize, Serialize};
use twintac_protocol::PressPlan;
use twintac_rig::TcpPose;

use crate::{Motion, Phase, PressError, PressSettings};

/// What a run would do if first touch were exactly at the described surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DryRun {
    /// The presses.
    pub presses: Vec<PlannedPress>,
    /// Time of all presses and their tares, s, without changes of the indenter.
    pub duration_s: f64,
}

/// One press of a dry run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlannedPress {
    /// Name of the press.
    pub name: String,
    /// Name of the indenter.
    pub indenter: String,
    /// Time including its tare, s.
    pub duration_s: f64,
    /// The tool's poses, one for each servo period.
    pub poses: Vec<PlannedPose>,
}

/// A pose of a dry run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlannedPose {
    /// Time since the start of the run, s.
    pub time_s: f64,
    /// Whether the indenter is above the gel. The slow approach counts as above.
    pub is_above: bool,
    /// The tool's pose in the robot's base frame.
    pub tool: TcpPose,
}

/// Computes what a run would do that begins with the tool at a pose.
///
/// # Errors
/// As [`Motion::new`].
pub fn dry_run(settings: &PressSettings, plans: &[PressPlan], start: &TcpPose) -> Result<DryRun, PressError> {
    let (mut time_s, mut tool) = (0.0, *start);
    let mut presses = Vec::with_capacity(plans.len());
    for plan in plans {
        let mut motion = Motion::new(settings, plan, &tool)?;
        let begun_s = time_s;
        time_s += settings.tare_s;
        let mut poses = Vec::new();
        while let Some(pose) = motion.next_pose() {
            tool = pose;
            time_s += settings.servo_period_s;
            let is_above = matches!(motion.phase(), Some(Phase::Travel | Phase::Approach));
            poses.push(PlannedPose {
                time_s,
                is_above,
                tool,
            });
            if motion.phase() == Some(Phase::Approach)
                && settings.placement.indenter(&tool).position_mm.z <= 0.0
            {
                motion.touch(0.0);
            }
        }
        presses.push(PlannedPress {
            name: plan.name.clone(),
            indenter: plan.indenter.clone(),
            duration_s: time_s - begun_s,
            poses,
        });
    }
    Ok(DryRun {
        presses,
        duration_s: time_s,
    })
}
