//! One clock for the whole test setup.

use std::time::Instant;

/// The monotonic clock of the test setup: seconds since it was started. Copies read the same clock.
#[derive(Clone, Copy, Debug)]
pub struct BenchClock {
    start: Instant,
}

impl BenchClock {
    /// Starts a clock at zero.
    #[must_use]
    pub fn start() -> Self {
        Self {
            start: Instant::now(),
        }
    }

    /// Time since the start, s.
    #[must_use]
    pub fn now_s(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// Time since the start, µs.
    #[must_use]
    pub fn now_us(&self) -> u64 {
        self.start.elapsed().as_micros() as u64 // 584 thousand years
    }

    /// A stamp with the present time and `source_s`, the time of the source's own clock.
    #[must_use]
    pub fn stamp(&self, source_s: Option<f64>) -> Stamp {
        Stamp {
            bench_s: self.now_s(),
            source_s,
        }
    }
}

/// When something was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stamp {
    /// When it arrived, on the bench clock, s.
    pub bench_s: f64,
    /// When it was measured, on the source's own clock, s, if the source has one. That clock has
    /// its own zero and its own rate.
    pub source_s: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_read_one_clock_that_never_goes_back() {
        let clock = BenchClock::start();
        let copy = clock;
        let times: Vec<f64> = (0..1000)
            .map(|turn| {
                if turn % 2 == 0 {
                    clock.now_s()
                } else {
                    copy.now_s()
                }
            })
            .collect();
        assert!(times.windows(2).all(|pair| pair[1] >= pair[0]));
        let stamp = clock.stamp(Some(12.5));
        assert!(stamp.bench_s >= times[999] && stamp.source_s == Some(12.5));
    }
}
