//! Detection of the first touch.

use std::collections::VecDeque;

/// The mean force along the press direction over the latest readings.
#[derive(Clone, Debug)]
pub(crate) struct Touch {
    window_s: f64,
    force_n: f64,
    readings: VecDeque<(f64, f64)>,
}

impl Touch {
    /// Fewest readings of a mean, so that noise alone is not taken for a touch.
    const FEWEST: usize = 3;

    pub(crate) fn new(window_s: f64, force_n: f64) -> Self {
        Self {
            window_s,
            force_n,
            readings: VecDeque::new(),
        }
    }

    pub(crate) fn hear(&mut self, time_s: f64, force_n: f64) {
        self.readings.push_back((time_s, force_n));
        while let Some((first_s, _)) = self.readings.front()
            && time_s - first_s > self.window_s
        {
            self.readings.pop_front();
        }
    }

    pub(crate) fn is_touching(&self) -> bool {
        let n = self.readings.len();
        let sum_n: f64 = self.readings.iter().map(|(_, force_n)| force_n).sum();
        n >= Self::FEWEST && sum_n >= self.force_n * n as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_loud_reading_is_no_touch_and_a_steady_force_is() {
        let mut touch = Touch::new(0.02, 0.1);
        for index in 0..20 {
            touch.hear(f64::from(index) * 1e-3, if index == 10 { 0.9 } else { 0.0 });
            assert!(!touch.is_touching());
        }
        for index in 20..50 {
            touch.hear(f64::from(index) * 1e-3, 0.11);
        }
        assert!(touch.is_touching());
        assert!(touch.readings.len() <= 22);
    }
}
