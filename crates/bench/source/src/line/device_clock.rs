//! A microcontroller's clock, on the bench's.

/// How much faster or slower than the bench's a board's crystal or resonator may be.
const DRIFT: f64 = 1e-3;

/// What a board's times are on the bench's clock.
///
/// A frame arrives after it was read, sooner or later: the least of all delays tells the offset of the two clocks. It may grow by
/// a thousandth of the time that passes, for a board whose clock is slow.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DeviceClock {
    /// Bench's time at the board's zero, s, at a time of the board, s.
    offset: Option<(f64, f64)>,
}

impl DeviceClock {
    /// When a frame was read on the bench's clock, s, from the board's time and the bench's time at which it arrived. Not after that.
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
                // Delays of 2 ms, and now and then of up to 20.
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
