//! Many sensors, from bodies and poses to readings.

use digitac::Twin;
use rayon::prelude::*;
use twintac_fast::{Body, FastGel, Touch};

use crate::SensorVariation;
use crate::chunk::{Chunk, Moment};
use crate::sensor::Sensor;
use crate::state::SensorState;

/// Largest number of readings of all sensors of a batch; they take about a gigabyte.
const MOST_READINGS: usize = 10_000_000;

/// Largest number of sensors of a batch, each with this number of taxels.
#[must_use]
pub fn most_sensors(n_taxels: usize) -> usize {
    MOST_READINGS / n_taxels.max(8)
}

/// Many sensors of one kind, with the memory that steps need, which is kept from step to step.
/// Bodies are felt without friction and loss; [`CoupledBatch`](crate::CoupledBatch) has both.
#[derive(Clone, Debug)]
pub struct SensorBatch {
    variation: SensorVariation,
    seed: u64,
    n_taxels: usize,
    pub(crate) chunks: Vec<Chunk>,
    /// Sensors of each chunk but the last.
    of_chunk: usize,
}

impl SensorBatch {
    /// Sensors with relaxed gels, distributed over threads. Sensor `n` is the same for the same
    /// seed, whatever the other sensors are and however many threads there are.
    ///
    /// With a twin, readings are those of its barometers; without, they are the pressures at the
    /// ports. Both include the sensors' variation.
    ///
    /// # Panics
    /// If the twin has another number of taxels than the gel, or if there are more sensors than
    /// [`most_sensors`].
    #[must_use]
    pub fn new(
        gel: &FastGel,
        twin: Option<&Twin>,
        variation: SensorVariation,
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
                .map(|number| Sensor::draw(&variation, n_taxels, seed, number))
                .collect();
            Chunk::new(sensors, reader.clone(), twin)
        };
        Self {
            chunks: (0..n_sensors).step_by(of_chunk).map(chunk).collect(),
            variation,
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

    /// Divides the batch into one batch for each thread, for a caller that steps them on its own
    /// threads. The sensors continue as they would have; shared data are not copied.
    #[must_use]
    pub fn into_parts(self) -> Vec<Self> {
        let part = |chunk: Chunk| Self {
            variation: self.variation.clone(),
            seed: self.seed,
            n_taxels: self.n_taxels,
            of_chunk: self.of_chunk,
            chunks: vec![chunk],
        };
        self.chunks.into_iter().map(part).collect()
    }

    /// One step of every sensor.
    ///
    /// - `since_previous_s`: time since the last step, s, not negative.
    /// - `bodies`, `touches`, `ends`: the bodies at each sensor, as
    ///   [`FastBatch::read`](twintac_fast::FastBatch::read) takes them. Poses are in the frame of
    ///   the sensor as it is described.
    /// - `readings_kpa`: output; the last frame that the bus of each sensor delivered, kPa.
    ///   `[n_sensors * n_taxels]`
    /// - `wrench`: output; force on each gel, N, and torque about the top of its middle, N mm, in
    ///   the actual frame of the sensor. `[n_sensors]`
    ///
    /// # Panics
    /// Those of [`FastBatch::read`](twintac_fast::FastBatch::read).
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
            |variation, chunk, first, readings_kpa, wrench| {
                chunk.read(&moment, first, wrench);
                chunk.stiffen(wrench);
                chunk.sense(variation, since_previous_s, readings_kpa);
            },
        );
    }

    /// Calls `work` for the sensors of each thread, with the number of the first of them.
    pub(crate) fn each(
        &mut self,
        readings_kpa: &mut [f32],
        wrench: &mut [[f32; 6]],
        work: impl Fn(&SensorVariation, &mut Chunk, usize, &mut [f32], &mut [[f32; 6]]) + Sync,
    ) {
        let (variation, of_chunk) = (&self.variation, self.of_chunk);
        if let [chunk] = self.chunks.as_mut_slice() {
            // A single thread does not need the thread pool.
            work(variation, chunk, 0, readings_kpa, wrench);
            return;
        }
        let readings = readings_kpa.par_chunks_mut(of_chunk * self.n_taxels);
        let numbers = readings.zip(wrench.par_chunks_mut(of_chunk));
        let chunks = self.chunks.par_iter_mut().zip(numbers).enumerate();
        chunks.for_each(|(number, (chunk, (readings_kpa, wrench)))| {
            work(variation, chunk, number * of_chunk, readings_kpa, wrench);
        });
    }

    /// Panics if a slice has another length.
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

    /// One step in which everything stays where it was in the last step. The result is the one of a
    /// step with the same touches, but the gels are not evaluated again. Sensors that were replaced
    /// since the last step have to be stepped first.
    ///
    /// - `since_previous_s`, `readings_kpa`: as in [`Self::step`].
    ///
    /// # Panics
    /// If the slice of readings has another length.
    pub fn stay(&mut self, since_previous_s: f64, readings_kpa: &mut [f32]) {
        assert_eq!(
            readings_kpa.len(),
            self.n_sensors() * self.n_taxels,
            "a reading for each taxel of each sensor"
        );
        let variation = &self.variation;
        if let [chunk] = self.chunks.as_mut_slice() {
            // A single thread does not need the thread pool.
            chunk.sense(variation, since_previous_s, readings_kpa);
            return;
        }
        let readings = readings_kpa.par_chunks_mut(self.of_chunk * self.n_taxels);
        let work = self.chunks.par_iter_mut().zip(readings);
        work.for_each(|(chunk, readings_kpa)| chunk.sense(variation, since_previous_s, readings_kpa));
    }

    /// What sensors without variation would have delivered in the last step, kPa: the pressures at
    /// the ports, or the readings of the twin. `[n_sensors * n_taxels]`
    pub fn ground_truth_kpa(&self) -> impl Iterator<Item = f32> + '_ {
        self.chunks.iter().flat_map(Chunk::ground_truth_kpa)
    }

    /// How near the bodies were to each sensor in the last step
    /// ([`FastReader::proximity`](twintac_fast::FastReader::proximity)). `[n_sensors]`
    pub fn proximity(&self) -> impl Iterator<Item = f32> + '_ {
        self.chunks
            .iter()
            .flat_map(|chunk| chunk.gel().proximity().iter().copied())
    }

    /// Resets the gel and the read-out of one sensor to rest. Its deviations stay.
    ///
    /// # Panics
    /// If there is no such sensor.
    pub fn rest(&mut self, sensor: usize) {
        let (chunk, own) = self.place(sensor);
        self.chunks[chunk].rest(own);
    }

    /// Replaces a sensor by another one at rest, whose deviations are drawn anew. `number`
    /// identifies the new sensor: numbers below the number of sensors give the first sensors of the
    /// batch.
    ///
    /// # Panics
    /// If there is no such sensor.
    pub fn replace(&mut self, sensor: usize, number: u64) {
        let drawn = Sensor::draw(&self.variation, self.n_taxels, self.seed, number);
        let (chunk, own) = self.place(sensor);
        self.chunks[chunk].replace(own, drawn);
    }

    /// The state of a sensor, counted from 0. A sensor that is set back to it continues with the
    /// same bits.
    ///
    /// # Panics
    /// If there is no such sensor.
    #[must_use]
    pub fn state(&self, sensor: usize) -> SensorState {
        let (chunk, own) = self.place(sensor);
        self.chunks[chunk].state(own)
    }

    /// Sets a sensor to a state, its own or that of another sensor of its kind.
    ///
    /// # Panics
    /// If there is no such sensor, or if the state has another number of taxels, or belongs to a
    /// sensor with a twin where this batch has none, or the reverse.
    pub fn set_state(&mut self, sensor: usize, state: &SensorState) {
        let (chunk, own) = self.place(sensor);
        self.chunks[chunk].set_state(own, state);
    }

    /// The chunk of a sensor, and its number in the chunk.
    fn place(&self, sensor: usize) -> (usize, usize) {
        (sensor / self.of_chunk, sensor % self.of_chunk)
    }
}
