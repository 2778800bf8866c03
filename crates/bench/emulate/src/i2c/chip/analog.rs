//! The analog part of a chip, before its registers: timing, noise and the converter.

use twintac_random::{RandomStream, normal};

use super::felt::{Felt, Now};
use crate::clock::nanoseconds;

/// Timing and noise of one part.
#[derive(Debug)]
pub(in crate::i2c) struct Analog {
    random: RandomStream,
    /// Ratio of this part's times to the usual times.
    slowness: f64,
    /// Standard deviation that the board's settings give to all chips, Pa. `None`: that of the data
    /// sheet.
    noise_pa: Option<f64>,
}

/// A conversion under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conversion<T> {
    begun_ns: u64,
    pub(super) ends_ns: u64,
    /// What is converted.
    pub(super) what: T,
}

impl Analog {
    pub(in crate::i2c) fn new(
        mut random: RandomStream,
        conversion_spread: f64,
        noise_pa: Option<f64>,
    ) -> Self {
        let slowness = 1.0 + normal(&mut random, conversion_spread).clamp(-0.5, 0.5);
        Self {
            random,
            slowness,
            noise_pa,
        }
    }

    /// The time of this part, s, for the usual time `usual_s`.
    pub(super) fn time_s(&self, usual_s: f64) -> f64 {
        self.slowness * usual_s
    }

    /// A conversion that begins now.
    pub(super) fn begin<T>(&self, what: T, usual_s: f64, now_ns: u64) -> Conversion<T> {
        Conversion {
            begun_ns: now_ns,
            ends_ns: now_ns + nanoseconds(self.time_s(usual_s)).max(1),
            what,
        }
    }

    /// The conversion that has ended by now, if it has.
    pub(super) fn ended<T>(
        &self,
        under_way: &mut Option<Conversion<T>>,
        now: &Now<'_>,
    ) -> Option<Conversion<T>> {
        under_way.take_if(|conversion| conversion.ends_ns <= now.ns && !now.is_endless)
    }

    /// The result of a conversion: the values in the middle of its time, because a conversion
    /// averages, with noise, Pa.
    pub(super) fn measure<T>(&mut self, conversion: &Conversion<T>, noise_pa: f64, now: &Now<'_>) -> Felt {
        let felt = (now.felt)(conversion.begun_ns.midpoint(conversion.ends_ns));
        let noise_pa = normal(&mut self.random, self.noise_pa.unwrap_or(noise_pa));
        Felt {
            pressure_pa: felt.pressure_pa + noise_pa,
            ..felt
        }
    }

    /// A value that differs between parts, with the standard deviation `spread` as a fraction.
    pub(super) fn about(&mut self, usual: f64, spread: f64) -> f64 {
        usual * (1.0 + normal(&mut self.random, spread))
    }
}

/// The number from `lowest` to `highest` for which a monotonic function comes closest to `target`:
/// the counts of a converter.
pub(super) fn counts_of(target: f64, lowest: i64, highest: i64, function: impl Fn(f64) -> f64) -> i64 {
    let rises = function(highest as f64) > function(lowest as f64);
    let (mut low, mut high) = (lowest, highest);
    while high - low > 1 {
        let middle = low.midpoint(high);
        if (function(middle as f64) < target) == rises {
            low = middle;
        } else {
            high = middle;
        }
    }
    let distance = |number: i64| (function(number as f64) - target).abs();
    if distance(low) <= distance(high) {
        low
    } else {
        high
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closest_number_is_found_whichever_way_it_goes() {
        assert_eq!(counts_of(20.2, 0, 1000, |number| 2.0 * number), 10);
        assert_eq!(counts_of(-20.2, -500, 500, |number| -2.0 * number), 10);
        assert_eq!(counts_of(1e9, 0, 1000, |number| number), 1000);
        assert_eq!(counts_of(-1e9, 0, 1000, |number| number), 0);
    }
}
