//! Sensors from what touches to what is read.

use digitac::Twin;
use rayon::prelude::*;
use twintac_fast::{Body, FastGel, Touch};

use crate::Imperfection;
use crate::chunk::{Chunk, Moment};
use crate::sensor::Sensor;
use crate::state::SensorState;

/// Most readings of all sensors of a batch, which take about a gigabyte.
const MOST_READINGS: usize = 10_000_000;

/// Most sensors of a batch, each with so many taxels.
#[must_use]
pub fn most_sensors(n_taxels: usize) -> usize {
    MOST_READINGS / n_taxels.max(8)
}

/// Many sensors of one kind, with the memory that steps need: it is kept from step to step. What
/// touches them is read and not held: [`CoupledBatch`](crate::CoupledBatch)
/// has friction and loss.
#[derive(Clone, Debug)]
pub struct SensorBatch {
    imperfection: Imperfection,
    seed: u64,
    n_taxels: usize,
    pub(crate) chunks: Vec<Chunk>,
    /// Sensors of each chunk but the last.
    of_chunk: usize,
}

impl SensorBatch {
    /// So many sensors whose gels have rested, for so many threads. Sensor `n` is the same under the same seed, whatever the other sensors are and however many
    /// threads there are.
    ///
    /// With a twin, readings are those of its barometers; without, the pressures at the ports.
    ///
    /// # Panics
    /// A twin of another number of taxels than the gel has; more sensors than [`most_sensors`].
    #[must_use]
    pub fn new(
        gel: &FastGel,
        twin: Option<&Twin>,
        imperfection: Imperfection,
        [n_sensors, n_threads]: [usize; 2],
        seed: u64,
    ) -> Self {
        let n_taxels = gel.n_taxels();
        if let Some(twin) = twin {
            assert_eq!(
                twin.taxels().len(),
                n_taxels,
                "a twin of as many taxels as the gel has"
            );
        }
        let most = most_sensors(n_taxels);
        assert!(n_sensors <= most, "at most {most} sensors of {n_taxels} taxels");
        let of_chunk = n_sensors.div_ceil(n_threads.max(1)).max(1);
        let reader = gel.reader();
        let chunk = |first: usize| {
            let numbers = first as u64..(first + of_chunk).min(n_sensors) as u64;
            let sensors = numbers
                .map(|number| Sensor::draw(&imperfection, n_taxels, seed, number))
                .collect();
            Chunk::new(sensors, reader.clone(), twin)
        };
        Self {
            chunks: (0..n_sensors).step_by(of_chunk).map(chunk).collect(),
            imperfection,
            seed,
            n_taxels,
            of_chunk,
        }
    }

    /// Number of sensors.
    #[must_use]
    pub fn n_sensors(&self) -> usize {
        self.chunks.iter().map(|chunk| chunk.sensors.len()).sum()
    }

    /// Number of taxels of a sensor.
    #[must_use]
    pub fn n_taxels(&self) -> usize {
        self.n_taxels
    }

    /// The sensors of each thread as a batch of its own, for a caller that steps them on threads of its own. They go on as they would have; what they share is not copied.
    #[must_use]
    pub fn into_parts(self) -> Vec<Self> {
        let part = |chunk: Chunk| Self {
            imperfection: self.imperfection.clone(),
            seed: self.seed,
            n_taxels: self.n_taxels,
            of_chunk: self.of_chunk,
            chunks: vec![chunk],
        };
        self.chunks.into_iter().map(part).collect()
    }

    /// One more moment of every sensor.
    ///
    /// - `since_previous_s`: time since the last step, s, not negative.
    /// - `bodies`, `touches`, `ends`: what touches whom, as [`FastBatch::read`] takes it. Poses are in the frame in which the sensor should be.
    /// - `readings_kpa`: is written; what the bus of each sensor delivered last, kPa. `[n_sensors * n_taxels]`
    /// - `wrench`: is written; force on each gel, N, and torque about the top of its middle, N mm, in the frame of the sensor where it is.
    ///   `[n_sensors]`.
    ///
    /// # Panics
    /// Those of [`FastBatch::read`].
    pub fn step(
        &mut self,
        since_previous_s: f64,
        bodies: &[Body],
        touches: &[Touch],
        ends: &[usize],
        readings_kpa: &mut [f32],
        wrench: &mut [[f32; 6]],
    ) {
        self.check(ends, touches.len(), readings_kpa, wrench);
        let moment = Moment {
            since_previous_s,
            bodies,
            touches,
            ends,
        };
        self.each(
            readings_kpa,
            wrench,
            |imperfection, chunk, first, readings_kpa, wrench| {
                chunk.read(&moment, first, wrench);
                chunk.sense(imperfection, since_previous_s, readings_kpa);
            },
        );
    }

