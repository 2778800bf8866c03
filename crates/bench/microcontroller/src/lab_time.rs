//! The emulator's clock as the clock of a board.

use phystac::Clock;
use twintac_emulate::LabClock;

/// The emulator's clock. The board was switched on at its zero.
#[derive(Clone, Debug)]
pub(crate) struct LabTime(pub(crate) LabClock);

impl Clock for LabTime {
    fn now_us(&self) -> u64 {
        self.0.now_us()
    }
}
