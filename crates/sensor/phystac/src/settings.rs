//! How the sensor is wired, and how long its barometers take.

use crate::patience::Patience;
use crate::wiring::Wiring;

/// How a [`PhysTac`](crate::PhysTac) is wired and timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings<const N: usize> {
    /// Which chip each taxel is, and where.
    pub wiring: Wiring<N>,
    /// How long to leave a chip alone after its trigger, µs, if its data sheet does not say. Default 6000, what public code of the CPS135B
    /// waits.
    pub conversion_us: u32,
    /// How long all taxels together may take beyond that. Default 56 waits of 250 µs: 20 ms in all, the longest conversion of the CPS135B's
    /// family.
    pub patience: Patience,
    /// How long a channel that hung the bus stays closed before it is looked into again, µs. Each further time is twice as long, up to 64 times.
    /// Default 1 s: a channel that goes on hanging the bus costs a frame each time.
    pub retry_us: u32,
}

impl<const N: usize> Settings<N> {
    /// The defaults, for a wiring.
    #[must_use]
    pub fn new(wiring: Wiring<N>) -> Self {
        Self {
            wiring,
            conversion_us: 6000,
            patience: Patience {
                interval_us: 250,
                waits: 56,
            },
            retry_us: 1_000_000,
        }
    }
}

/// Taxel `i` a CPS135B on channel `i` of a switch at 0x70.
impl Default for Settings<8> {
    fn default() -> Self {
        Self::new(Wiring::default())
    }
}
