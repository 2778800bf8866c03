//! All devices together.

use serde::{Deserialize, Serialize};

use crate::force::{ForceServer, ForceSettings};
use crate::i2c::{Board, BoardSettings};
use crate::robot::{RobotServer, RobotSettings};
use crate::{EmulateError, Fault, LabClock, Physics, Scene, Wire};

/// What the devices are like and what goes wrong with them; as TOML, everything may be left out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// The sensor's board.
    pub board: BoardSettings,
    /// The robot.
    pub robot: RobotSettings,
    /// The force sensor.
    pub force: ForceSettings,
    /// What goes wrong.
    pub faults: Vec<Fault>,
}

/// A sensor, a robot and a force sensor in one scene. Dropped, its sockets close and its threads end.
#[derive(Debug)]
pub struct Bench {
    /// The sensor's board.
    pub board: Board,
    /// The robot, on the loopback.
    pub robot: RobotServer,
    /// The force sensor, on the loopback.
    pub force: ForceServer,
    scene: Scene,
}

impl Bench {
    /// Switches the bench on, at the clock's present time.
    ///
    /// # Errors
    /// A setting or a fault that makes no sense, a port that is taken, no thread.
    pub fn start(
        clock: LabClock,
        physics: impl Physics + 'static,
        settings: &Settings,
    ) -> Result<Self, EmulateError> {
        let (robot, faults) = (&settings.robot, &settings.faults);
        robot.check()?;
        let scene = Scene::new(clock, physics, robot.first_pose, robot.arm);
        Ok(Self {
            board: Board::new(scene.clone(), &settings.board, faults)?,
            robot: RobotServer::start(scene.clone(), robot.clone(), faults)?,
            force: ForceServer::start(scene.clone(), settings.force.clone(), faults)?,
            scene,
        })
    }

    /// Something goes wrong, besides what the settings foresee: at once, if the moment is in the past.
    ///
    /// # Errors
    /// A fault that makes no sense.
    pub fn inject(&self, fault: Fault) -> Result<(), EmulateError> {
        fault.check("fault")?;
        match fault.what.wire() {
            Wire::I2c => self.board.inject(fault),
            Wire::Robot => self.robot.with_controller(|controller| controller.inject(fault)),
            Wire::Force => self.force.with_sensor(|sensor| sensor.inject(fault)),
        }
        Ok(())
    }

    /// Where the robot is and what is felt there: what no device says without its imperfections.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }
}
