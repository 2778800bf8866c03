//! What each barometer makes of the pressure at its port.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::{Features, overstress, port_law};

/// Readings of barometers, taxel by taxel: the port law of gain × pressure, and a memory of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gains {
    /// Reading over port pressure of the relaxed gel, for small pressures; `[n_taxels]`.
    pub gain: Vec<f64>,
    /// By how much a reading grows beyond proportion, for each kPa of it; `[n_taxels]`.
    pub stiffening_per_kpa: Vec<f64>,
    /// Share of each time constant's overstress in the reading; `[n_taxels][n_time_constants]`.
    pub memory: Vec<Vec<f64>>,
    /// The time constants, s.
    pub time_constants_s: Vec<f64>,
}

/// Time constants that fits start from, s: two are enough for barometers cast into rubber, one while the load
/// moves and one in a hold.
pub(crate) const TIME_CONSTANTS_S: [f64; 2] = [0.25, 4.0];

/// Readings of a press.
pub(crate) struct Sample<'a> {
    pub(crate) readings_kpa: &'a [Vec<f64>],
    pub(crate) valid: &'a [Vec<bool>],
}

impl Sample<'_> {
    /// Sum of the absolute deviations of predictions from usable readings, kPa.
    pub(crate) fn deviation_kpa(&self, predicted_kpa: &[Vec<f64>], left_out: &BTreeSet<usize>) -> f64 {
        let rows = self.readings_kpa.iter().zip(predicted_kpa).zip(self.valid);
        rows.flat_map(|((measured, predicted), valid)| {
            let taxels = (0..measured.len()).filter(|taxel| valid[*taxel] && !left_out.contains(taxel));
            taxels.map(|taxel| (measured[taxel] - predicted[taxel]).abs())
        })
        .sum()
    }
}

/// What barometers remember from one frame to the next.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Remembered {
    /// Readings of the relaxed gel at the last frame, kPa; `[n_taxels]`. Empty before the first.
    relaxed_kpa: Vec<f64>,
    /// Overstresses, kPa; `[n_taxels * n_time_constants]`.
    overstress_kpa: Vec<f64>,
}

impl Gains {
    /// One more frame: turns gain × pressure of each taxel into readings, kPa; `[n_taxels]`. `since_s` is the time since the last frame;
    /// `None` if the gel has rested until now.
    pub(crate) fn step(&self, remembered: &mut Remembered, since_s: Option<f64>, readings_kpa: &mut [f64]) {
        let n_constants = self.time_constants_s.len();
        for (reading, stiffening) in readings_kpa.iter_mut().zip(&self.stiffening_per_kpa) {
            *reading = port_law::reading(*stiffening, *reading);
        }
        match since_s {
            Some(since_s) if !remembered.relaxed_kpa.is_empty() => {
                for (j, constant_s) in self.time_constants_s.iter().enumerate() {
                    let (kept, arrived) = overstress::step(since_s, *constant_s);
                    let taxels = remembered
                        .relaxed_kpa
                        .iter_mut()
                        .zip(readings_kpa.iter())
                        .enumerate();
                    for (k, (before, now)) in taxels {
                        let q = &mut remembered.overstress_kpa[k * n_constants + j];
                        *q = kept * *q + arrived * (now - *before);
                    }
                }
            }
            _ => {
                remembered.overstress_kpa.clear();
                remembered
                    .overstress_kpa
                    .resize(readings_kpa.len() * n_constants, 0.0);
            }
        }
        remembered.relaxed_kpa.clear();
        remembered.relaxed_kpa.extend_from_slice(readings_kpa);
        if n_constants == 0 {
            return;
        }
        let overstresses = remembered.overstress_kpa.chunks_exact(n_constants);
        for ((reading, shares), overstresses) in readings_kpa.iter_mut().zip(&self.memory).zip(overstresses) {
            for (share, q) in shares.iter().zip(overstresses) {
                *reading += share * q;
            }
        }
    }

    /// Readings along presses that follow each other, from gain × pressure, kPa; `[n_presses][n_frames][n_taxels]`. Readings are zero, in
    /// the mean, over the frames over which the measured ones were set to zero.
    pub(crate) fn remember(
        &self,
        presses: &[&Features],
        mut readings_kpa: Vec<Vec<Vec<f64>>>,
    ) -> Vec<Vec<Vec<f64>>> {
        let mut remembered = Remembered::default();
        for (press, rows) in presses.iter().zip(&mut readings_kpa) {
            let mut since_s = press.since_previous_s;
            for (frame, row) in rows.iter_mut().enumerate() {
                if frame > 0 {
                    since_s = Some(press.time_s[frame] - press.time_s[frame - 1]);
                }
                self.step(&mut remembered, since_s, row);
            }
            set_to_zero(rows, press.zero_frames.clone());
        }
        readings_kpa
    }

    /// The reading that these gains alone give along presses that follow each other, kPa; `[n_presses][n_frames][n_taxels]`.
    #[must_use]
    pub fn readings_kpa(&self, presses: &[&Features]) -> Vec<Vec<Vec<f64>>> {
        let elastic = |press: &&Features| -> Vec<Vec<f64>> {
            let rows = press.pressure_kpa.iter();
            rows.map(|row| row.iter().zip(&self.gain).map(|(p, gain)| gain * p).collect())
                .collect()
        };
        self.remember(presses, presses.iter().map(elastic).collect())
    }
}

/// Takes the mean over some frames from all; `[n_frames][n_taxels]`.
pub(crate) fn set_to_zero(rows: &mut [Vec<f64>], zero_frames: std::ops::Range<usize>) {
    if zero_frames.is_empty() {
        return;
    }
    let count = zero_frames.len() as f64;
    let n_taxels = rows.first().map_or(0, Vec::len);
    let mut means = vec![0.0; n_taxels];
    for row in &rows[zero_frames] {
        means
            .iter_mut()
            .zip(row)
            .for_each(|(mean, value)| *mean += value / count);
    }
    for row in rows {
        row.iter_mut()
            .zip(&means)
            .for_each(|(value, mean)| *value -= mean);
    }
}
