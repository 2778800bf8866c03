//! A twin in use: its state from earlier frames, and its next readings.

use crate::features::{Remembered, along, is_pressure};
use crate::network::ElasticRows;
use crate::{Features, Twin};

/// Number of sensors whose elastic readings are computed at once: their layers stay in the
/// processor's cache.
const MOST_ROWS: usize = 64;

/// A twin of one sensor in use, or of many sensors that are stepped together. It keeps the
/// relaxation of their gels and their zeros. A copy continues from the same moment.
///
/// Steps give the same numbers as [`Twin::predict`] along whole presses, bit for bit. So does each
/// of many sensors that are stepped together, in any order. Steps allocate no memory. The calling
/// thread does all work; to use more threads, give each thread its own sensors.
#[derive(Clone, Debug)]
pub struct TwinState {
    twin: Twin,
    /// Gains of the elastic readings; `[n_taxels]`.
    gains: Vec<f32>,
    rows: ElasticRows,
    remembered: Remembered,
    /// The last readings before the zero is subtracted, kPa; `[n_sensors * n_taxels]`.
    untared_kpa: Vec<f64>,
    /// Zeros of the readings, kPa; `[n_sensors * n_taxels]`.
    zero_kpa: Vec<f64>,
}

/// Relaxation and zero of one sensor: see [`TwinState::memory`].
#[derive(Clone, Debug)]
pub struct TwinMemory {
    remembered: Remembered,
    /// The last readings before the zero is subtracted, kPa; `[n_taxels]`.
    untared_kpa: Vec<f64>,
    zero_kpa: Vec<f64>,
}

impl Twin {
    /// The twin of one sensor, whose gel has rested.
    #[must_use]
    pub fn state(&self) -> TwinState {
        self.states(1)
    }

    /// Twins of `n_sensors` sensors, whose gels have rested.
    #[must_use]
    pub fn states(&self, n_sensors: usize) -> TwinState {
        let n_readings = n_sensors * self.taxels().len();
        TwinState {
            twin: self.clone(),
            gains: self.parameters().elastic_gains(self.physics()),
            rows: ElasticRows::new(self.parameters(), n_sensors.min(MOST_ROWS)),
            remembered: Remembered::rested(self.gains(), n_sensors),
            untared_kpa: vec![0.0; n_readings],
            zero_kpa: vec![0.0; n_readings],
        }
    }

    /// Predicted readings above their unloaded baseline along simulated presses, kPa;
    /// `[n_presses][n_frames][n_taxels]`. Their mean is zero over [`Features::zero_frames`].
    /// Relaxation goes on between presses that follow each other: see
    /// [`Features::since_previous_s`].
    #[must_use]
    pub fn predict(&self, presses: &[&Features]) -> Vec<Vec<Vec<f64>>> {
        let mut state = self.state();
        along(presses, |press, frame, since_s| {
            if since_s.is_none() {
                state.rest(0);
            }
            let seen = &self.physics().seen(presses[press])[frame];
            let mut readings_kpa = vec![0.0; seen.len()];
            state.step(since_s.unwrap_or(0.0), seen, &mut readings_kpa);
            readings_kpa
        })
    }
}

impl TwinState {
    /// One more frame of every sensor: from the simulated gel to the predicted readings, kPa.
    ///
    /// - `since_previous_s`: time since the last frame, s, not negative. Sensors whose gel has
    ///   rested until now ignore it.
    /// - `seen`: hydrostatic pressure at each port, kPa; for
    ///   [`Variant::Paper`](crate::Variant::Paper) the stress feature above each taxel, kPa/mm.
    ///   `[n_sensors * n_taxels]`, sensor by sensor.
    /// - `readings_kpa`: the output, above the zero that was last set, or else above the twin's own
    ///   zero. `[n_sensors * n_taxels]`.
    ///
    /// A value that is not a pressure (NaN, infinite, or beyond 1 GPa) is read as NaN, in this
    /// frame alone; the state is kept as if nothing had changed. If the variant has a perceptron,
    /// whose inputs are all ports, all taxels of the sensor are read as NaN.
    ///
    /// # Panics
    /// If slices have wrong lengths, or the time is negative or NaN.
    /// Slices of another length; a time that is negative or NaN.
    pub fn step(&mut self, since_previous_s: f64, seen: &[f64], readings_kpa: &mut [f64]) {
        assert!(since_previous_s >= 0.0, "a time that does not run backwards");
        let n_readings = self.zero_kpa.len();
        assert_eq!(
            [seen.len(), readings_kpa.len()],
            [n_readings; 2],
            "pressures and readings of all taxels of all sensors"
        );
        let chunk = MOST_ROWS * self.gains.len().max(1);
        // The remainder comes first, so that the last chunk has the full number of rows.
        let odd = n_readings % chunk;
        let (seen_first, seen_rest) = seen.split_at(odd);
        let (readings_first, readings_rest) = readings_kpa.split_at_mut(odd);
        if odd > 0 {
            self.read_elastic(seen_first, readings_first);
        }
        let chunks = seen_rest.chunks_exact(chunk);
        for (seen, readings_kpa) in chunks.zip(readings_rest.chunks_exact_mut(chunk)) {
            self.read_elastic(seen, readings_kpa);
        }
        let gains = self.twin.gains();
        gains.step(&mut self.remembered, since_previous_s, readings_kpa);
        for (untared, reading) in self.untared_kpa.iter_mut().zip(&*readings_kpa) {
            if !reading.is_nan() {
                *untared = *reading;
            }
        }
        for (reading, zero) in readings_kpa.iter_mut().zip(&self.zero_kpa) {
            *reading -= zero;
        }
    }

