//! Wiring and timing of a sensor.

use crate::patience::Patience;
use crate::wiring::Wiring;

/// Wiring and timing of a [`PhysTac`](crate::PhysTac).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings<const N: usize> {
    /// The chip and the location of each taxel.
    pub wiring: Wiring<N>,
    /// Wait after the trigger for chips whose data sheet gives no conversion time, µs. Default
    /// 6000, as in public code for the CPS135B.
    pub conversion_us: u32,
    /// How long all taxels of a frame together may take beyond that. Default 56 waits of 250 µs: 20
    /// ms in total, the longest conversion of the CPS135B's family.
    pub patience: Patience,
    /// How long a channel that hung the bus stays closed before it is tried again, µs. Each further
    /// time is twice as long, up to 64 times. Default 1 s: each try of a channel that still hangs
    /// the bus costs a frame.
    pub retry_us: u32,
}

impl<const N: usize> Settings<N> {
    /// Default settings for a wiring.
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

/// Taxel `i` is a CPS135B on channel `i` of a switch at 0x70.
impl Default for Settings<8> {
    fn default() -> Self {
        Self::new(Wiring::default())
    }
}
