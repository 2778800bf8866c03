//! The response of each barometer to the pressure at its port.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use twintac_config::Ranges;

use super::{Features, overstress, port_law};

/// Response of barometers, taxel by taxel: gain × pressure, a static nonlinearity (port law), and
/// viscoelastic relaxation (memory).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gains {
    /// Ratio of reading to port pressure of the relaxed gel, for small pressures; `[n_taxels]`.
    pub gain: Vec<f64>,
    /// Relative growth of a reading beyond proportionality, per kPa of the reading; `[n_taxels]`.
    pub stiffening_per_kpa: Vec<f64>,
    /// Share of each time constant's overstress in the reading; `[n_taxels][n_time_constants]`.
    pub memory: Vec<Vec<f64>>,
    /// The time constants, s.
    pub time_constants_s: Vec<f64>,
}

/// Initial time constants of fits, s. Two are enough for barometers cast into rubber: one while the
/// load moves, and one in a hold.
pub(crate) const TIME_CONSTANTS_S: [f64; 2] = [0.25, 4.0];

/// The largest pressure that is accepted, kPa: forty times the pressure under a kilometre of
/// granite.
const LARGEST_KPA: f64 = 1e6;

/// Whether a number can be a pressure or a reading, kPa: finite and within the accepted range.
pub(crate) fn is_pressure(kpa: f64) -> bool {
    kpa.abs() <= LARGEST_KPA
}

/// Range of time constants. Longer ones are drift, and shorter ones are below any sampling period.
pub(crate) fn check_time_constants(ranges: &mut Ranges, time_constants_s: &[f64]) {
    ranges.numbers("time_constants_s", time_constants_s, 4, 1e-3..=1e4);
}

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

/// State of relaxation of the barometers of one or more sensors, from one frame to the next. The
/// arrays of all sensors are next to each other.
#[derive(Clone, Debug)]
pub(crate) struct Remembered {
    /// Whether the gel rests until the next frame; `[n_sensors]`.
    rested: Vec<bool>,
    /// Readings of the relaxed gel at the last frame, kPa; `[n_sensors * n_taxels]`.
    relaxed_kpa: Vec<f64>,
    /// Overstresses, kPa; `[n_time_constants * n_sensors * n_taxels]`.
    overstress_kpa: Vec<f64>,
    /// Share of each overstress in the reading, in one array; `[n_time_constants * n_taxels]`.
    shares: Vec<f64>,
}

impl Remembered {
    /// Sensors whose gels have rested.
    pub(crate) fn rested(gains: &Gains, n_sensors: usize) -> Self {
        let n_readings = n_sensors * gains.gain.len();
        Self {
            rested: vec![true; n_sensors],
            relaxed_kpa: vec![0.0; n_readings],
            overstress_kpa: vec![0.0; gains.time_constants_s.len() * n_readings],
            shares: (0..gains.time_constants_s.len())
                .flat_map(|j| gains.memory.iter().map(move |shares| shares[j]))
                .collect(),
        }
    }

    /// Lets the gel of one sensor rest until its next frame.
    pub(crate) fn rest(&mut self, sensor: usize) {
        self.rested[sensor] = true;
        let (n_readings, n_taxels) = (self.relaxed_kpa.len(), self.relaxed_kpa.len() / self.rested.len());
        for overstresses in self.overstress_kpa.chunks_exact_mut(n_readings.max(1)) {
            overstresses[sensor * n_taxels..][..n_taxels].fill(0.0);
        }
    }

    /// The state of one sensor alone.
    pub(crate) fn of_sensor(&self, sensor: usize) -> Self {
        let own = self.taxels(sensor);
        let overstresses = self.overstress_kpa.chunks_exact(self.relaxed_kpa.len().max(1));
        Self {
            rested: vec![self.rested[sensor]],
            relaxed_kpa: self.relaxed_kpa[own.clone()].to_vec(),
            overstress_kpa: overstresses
                .flat_map(|all| all[own.clone()].iter().copied())
                .collect(),
            shares: self.shares.clone(),
        }
    }

    /// Replaces the state of one sensor by that of a single sensor of the same twin.
    pub(crate) fn set_sensor(&mut self, sensor: usize, of_one: &Self) {
        let (own, n_readings) = (self.taxels(sensor), self.relaxed_kpa.len().max(1));
        assert_eq!(
            self.overstress_kpa.len(),
            of_one.overstress_kpa.len() * self.rested.len(),
            "overstresses of as many time constants"
        );
        self.rested[sensor] = of_one.rested[0];
        self.relaxed_kpa[own.clone()].copy_from_slice(&of_one.relaxed_kpa);
        let overstresses = self.overstress_kpa.chunks_exact_mut(n_readings);
        for (all, of_one) in overstresses.zip(of_one.overstress_kpa.chunks_exact(own.len().max(1))) {
            all[own.clone()].copy_from_slice(of_one);
        }
    }

    fn taxels(&self, sensor: usize) -> std::ops::Range<usize> {
        let n_taxels = self.relaxed_kpa.len() / self.rested.len().max(1);
        sensor * n_taxels..(sensor + 1) * n_taxels
    }
}

