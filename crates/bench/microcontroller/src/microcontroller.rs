//! The firmware on the emulated bus.

use std::f64::consts::PI;
use std::fmt;

use phystac::recovery::{RecoveryError, free_bus, reset_switch};
use phystac::{AtOnce, now};
use twintac_emulate::i2c::{Board, Bus};
use twintac_emulate::robot::ArmSettings;
use twintac_emulate::{LabClock, Physics, Workcell};
use twintac_firmware::{Buffer, Firmware, Node, Report, longest, rescue};
use twintac_rig::TcpPose;

use crate::lab_time::LabTime;
use crate::setup::{N_TAXELS, Setup, SetupError};

type Rescue = Box<dyn FnMut(&mut AtOnce<Bus>) -> Result<(), RecoveryError> + Send>;

/// A board that runs the firmware, without its port: the owner carries bytes to it and from it.
pub struct Microcontroller {
    firmware: Firmware<AtOnce<Bus>, AtOnce<LabClock>, LabTime, Rescue, N_TAXELS>,
    clock: LabClock,
}

impl Microcontroller {
    /// A board that is switched on at the clock's zero. `physics` gives the pressures at its chips.
    /// The tool whose pose the physics receives rests at [`tool_mm`](Setup::tool_mm), upside down.
    ///
    /// # Errors
    /// A setting or a fault that is not valid.
    pub fn new(clock: LabClock, physics: impl Physics + 'static, setup: &Setup) -> Result<Self, SetupError> {
        let tool = TcpPose {
            position_mm: setup.tool_mm.into(),
            roll_pitch_yaw_rad: [PI, 0.0, 0.0].into(),
        };
        let workcell = Workcell::new(clock.clone(), physics, tool, ArmSettings::default());
        let board = Board::new(workcell, &setup.board, &setup.faults)?;
        let node = Node::new(
            AtOnce(board.bus()),
            AtOnce(clock.clone()),
            LabTime(clock.clone()),
            rescue_of(&board, &clock, setup.is_reset_wired),
            setup.node,
        );
        Ok(Self {
            firmware: Firmware::new(node, setup.form),
            clock,
        })
    }

    /// Takes bytes that the host sent. Their commands take effect from the next round on.
    pub fn hear(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.firmware.hear(*byte));
    }

    /// Waits until the next round is due and carries it out. Returns its report and the bytes for
    /// the host.
    pub fn round(&mut self) -> (Report<N_TAXELS>, Vec<u8>) {
        let mut bytes = Buffer::<{ longest(N_TAXELS) }>::new();
        let report = now(self.firmware.round(&mut bytes));
        (report, bytes.as_bytes().to_vec())
    }

    /// The clock.
    #[must_use]
    pub const fn clock(&self) -> &LabClock {
        &self.clock
    }
}

/// How a board frees a hung bus: by clocks, and by the switch's RESET if it is wired.
fn rescue_of(board: &Board, clock: &LabClock, is_reset_wired: bool) -> Rescue {
    let (mut scl, mut sda) = board.lines();
    let mut reset = board.reset_line();
    let clock = clock.clone();
    Box::new(move |_| {
        rescue(
            || free_bus(&mut scl, &mut sda, &mut clock.clone()),
            || match is_reset_wired {
                true => reset_switch(&mut reset, &mut clock.clone()),
                false => Ok(()),
            },
        )
    })
}

impl fmt::Debug for Microcontroller {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Microcontroller")
            .field("clock", &self.clock)
            .finish_non_exhaustive()
    }
}
