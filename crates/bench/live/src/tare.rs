//! What the taxels read untouched.

use twintac_log::TactileFrame;

/// The pressure that each taxel reads untouched; what is above it is touch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tare {
    /// kPa, absolute; `None` of a taxel that gave none.
    pub baseline_kpa: Vec<Option<f64>>,
}

impl Tare {
    /// Pressures above it, kPa; none of a taxel that gives none, or gave none then.
    #[must_use]
    pub fn above_kpa(&self, frame: &TactileFrame) -> Vec<Option<f64>> {
        let above = |(taxel, baseline): (&twintac_log::TaxelReading, &Option<f64>)| {
            Some(1e-3 * taxel.pressure_pa? - (*baseline)?)
        };
        frame.taxels.iter().zip(&self.baseline_kpa).map(above).collect()
    }
}

/// A tare while it is taken: the mean of [`Taring::FRAMES`] frames.
#[derive(Clone, Debug, Default)]
pub struct Taring {
    frames: usize,
    /// Sum, kPa, and number of pressures, of each taxel.
    sums: Vec<(f64, u32)>,
}

impl Taring {
    /// Frames that make a tare: a quarter of a second; noise of 15 Pa becomes 3 Pa.
    pub const FRAMES: usize = 32;

    /// Takes a frame, and gives the tare with the last one.
    pub fn push(&mut self, frame: &TactileFrame) -> Option<Tare> {
        self.sums.resize(frame.taxels.len(), (0.0, 0));
        for ((sum, count), taxel) in self.sums.iter_mut().zip(&frame.taxels) {
            if let Some(pressure_pa) = taxel.pressure_pa {
                *sum += 1e-3 * pressure_pa;
                *count += 1;
            }
        }
        self.frames += 1;
        let mean = |(sum, count): &(f64, u32)| (*count > 0).then(|| sum / f64::from(*count));
        (self.frames == Self::FRAMES).then(|| Tare {
            baseline_kpa: self.sums.iter().map(mean).collect(),
        })
    }
}
