//! Temperature changes of the chips since the tare, frame by frame.

/// Averaging time of temperatures, s: chips warm up within minutes, and a single temperature is
/// noisy.
const TIME_S: f64 = 2.0;

/// The drift of a sensor's zeros since its tare, computed frame by frame from the chips'
/// temperatures.
///
/// Temperatures are averaged over about two seconds. A taxel without a temperature keeps its last
/// one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Warmth {
    /// Temperature coefficient of each taxel, kPa/K; empty if unknown.
    kpa_per_k: Vec<f64>,
    chips: Vec<Chip>,
    last_s: Option<f64>,
}

/// A chip's temperatures, °C.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Chip {
    /// The averaged temperature, and the time that the average covers so far, s.
    smooth_c: Option<(f64, f64)>,
    at_tare_c: Option<f64>,
}

impl Warmth {
    /// A compensation with coefficients of the taxels, kPa/K, from
    /// [`Compensation::coefficients`](crate::Compensation::coefficients). With an empty list it
    /// follows temperatures and subtracts nothing.
    #[must_use]
    pub fn new(kpa_per_k: Vec<f64>) -> Self {
        Self {
            kpa_per_k,
            ..Self::default()
        }
    }

    /// Takes the temperatures of the taxels in a frame, °C, at a time, s. A frame that is not later
    /// than the last one is ignored.
    pub fn update(&mut self, time_s: f64, temperatures_c: &[Option<f64>]) {
        let step_s = match self.last_s {
            Some(last_s) if time_s <= last_s => return,
            Some(last_s) => time_s - last_s,
            None => 0.0,
        };
        self.last_s = Some(time_s);
        self.chips.resize(temperatures_c.len(), Chip::default());
        for (chip, temperature_c) in self.chips.iter_mut().zip(temperatures_c) {
            let Some(temperature_c) = temperature_c.filter(|c| c.is_finite()) else {
                continue;
            };
            chip.smooth_c = Some(match chip.smooth_c {
                None => (temperature_c, step_s),
                // At first the mean of all values, later an exponential average.
                Some((smooth_c, over_s)) => {
                    let over_s = (over_s + step_s).min(TIME_S.max(step_s));
                    let part = if over_s > 0.0 { step_s / over_s } else { 1.0 };
                    (smooth_c + part * (temperature_c - smooth_c), over_s)
                }
            });
        }
    }

    /// Takes the current temperatures as reference.
    pub fn tare(&mut self) {
        for chip in &mut self.chips {
            chip.at_tare_c = chip.smooth_c.map(|(smooth_c, _)| smooth_c);
        }
    }

    /// Drift of a taxel's zero since the tare, kPa; 0 if unknown.
    #[must_use]
    pub fn drift_kpa(&self, taxel: usize) -> f64 {
        let warmer_k = self.chips.get(taxel).and_then(Chip::warmer_k);
        let kpa_per_k = self.kpa_per_k.get(taxel).copied();
        kpa_per_k
            .zip(warmer_k)
            .map_or(0.0, |(kpa_per_k, warmer_k)| kpa_per_k * warmer_k)
    }

    /// Change since the tare of the chip whose temperature changed most, K; negative if it is
    /// colder.
    #[must_use]
    pub fn warmer_k(&self) -> Option<f64> {
        let changes = self.chips.iter().filter_map(Chip::warmer_k);
        changes.max_by(|a, b| a.abs().total_cmp(&b.abs()))
    }

    /// Whether there are coefficients to subtract a drift.
    #[must_use]
    pub fn compensates(&self) -> bool {
        !self.kpa_per_k.is_empty()
    }
}

impl Chip {
    fn warmer_k(&self) -> Option<f64> {
        Some(self.smooth_c?.0 - self.at_tare_c?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_averaged_and_a_ramp_followed() {
        let mut warmth = Warmth::new(vec![2.0]);
        let noise = |frame: u32| if frame.is_multiple_of(2) { 0.05 } else { -0.05 };
        let at = |frame: u32| f64::from(frame) / 50.0;
        let mut worst_kpa: f64 = 0.0;
        for frame in 0..180_000 {
            // 4 K per hour, 8 kPa.
            let true_k = 4.0 / 3600.0 * at(frame);
            warmth.update(at(frame), &[Some(25.0 + true_k + noise(frame))]);
            if frame == 31 {
                warmth.tare();
            }
            if frame > 31 {
                worst_kpa = worst_kpa.max((warmth.drift_kpa(0) - 2.0 * true_k).abs());
            }
        }
        assert!(worst_kpa < 0.02, "{worst_kpa}");
    }

    #[test]
    fn what_is_not_there_moves_nothing() {
        let mut warmth = Warmth::new(vec![1.0, 1.0]);
        warmth.update(0.0, &[Some(20.0), None]);
        warmth.tare();
        warmth.update(10.0, &[None, Some(30.0)]);
        assert_eq!((warmth.drift_kpa(0), warmth.drift_kpa(1)), (0.0, 0.0));
        warmth.update(20.0, &[Some(23.0), Some(31.0)]);
        assert_eq!((warmth.drift_kpa(0), warmth.drift_kpa(1)), (3.0, 0.0));
        assert_eq!(warmth.warmer_k(), Some(3.0));
        // A repeated frame, or an earlier one.
        warmth.update(20.0, &[Some(90.0), None]);
        warmth.update(19.0, &[Some(90.0), None]);
        assert_eq!((warmth.drift_kpa(0), warmth.drift_kpa(7)), (3.0, 0.0));
        let mut without = Warmth::default();
        without.update(0.0, &[Some(20.0)]);
        without.tare();
        without.update(60.0, &[Some(15.0)]);
        assert_eq!((without.drift_kpa(0), without.warmer_k()), (0.0, Some(-5.0)));
        assert!(!without.compensates());
    }
}
