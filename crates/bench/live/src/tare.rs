//! What the taxels read untouched.

use twintac_log::TactileFrame;
use twintac_source::Reading;
use twintac_temperature::Warmth;

/// The pressure that each taxel reads untouched; what is above it is touch. Where it is known how zeros move with temperature, it moves with them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tare {
    /// kPa, absolute, when it was taken; `None` of a taxel that gave none.
    pub baseline_kpa: Vec<Option<f64>>,
    warmth: Warmth,
}

impl Tare {
    /// Pressures above it, kPa; none of a taxel that gives none, or gave none then. Frames are handed over in their order.
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

    /// How much warmer than at the tare the chip is that changed most, K; below zero if it is colder; `None` without temperatures.
    #[must_use]
    pub fn warmer_k(&self) -> Option<f64> {
        self.warmth.warmer_k()
    }

    /// What to tell a person where chips have another temperature than at the tare, and nobody said how zeros move with it.
    #[must_use]
    pub fn remark(&self) -> Option<String> {
        let warmer_k = self
            .warmer_k()
            .filter(|k| k.abs() >= NOTABLE_K && !self.warmth.compensates())?;
        Some(format!(
            "the chips are {:.1} K {} than at the tare, and zeros move with it: `twintac characterize` finds by how much from a log without touch, and \
             `--temperature` takes it off; or take a new tare",
            warmer_k.abs(),
            if warmer_k > 0.0 { "warmer" } else { "colder" }
        ))
    }
}

/// Change of temperature from which on a person should know, K: most zeros move by some tenths of a kPa then.
const NOTABLE_K: f64 = 1.0;

fn temperatures_c(frame: &TactileFrame) -> Vec<Option<f64>> {
    frame.taxels.iter().map(|taxel| taxel.temperature_c).collect()
}

/// A tare while it is taken: the mean of [`Taring::FRAMES`] frames.
#[derive(Clone, Debug, Default)]
pub struct Taring {
    frames: usize,
    /// Sum, kPa, and number of pressures, of each taxel.
    sums: Vec<(f64, u32)>,
    warmth: Warmth,
}

impl Taring {
    /// Frames that make a tare: a quarter of a second; noise of 15 Pa becomes 3 Pa.
    pub const FRAMES: usize = 32;

    /// A tare of a sensor whose zeros move with temperature by so much, kPa/K, each; empty where nothing is known.
    #[must_use]
    pub fn new(kpa_per_k: Vec<f64>) -> Self {
        Self {
            warmth: Warmth::new(kpa_per_k),
            ..Self::default()
        }
    }

    /// Takes a frame, and gives the tare with the last one.
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
