//! The lab's clock as a board's.

use phystac::Clock;
use twintac_emulate::LabClock;

/// The lab's clock: the board was switched on at its zero.
#[derive(Clone, Debug)]
pub(crate) struct LabTime(pub(crate) LabClock);

impl Clock for LabTime {
    fn now_us(&self) -> u64 {
        self.0.now_us()
    }
}