    /// Lets every thread work on its sensors, of which the first has this number.
    pub(crate) fn each(
        &mut self,
        readings_kpa: &mut [f32],
        wrench: &mut [[f32; 6]],
        work: impl Fn(&Imperfection, &mut Chunk, usize, &mut [f32], &mut [[f32; 6]]) + Sync,
    ) {
        let (imperfection, of_chunk) = (&self.imperfection, self.of_chunk);
        if let [chunk] = self.chunks.as_mut_slice() {
            // Nobody has to be woken.
            work(imperfection, chunk, 0, readings_kpa, wrench);
            return;
        }
        let readings = readings_kpa.par_chunks_mut(of_chunk * self.n_taxels);
        let numbers = readings.zip(wrench.par_chunks_mut(of_chunk));
        let chunks = self.chunks.par_iter_mut().zip(numbers).enumerate();
        chunks.for_each(|(number, (chunk, (readings_kpa, wrench)))| {
            work(imperfection, chunk, number * of_chunk, readings_kpa, wrench);
        });
    }

    /// Panics at slices of other lengths.
    pub(crate) fn check(&self, ends: &[usize], n_touches: usize, readings_kpa: &[f32], wrench: &[[f32; 6]]) {
        let n_sensors = self.n_sensors();
        assert_eq!(
            readings_kpa.len(),
            n_sensors * self.n_taxels,
            "a reading for each taxel of each sensor"
        );
        assert_eq!(wrench.len(), n_sensors, "a wrench for each sensor");
        assert_eq!(ends.len(), n_sensors, "an end for each sensor");
        assert_eq!(
            ends.last().copied().unwrap_or(0),
            n_touches,
            "the last end is the number of touches"
        );
    }

    /// One more moment in which everything stays where it was in the last step, as a step with the same touches would have it: gels are not read anew.
    /// Sensors that were replaced since then have to be stepped first.
    ///
    /// - `since_previous_s`, `readings_kpa`: as [`Self::step`] takes them.
    ///
    /// # Panics
    /// Readings of another length.
    pub fn stay(&mut self, since_previous_s: f64, readings_kpa: &mut [f32]) {
        assert_eq!(
            readings_kpa.len(),
            self.n_sensors() * self.n_taxels,
            "a reading for each taxel of each sensor"
        );
        let imperfection = &self.imperfection;
        if let [chunk] = self.chunks.as_mut_slice() {
            // Nobody has to be woken.
            chunk.sense(imperfection, since_previous_s, readings_kpa);
            return;
        }
        let readings = readings_kpa.par_chunks_mut(self.of_chunk * self.n_taxels);
        let work = self.chunks.par_iter_mut().zip(readings);
        work.for_each(|(chunk, readings_kpa)| chunk.sense(imperfection, since_previous_s, readings_kpa));
    }

    /// Lets the gel of one sensor rest until its next step, with the imperfections that it has.
    ///
    /// # Panics
    /// A sensor that is not there.
    pub fn rest(&mut self, sensor: usize) {
        let (chunk, own) = self.place(sensor);
        self.chunks[chunk].rest(own);
    }

    /// Puts another sensor in the place of one, with imperfections that are drawn anew, and lets it rest. `number` tells new sensors apart:
    /// those below the number of sensors are the first ones.
    ///
    /// # Panics
    /// A sensor that is not there.
    pub fn replace(&mut self, sensor: usize, number: u64) {
        let drawn = Sensor::draw(&self.imperfection, self.n_taxels, self.seed, number);
        let (chunk, own) = self.place(sensor);
        self.chunks[chunk].replace(own, drawn);
    }

    /// What a sensor is and remembers, counted from 0: set back, it goes on to the same bits.
    ///
    /// # Panics
    /// A sensor that is not there.
    #[must_use]
    pub fn state(&self, sensor: usize) -> SensorState {
        let (chunk, own) = self.place(sensor);
        self.chunks[chunk].state(own)
    }

    /// Lets a sensor go on from a state, of its own or of another one of its kind.
    ///
    /// # Panics
    /// A sensor that is not there, a state of another number of taxels, or of sensors with a twin
    /// where these have none.
    pub fn set_state(&mut self, sensor: usize, state: &SensorState) {
        let (chunk, own) = self.place(sensor);
        self.chunks[chunk].set_state(own, state);
    }

    /// In which chunk a sensor is, and its number there.
    fn place(&self, sensor: usize) -> (usize, usize) {
        (sensor / self.of_chunk, sensor % self.of_chunk)
    }
}
