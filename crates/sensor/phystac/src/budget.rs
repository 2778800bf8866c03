//! How many frames a second a bus carries.

/// What a frame costs on the bus: nine clocks a byte, and one each for START, repeated START and STOP.
///
/// ```
/// use phystac::Budget;
///
/// let budget = Budget { n_taxels: 8, bus_hz: 400_000, conversion_us: 6000, polls: 0 };
/// assert_eq!(budget.rate_hz().round(), 125.0);
/// assert_eq!(budget.one_by_one_hz().round(), 20.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// Taxels.
    pub n_taxels: u32,
    /// The bus's clock, Hz; at most 400 000.
    pub bus_hz: u32,
    /// How long a barometer converts, µs.
    pub conversion_us: u32,
    /// How often each taxel is asked whether it has ended. [`PhysTac`](crate::PhysTac) asks at least once; 0 for one that relies on waiting.
    pub polls: u32,
}

impl Budget {
    /// Address and mask.
    const OPEN: u32 = 9 * 2 + 2;
    /// Address, register, command.
    const TRIGGER: u32 = 9 * 3 + 2;
    /// Address, register; address, byte.
    const POLL: u32 = 9 * 4 + 3;
    /// Address, register; address, five bytes.
    const READ: u32 = 9 * 8 + 3;

    /// Clocks of a frame with one trigger for all.
    #[must_use]
    pub const fn frame_clocks(&self) -> u32 {
        Self::OPEN + Self::TRIGGER + self.n_taxels * (Self::OPEN + self.polls * Self::POLL + Self::READ)
    }

    /// Time of a frame with one trigger for all, µs.
    #[must_use]
    pub fn frame_us(&self) -> f32 {
        self.conversion_us as f32 + self.clocks_us(self.frame_clocks())
    }

    /// Frames a second with one trigger for all, Hz.
    #[must_use]
    pub fn rate_hz(&self) -> f32 {
        1e6 / self.frame_us()
    }

    /// Frames a second if each taxel were triggered, awaited and read by itself, Hz.
    #[must_use]
    pub fn one_by_one_hz(&self) -> f32 {
        let clocks = Self::OPEN + Self::TRIGGER + self.polls * Self::POLL + Self::READ;
        1e6 / (self.n_taxels as f32 * (self.conversion_us as f32 + self.clocks_us(clocks)))
    }

    fn clocks_us(&self, clocks: u32) -> f32 {
        1e6 * clocks as f32 / self.bus_hz as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_of_eight_taxels() {
        // conversion, then with one trigger at 100 and 400 kHz, then one by one
        let table = [
            (2500, [94.43, 221.12], [33.42, 44.48]),
            (6000, [70.97, 124.65], [17.27, 19.81]),
            (20_000, [35.60, 45.41], [5.89, 6.15]),
        ];
        for (conversion_us, together_hz, one_by_one_hz) in table {
            for (index, bus_hz) in [100_000, 400_000].into_iter().enumerate() {
                let budget = Budget {
                    n_taxels: 8,
                    bus_hz,
                    conversion_us,
                    polls: 0,
                };
                assert_eq!(budget.frame_clocks(), 809);
                assert!((budget.rate_hz() - together_hz[index]).abs() < 0.01, "{budget:?}");
                assert!(
                    (budget.one_by_one_hz() - one_by_one_hz[index]).abs() < 0.01,
                    "{budget:?}"
                );
            }
        }
    }

    #[test]
    fn fifty_five_hertz_leave_room_and_are_out_of_reach_one_by_one() {
        let budget = Budget {
            n_taxels: 8,
            bus_hz: 400_000,
            conversion_us: 6000,
            polls: 2,
        };
        assert!(budget.rate_hz() > 1.5 * 55.0);
        assert!(Budget { polls: 0, ..budget }.one_by_one_hz() < 0.5 * 55.0);
    }
}
