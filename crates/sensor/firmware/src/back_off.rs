//! Waiting times after failures of the bus.

/// The wait after the second failure in a row, µs.
const FIRST_US: u64 = 10_000;
/// The longest wait, µs. The host treats a board that sends nothing for 3 s as dead.
const LONGEST_US: u64 = 1_000_000;

/// Waits that double with each failure in a row.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BackOff {
    failures: u32,
}

impl BackOff {
    /// Records a success.
    pub(crate) const fn succeed(&mut self) {
        self.failures = 0;
    }

    /// Records a failure and returns the wait before the next try, µs. A single failure causes no
    /// wait.
    pub(crate) const fn fail(&mut self) -> u64 {
        self.failures = self.failures.saturating_add(1);
        match self.failures {
            0 | 1 => 0,
            2..10 => {
                let wait_us = FIRST_US << (self.failures - 2);
                if wait_us < LONGEST_US { wait_us } else { LONGEST_US }
            }
            _ => LONGEST_US,
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;

    #[test]
    fn waits_double_up_to_a_second_and_start_anew() {
        let mut back_off = BackOff::default();
        let waits: std::vec::Vec<u64> = (0..12).map(|_| back_off.fail() / 1000).collect();
        assert_eq!(waits, [0, 10, 20, 40, 80, 160, 320, 640, 1000, 1000, 1000, 1000]);
        back_off.succeed();
        assert_eq!(back_off.fail(), 0);
        back_off.failures = u32::MAX;
        assert_eq!(back_off.fail(), LONGEST_US);
    }
}
