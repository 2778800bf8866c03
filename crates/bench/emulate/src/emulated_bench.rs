//! All emulated devices together.

use serde::{Deserialize, Serialize};

use crate::fault::FaultWire;
use crate::force::{ForceServer, ForceSettings};
use crate::i2c::{Board, BoardSettings};
use crate::robot::{RobotServer, RobotSettings};
use crate::{EmulateError, LabClock, Physics, ScheduledFault, Workcell};

/// Settings of the devices and their faults. In TOML every field is optional.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct EmulatedBenchSettings {
    /// The sensor's board.
    pub board: BoardSettings,
    /// The robot.
    pub robot: RobotSettings,
    /// The force sensor.
    pub force: ForceSettings,
    /// Faults.
    pub faults: Vec<ScheduledFault>,
}

/// A sensor, a robot and a force sensor in one workcell. When it is dropped, its sockets close and
/// its threads end.
#[derive(Debug)]
pub struct EmulatedBench {
    /// The sensor's board.
    pub board: Board,
    /// The robot, on the loopback.
    pub robot: RobotServer,
    /// The force sensor, on the loopback.
    pub force: ForceServer,
    workcell: Workcell,
}

impl EmulatedBench {
    /// Switches the devices on, at the clock's present time.
    ///
    /// # Errors
    /// A setting or a fault that is not valid; a port that is in use; a thread that cannot be
    /// started.
    pub fn start(
        clock: LabClock,
        physics: impl Physics + 'static,
        settings: &EmulatedBenchSettings,
    ) -> Result<Self, EmulateError> {
        let (robot, faults) = (&settings.robot, &settings.faults);
        robot.check()?;
        let workcell = Workcell::new(clock, physics, robot.first_pose, robot.arm);
        Ok(Self {
            board: Board::new(workcell.clone(), &settings.board, faults)?,
            robot: RobotServer::start(workcell.clone(), robot.clone(), faults)?,
            force: ForceServer::start(workcell.clone(), settings.force.clone(), faults)?,
            workcell,
        })
    }

    /// Adds a fault to those of the settings. It begins at once if its moment is in the past.
    ///
    /// # Errors
    /// A fault that is not valid.
    pub fn inject(&self, fault: ScheduledFault) -> Result<(), EmulateError> {
        fault.check("fault")?;
        match fault.what.wire() {
            FaultWire::I2c => self.board.inject(fault),
            FaultWire::Robot => self.robot.with_controller(|controller| controller.inject(fault)),
            FaultWire::Force => self.force.with_sensor(|sensor| sensor.inject(fault)),
        }
        Ok(())
    }

    /// The true pose of the robot's tool and the true pressures and wrench there, without
    /// imperfections of the devices.
    #[must_use]
    pub fn workcell(&self) -> &Workcell {
        &self.workcell
    }
}