    fn read_elastic(&mut self, seen: &[f64], readings_kpa: &mut [f64]) {
        let (parameters, physics) = (self.twin.parameters(), self.twin.physics());
        let elastic = self.rows.read(parameters, physics, &self.gains, seen);
        let reading_kpa = physics.normalization.reading_kpa;
        for (reading, elastic) in readings_kpa.iter_mut().zip(elastic) {
            *reading = reading_kpa * f64::from(*elastic);
        }
        let n_taxels = self.gains.len().max(1);
        let sees_all = physics.variant.has_perceptron();
        let rows = readings_kpa.chunks_exact_mut(n_taxels);
        for (row, seen) in rows.zip(seen.chunks_exact(n_taxels)) {
            if seen.iter().copied().all(is_pressure) {
                continue;
            }
            for (reading, seen) in row.iter_mut().zip(seen) {
                if sees_all || !is_pressure(*seen) {
                    *reading = f64::NAN;
                }
            }
        }
    }

    /// Sets the last readings to zero, as a tare of a real sensor does. Before the first frame it
    /// does nothing.
    pub fn tare(&mut self) {
        self.zero_kpa.copy_from_slice(&self.untared_kpa);
    }

    /// Sets the readings of sensors without contact to zero.
    pub fn tare_untouched(&mut self) {
        let mut untouched = self.twin.state();
        let mut zero_kpa = vec![0.0; self.gains.len()];
        untouched.step(0.0, &vec![0.0; self.gains.len()], &mut zero_kpa);
        for own in self.zero_kpa.chunks_exact_mut(self.gains.len().max(1)) {
            own.copy_from_slice(&zero_kpa);
        }
    }

    /// Lets the gel of one sensor, counted from 0, rest until its next frame. Its zero stays.
    ///
    /// # Panics
    /// If the sensor does not exist.
    pub fn rest(&mut self, sensor: usize) {
        self.remembered.rest(sensor);
    }

    /// Relaxation and zero of one sensor, counted from 0.
    ///
    /// # Panics
    /// If the sensor does not exist.
    #[must_use]
    pub fn memory(&self, sensor: usize) -> TwinMemory {
        let own = self.taxels(sensor);
        TwinMemory {
            remembered: self.remembered.of_sensor(sensor),
            untared_kpa: self.untared_kpa[own.clone()].to_vec(),
            zero_kpa: self.zero_kpa[own].to_vec(),
        }
    }

    /// Lets one sensor, counted from 0, continue from a state of the same twin.
    ///
    /// # Panics
    /// If the sensor does not exist, or if the state belongs to a twin with another number of
    /// taxels or time constants.
    pub fn set_memory(&mut self, sensor: usize, memory: &TwinMemory) {
        let own = self.taxels(sensor);
        self.remembered.set_sensor(sensor, &memory.remembered);
        self.untared_kpa[own.clone()].copy_from_slice(&memory.untared_kpa);
        self.zero_kpa[own].copy_from_slice(&memory.zero_kpa);
    }

    fn taxels(&self, sensor: usize) -> std::ops::Range<usize> {
        let n_taxels = self.gains.len();
        sensor * n_taxels..(sensor + 1) * n_taxels
    }

    /// The twin that is stepped.
    #[must_use]
    pub fn twin(&self) -> &Twin {
        &self.twin
    }
}
