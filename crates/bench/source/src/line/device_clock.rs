//! Converts the clock of a microcontroller to the bench clock.

/// Largest relative rate error of a board's crystal or resonator against the bench clock.
const DRIFT: f64 = 1e-3;

/// Converts times of a board to the bench clock.
///
/// A frame arrives some delay after it was read. The smallest delay so far gives the offset of the
/// two clocks. The offset may grow by a thousandth of the elapsed time, to follow a board whose
/// clock is slow.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DeviceClock {
    /// Bench time at the board's zero, s, and the board's time for which it was computed, s.
    offset: Option<(f64, f64)>,
}

impl DeviceClock {
    /// The bench time at which a frame was read, s, from the board's time and from the bench time
    /// of its arrival. It is never later than the arrival.
    pub(super) fn bench_s(&mut self, time_s: f64, arrived_s: f64) -> f64 {
        let now_s = arrived_s - time_s;
        let offset_s = match self.offset {
            None => now_s,
            Some((offset_s, at_s)) => now_s.min(offset_s + DRIFT * (time_s - at_s).max(0.0)),
        };
        self.offset = Some((offset_s, time_s));
        time_s + offset_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn late_arrivals_do_not_shift_times() {
        for rate in [1.0 - 2e-4, 1.0, 1.0 + 2e-4] {
            let mut clock = DeviceClock::default();
            let mut worst_s: f64 = 0.0;
            for frame in 0..20_000 {
                let true_s = 10.0 + 0.01 * f64::from(frame);
                // Delays of 2 ms, and sometimes up to 20 ms.
                let delay_s = 0.002 + 0.001 * f64::from(frame * 7 % 19);
                let bench_s = clock.bench_s(true_s * rate + 1234.5, true_s + delay_s);
                if frame > 100 {
                    worst_s = worst_s.max((bench_s - true_s - 0.002).abs());
                }
            }
            assert!(worst_s < 0.001, "{rate}: {worst_s} s");
        }
    }
}
