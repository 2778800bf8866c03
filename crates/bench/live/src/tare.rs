//! Tare: the readings of the taxels without contact.

use twintac_log::TactileFrame;
use twintac_source::Reading;
use twintac_temperature::Warmth;

/// The pressure that each taxel reads without contact. The pressure above it is due to touch. If
/// the change of the zeros with temperature is known, the tare follows it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tare {
    /// Absolute pressure when the tare was taken, kPa. `None` for a taxel without a reading.
    pub baseline_kpa: Vec<Option<f64>>,
    warmth: Warmth,
}

impl Tare {
    /// Pressures above the tare, kPa. `None` for a taxel without a reading now or at the tare.
    /// Frames must be passed in their order.
    #[must_use]
    pub fn above_kpa(&mut self, reading: &Reading) -> Vec<Option<f64>> {
        self.warmth
            .update(reading.bench_s, &temperatures_c(&reading.frame));
        let taxels = reading.frame.taxels.iter().zip(&self.baseline_kpa);
        let above = |(index, (taxel, baseline)): (usize, (&twintac_log::TaxelReading, &Option<f64>))| {
            Some(1e-3 * taxel.pressure_pa? - (*baseline)? - self.warmth.drift_kpa(index))
        };
        taxels.enumerate().map(above).collect()
    }

    /// Temperature change since the tare of the chip that changed most, K; negative if it is
    /// colder. `None` without temperatures.
    #[must_use]
    pub fn warmer_k(&self) -> Option<f64> {
        self.warmth.warmer_k()
    }

    /// A remark for people if chips have another temperature than at the tare and the change of the
    /// zeros with temperature is unknown.
    #[must_use]
    pub fn remark(&self) -> Option<String> {
        let warmer_k = self
            .warmer_k()
            .filter(|k| k.abs() >= NOTABLE_K && !self.warmth.compensates())?;
        Some(format!(
            "the chips are {:.1} K {} than at the tare, so that the zeros have drifted: take a new tare, or compensate with `--temperature` and the file that \
             `twintac characterize` makes from a log without touch",
            warmer_k.abs(),
            if warmer_k > 0.0 { "warmer" } else { "colder" }
        ))
    }
}

/// Temperature change from which on a person is told, K. Most zeros then change by some tenths of a
/// kPa.
const NOTABLE_K: f64 = 1.0;

fn temperatures_c(frame: &TactileFrame) -> Vec<Option<f64>> {
    frame.taxels.iter().map(|taxel| taxel.temperature_c).collect()
}

/// A tare that is being taken: the mean of [`Taring::FRAMES`] frames.
#[derive(Clone, Debug, Default)]
pub struct Taring {
    frames: usize,
    /// Sum, kPa, and number of pressures of each taxel.
    sums: Vec<(f64, u32)>,
    warmth: Warmth,
}

impl Taring {
    /// Number of frames of a tare: a quarter of a second. Noise of 15 Pa becomes 3 Pa.
    pub const FRAMES: usize = 32;

    /// Begins a tare. `kpa_per_k` is the change of each zero with temperature, kPa/K; empty if
    /// unknown.
    #[must_use]
    pub fn new(kpa_per_k: Vec<f64>) -> Self {
        Self {
            warmth: Warmth::new(kpa_per_k),
            ..Self::default()
        }
    }

    /// Adds a frame. Returns the tare with the last one.
    pub fn push(&mut self, reading: &Reading) -> Option<Tare> {
        let frame = &reading.frame;
        self.warmth.update(reading.bench_s, &temperatures_c(frame));
        self.sums.resize(frame.taxels.len(), (0.0, 0));
        for ((sum, count), taxel) in self.sums.iter_mut().zip(&frame.taxels) {
            if let Some(pressure_pa) = taxel.pressure_pa {
                *sum += 1e-3 * pressure_pa;
                *count += 1;
            }
        }
        self.frames += 1;
        let mean = |(sum, count): &(f64, u32)| (*count > 0).then(|| sum / f64::from(*count));
        (self.frames == Self::FRAMES).then(|| {
            self.warmth.tare();
            Tare {
                baseline_kpa: self.sums.iter().map(mean).collect(),
                warmth: self.warmth.clone(),
            }
        })
    }
}
