//! The start times of rounds.

/// Rounds on a grid of times, or one directly after the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    /// Time from one round to the next, µs. 0: as short as possible.
    period_us: u32,
    next_us: Option<u64>,
}

impl Pace {
    pub(crate) const fn new(period_us: u32) -> Self {
        Self {
            period_us,
            next_us: None,
        }
    }

    /// Whether rounds follow each other without a pause.
    pub(crate) const fn is_free(&self) -> bool {
        self.period_us == 0
    }

    /// Wait until the next round, µs. A round that is late by a period or more starts a new grid;
    /// missed rounds are not made up for.
    pub(crate) fn turn(&mut self, now_us: u64) -> u64 {
        if self.is_free() {
            return 0;
        }
        let period_us = u64::from(self.period_us);
        let due_us = match self.next_us {
            Some(next_us) if now_us < next_us + period_us => next_us,
            _ => now_us,
        };
        self.next_us = Some(due_us + period_us);
        due_us.saturating_sub(now_us)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_keep_their_grid_and_make_up_for_none() {
        let mut pace = Pace::new(10_000);
        assert_eq!(pace.turn(500), 0);
        assert_eq!(pace.turn(7_500), 3_000); // due at 10 500
        assert_eq!(pace.turn(21_000), 0); // due at 20 500: late, but the grid is kept
        assert_eq!(pace.turn(29_000), 1_500); // due at 30 500
        assert_eq!(pace.turn(95_000), 0); // six rounds were missed
        assert_eq!(pace.turn(96_000), 9_000);
        assert_eq!(Pace::new(0).turn(7), 0);
    }
}
