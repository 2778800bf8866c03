//! Keeps the speed along a path below a limit, also if its poses come at uneven times.

/// A distance budget. It fills with time at the largest allowed speed, up to the distance of two
/// servo periods, and each step takes its length from it. A loop that is late in one period and
/// early in the next keeps its speed. A loop that is always early gains nothing.
#[derive(Clone, Debug)]
pub(super) struct SpeedBudget {
    speed_mm_per_s: f64,
    longest_s: f64,
    left_mm: f64,
    counted_s: f64,
}

impl SpeedBudget {
    pub(super) fn new(speed_mm_per_s: f64, servo_period_s: f64, now_s: f64) -> Self {
        let longest_s = 2.0 * servo_period_s;
        Self {
            speed_mm_per_s,
            longest_s,
            left_mm: speed_mm_per_s * longest_s,
            counted_s: now_s,
        }
    }

    /// Takes a step from the budget. If the step is longer than the budget, returns its speed as
    /// the error, mm/s.
    pub(super) fn spend(&mut self, step_mm: f64, now_s: f64) -> Result<(), f64> {
        let elapsed_s = (now_s - self.counted_s).clamp(0.0, self.longest_s);
        self.counted_s = now_s;
        let full_mm = self.speed_mm_per_s * self.longest_s;
        self.left_mm = (self.left_mm + self.speed_mm_per_s * elapsed_s).min(full_mm);
        if step_mm <= self.left_mm {
            self.left_mm -= step_mm;
            Ok(())
        } else {
            Err(step_mm / elapsed_s)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_uneven_loop_keeps_its_pace_and_a_hurrying_one_does_not() {
        // 100 mm/s at 250 Hz: 0.4 mm per period.
        let mut budget = SpeedBudget::new(100.0, 0.004, 0.0);
        let mut now_s = 0.0;
        for turn in 0..1000 {
            now_s += if turn % 2 == 0 { 0.0025 } else { 0.0055 };
            assert_eq!(budget.spend(0.399, now_s), Ok(()));
        }
        let gone_mm: f64 = (0..1000)
            .map(|_| {
                now_s += 0.002;
                budget.spend(0.4, now_s).map_or(0.0, |()| 0.4)
            })
            .sum();
        assert!(gone_mm <= 100.0 * 2.0 + 0.8 + 1e-9, "{gone_mm} mm in 2 s");
        assert!(budget.spend(f64::NAN, now_s).is_err());
    }
}
