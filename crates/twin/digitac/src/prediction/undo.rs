//! Removal of viscoelastic relaxation from the readings of barometers.
//!
//! A barometer reads `r + Σ c q` above its zero. The overstresses `q` follow its own relaxed
//! reading `r` and nothing else. Readings therefore determine `r`, taxel by taxel and frame by
//! frame, for any contact.

use crate::Twin;
use crate::features::{is_pressure, overstress_step};

/// Turns readings, as they come, into those of a gel that has always rested: the readings of a
/// [`TwinState`](crate::TwinState) in its first frame after [`rest`](crate::TwinState::rest).
/// Frames allocate no memory.
///
/// It needs no tare: the first frame must be without contact, and so must every frame after which
/// [`settle`](Self::settle) is called. The zero follows these frames.
#[derive(Clone, Debug)]
pub struct WithoutMemory {
    /// Share of each overstress in the reading; `[n_taxels][n_time_constants]`.
    shares: Vec<Vec<f64>>,
    time_constants_s: Vec<f64>,
    /// Whether the next reading is without contact; `[n_taxels]`.
    is_untouched: Vec<bool>,
    /// Zeros, kPa; `[n_taxels]`.
    zero_kpa: Vec<f64>,
    /// Relaxed readings of the last frame, kPa; `[n_taxels]`.
    relaxed_kpa: Vec<f64>,
    /// Overstresses, kPa; `[n_taxels][n_time_constants]`.
    overstress_kpa: Vec<Vec<f64>>,
}

impl Twin {
    /// Removes the twin's relaxation from the readings of a sensor whose gel has rested.
    #[must_use]
    pub fn without_memory(&self) -> WithoutMemory {
        let gains = self.gains();
        let n_taxels = self.taxels().len();
        WithoutMemory {
            shares: (0..n_taxels)
                .map(|taxel| gains.memory.get(taxel).cloned().unwrap_or_default())
                .collect(),
            time_constants_s: gains.time_constants_s.clone(),
            is_untouched: vec![true; n_taxels],
            zero_kpa: vec![0.0; n_taxels],
            relaxed_kpa: vec![0.0; n_taxels],
            overstress_kpa: vec![vec![0.0; gains.time_constants_s.len()]; n_taxels],
        }
    }
}

impl WithoutMemory {
    /// One more frame: readings, kPa, with any constant offset, become those of the relaxed gel
    /// above its zero; `[n_taxels]`.
    ///
    /// `since_previous_s` is the time since the last frame, s, not negative. A value that is not a
    /// reading (NaN, infinite, or beyond 1 GPa) becomes NaN, in this frame alone; the state is kept
    /// as if nothing had changed. If it should have been a reading without contact, the taxel takes
    /// its zero from the next frame.
    ///
    /// # Panics
    /// If `readings_kpa` has a wrong length, or the time is negative or NaN.
    pub fn step(&mut self, since_previous_s: f64, readings_kpa: &mut [f64]) {
        assert_eq!(
            readings_kpa.len(),
            self.zero_kpa.len(),
            "a reading for each taxel"
        );
        assert!(since_previous_s >= 0.0, "a time that does not run backwards");
        for (taxel, reading) in readings_kpa.iter_mut().enumerate() {
            let shares = &self.shares[taxel];
            let overstresses = &mut self.overstress_kpa[taxel];
            let before = self.relaxed_kpa[taxel];
            let (mut remembered, mut at_once) = (0.0, 1.0);
            for ((q, constant_s), share) in overstresses.iter_mut().zip(&self.time_constants_s).zip(shares) {
                let (kept, arrived) = overstress_step(since_previous_s, *constant_s);
                *q = kept * *q - arrived * before;
                remembered += share * *q;
                at_once += share * arrived;
            }
            let is_read = is_pressure(*reading);
            if is_read && std::mem::take(&mut self.is_untouched[taxel]) {
                self.zero_kpa[taxel] = *reading - remembered;
            }
            let relaxed = if is_read {
                (*reading - self.zero_kpa[taxel] - remembered) / at_once
            } else {
                before
            };
            for (q, constant_s) in overstresses.iter_mut().zip(&self.time_constants_s) {
                *q += overstress_step(since_previous_s, *constant_s).1 * relaxed;
            }
            self.relaxed_kpa[taxel] = relaxed;
            *reading = if is_read { relaxed } else { f64::NAN };
        }
    }

    /// Tells that the last frame was without contact: the zero moves by a fraction, from 0 to 1, of
    /// the way to the readings.
    pub fn settle(&mut self, part: f64) {
        for (zero, relaxed) in self.zero_kpa.iter_mut().zip(&mut self.relaxed_kpa) {
            *zero += part * *relaxed;
            *relaxed -= part * *relaxed;
        }
    }

    /// Tells that the next frame is without contact and that the offset of the readings may be
    /// another, for example where a recording continues elsewhere. The state of relaxation stays.
    pub fn tare(&mut self) {
        self.is_untouched.fill(true);
    }
}