impl Gains {
    /// One more frame of each sensor: turns gain × pressure of each taxel into readings, kPa;
    /// `[n_sensors * n_taxels]`. `since_s` is the time since the last frame; sensors whose gel has
    /// rested until now ignore it. A value that is not a pressure ([`is_pressure`]) is read as NaN,
    /// and the state keeps the previous frame in its place.
    pub(crate) fn step(&self, remembered: &mut Remembered, since_s: f64, readings_kpa: &mut [f64]) {
        let n_taxels = self.gain.len().max(1);
        for row in readings_kpa.chunks_exact_mut(n_taxels) {
            for (reading, stiffening) in row.iter_mut().zip(&self.stiffening_per_kpa) {
                let elastic = *reading;
                *reading = port_law::reading(*stiffening, elastic);
                if !(is_pressure(elastic) && is_pressure(*reading)) {
                    *reading = f64::NAN;
                }
            }
        }
        if self.time_constants_s.is_empty() {
            return;
        }
        let relaxed = remembered.relaxed_kpa.chunks_exact_mut(n_taxels);
        let rows = readings_kpa.chunks_exact(n_taxels);
        for ((rested, relaxed), row) in remembered.rested.iter_mut().zip(relaxed).zip(rows) {
            if std::mem::take(rested) {
                relaxed.copy_from_slice(row); // a NaN rests until its next frame
            }
        }
        let n_readings = readings_kpa.len().max(1);
        let overstresses = remembered.overstress_kpa.chunks_exact_mut(n_readings);
        for (overstresses, constant_s) in overstresses.zip(&self.time_constants_s) {
            let (kept, arrived) = overstress::step(since_s, *constant_s);
            let changes = readings_kpa.iter().zip(&remembered.relaxed_kpa);
            for (q, (now, before)) in overstresses.iter_mut().zip(changes) {
                let change = now - before;
                *q = kept * *q + arrived * if change.is_nan() { 0.0 } else { change };
            }
        }
        for (relaxed, now) in remembered.relaxed_kpa.iter_mut().zip(&*readings_kpa) {
            if !now.is_nan() {
                *relaxed = *now;
            }
        }
        let overstresses = remembered.overstress_kpa.chunks_exact(n_readings);
        for (overstresses, shares) in overstresses.zip(remembered.shares.chunks_exact(n_taxels)) {
            let rows = readings_kpa.chunks_exact_mut(n_taxels);
            for (row, overstresses) in rows.zip(overstresses.chunks_exact(n_taxels)) {
                for ((reading, share), q) in row.iter_mut().zip(shares).zip(overstresses) {
                    *reading += share * q;
                }
            }
        }
    }

    /// Readings along presses that follow each other, from gain × pressure, kPa;
    /// `[n_presses][n_frames][n_taxels]`. Their mean is zero over the frames over which the
    /// measured readings were set to zero.
    pub(crate) fn remember(
        &self,
        presses: &[&Features],
        mut elastic_kpa: Vec<Vec<Vec<f64>>>,
    ) -> Vec<Vec<Vec<f64>>> {
        let mut remembered = Remembered::rested(self, 1);
        along(presses, |press, frame, since_s| {
            if since_s.is_none() {
                remembered.rest(0);
            }
            let mut row = std::mem::take(&mut elastic_kpa[press][frame]);
            self.step(&mut remembered, since_s.unwrap_or(0.0), &mut row);
            row
        })
    }

    /// Readings along presses that follow each other, from these gains alone, kPa;
    /// `[n_presses][n_frames][n_taxels]`.
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

/// Readings along presses that follow each other, kPa; `[n_presses][n_frames][n_taxels]`. `step`
/// computes a row of them from the indices of press and frame and the time since the last frame,
/// `None` if the gel has rested until now.
pub(crate) fn along(
    presses: &[&Features],
    mut step: impl FnMut(usize, usize, Option<f64>) -> Vec<f64>,
) -> Vec<Vec<Vec<f64>>> {
    let frames_of = |(number, press): (usize, &&Features)| {
        let since_s = |frame: usize| match frame {
            0 => press.since_previous_s,
            _ => Some(press.time_s[frame] - press.time_s[frame - 1]),
        };
        let mut rows: Vec<Vec<f64>> = (0..press.n_frames())
            .map(|frame| step(number, frame, since_s(frame)))
            .collect();
        set_to_zero(&mut rows, press.zero_frames.clone());
        rows
    };
    presses.iter().enumerate().map(frames_of).collect()
}

/// Subtracts the mean over some frames from all frames; `[n_frames][n_taxels]`. The mean of equal
/// frames has exactly their bits.
fn set_to_zero(rows: &mut [Vec<f64>], zero_frames: std::ops::Range<usize>) {
    if zero_frames.is_empty() {
        return;
    }
    let n_taxels = rows.first().map_or(0, Vec::len);
    let mut means = vec![0.0; n_taxels];
    for (before, row) in rows[zero_frames].iter().enumerate() {
        let count = (before + 1) as f64;
        means
            .iter_mut()
            .zip(row)
            .for_each(|(mean, value)| *mean += (value - *mean) / count);
    }
    for row in rows {
        row.iter_mut()
            .zip(&means)
            .for_each(|(value, mean)| *value -= mean);
    }
}
