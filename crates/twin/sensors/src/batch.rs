//! Sensors from what touches to what is read.

use digitac::{Twin, TwinState};
use glam::{DQuat, DVec3, Vec3};
use rayon::prelude::*;
use twintac_fast::{Body, FastGel, FastGelMismatch, FastReader, Touch};
use twintac_shape::Pose;

use crate::hold::Holds;
use crate::sensor::Sensor;
use crate::{Coupling, Imperfection};

/// Many sensors of one kind, with the memory that steps need: it is kept from step to step.
#[derive(Clone, Debug)]
pub struct SensorBatch {
    imperfection: Imperfection,
    seed: u64,
    n_taxels: usize,
    coupling: Option<Coupling>,
    chunks: Vec<Chunk>,
    /// Sensors of each chunk but the last.
    of_chunk: usize,
}

/// Sensors that one thread steps.
#[derive(Clone, Debug)]
struct Chunk {
    sensors: Vec<Sensor>,
    /// `[n_sensors]`
    holds: Vec<Holds>,
    gel: FastReader,
    /// What touches, as the sensors that are not where they should be feel it.
    touches: Vec<Touch>,
    /// Where each sensor's touches end. `[n_sensors]`
    ends: Vec<usize>,
    twin: Option<TwinState>,
    /// What the gels show, in single and in double precision, and what perfect sensors would read of it. `[n_sensors * n_taxels]`
    pressure_kpa: Vec<f32>,
    /// Of each touch, in the frame in which its sensor should be. `[n_touches]`, if bodies and gels hold each other.
    wrench_of_touch: Vec<[f32; 6]>,
    seen: Vec<f64>,
    true_kpa: Vec<f64>,
}

/// What happens in a step.
struct Moment<'a> {
    imperfection: &'a Imperfection,
    coupling: Option<&'a Coupling>,
    since_previous_s: f64,
    bodies: &'a [Body],
    touches: &'a [Touch],
    ends: &'a [usize],
}

impl SensorBatch {
    /// So many sensors whose gels have rested, for so many threads. Sensor `n` is the same under the same seed, whatever the other sensors are and however many
    /// threads there are.
    ///
    /// With a twin, readings are those of its barometers; without, the pressures at the ports.
    ///
    /// # Panics
    /// A twin of another number of taxels than the gel has.
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
        let of_chunk = n_sensors.div_ceil(n_threads.max(1)).max(1);
        let gel = gel.reader();
        let chunk = |first: usize| {
            let numbers = first..(first + of_chunk).min(n_sensors);
            let n = numbers.len();
            Chunk {
                sensors: numbers
                    .map(|number| Sensor::draw(&imperfection, n_taxels, seed, number as u64))
                    .collect(),
                twin: twin.map(|twin| {
                    let mut twin = twin.states(n);
                    twin.tare_untouched();
                    twin
                }),
                holds: vec![Holds::default(); n],
                gel: gel.clone(),
                touches: Vec::new(),
                ends: Vec::with_capacity(n),
                pressure_kpa: vec![0.0; n * n_taxels],
                wrench_of_touch: Vec::new(),
                seen: vec![0.0; n * n_taxels],
                true_kpa: vec![0.0; n * n_taxels],
            }
        };
        Self {
            chunks: (0..n_sensors).step_by(of_chunk).map(chunk).collect(),
            imperfection,
            seed,
            n_taxels,
            coupling: None,
            of_chunk,
        }
    }

    /// The same sensors, which hold what touches them, with friction and loss.
    ///
    /// # Errors
    /// Friction on another gel.
    pub fn with_coupling(mut self, mut coupling: Coupling) -> Result<Self, FastGelMismatch> {
        if let Some(chunk) = self.chunks.first() {
            coupling.friction.check(&chunk.gel)?;
        }
        self.coupling = Some(coupling);
        Ok(self)
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
            coupling: self.coupling.clone(),
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
    ///   `[n_sensors]`. With what a [`Coupling`] adds.
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
        let n_sensors = self.n_sensors();
        let n_readings = n_sensors * self.n_taxels;
        assert_eq!(
            readings_kpa.len(),
            n_readings,
            "a reading for each taxel of each sensor"
        );
        assert_eq!(wrench.len(), n_sensors, "a wrench for each sensor");
        assert_eq!(ends.len(), n_sensors, "an end for each sensor");
        assert_eq!(
            ends.last().copied().unwrap_or(0),
            touches.len(),
            "the last end is the number of touches"
        );
        let moment = Moment {
            imperfection: &self.imperfection,
            coupling: self.coupling.as_ref(),
            since_previous_s,
            bodies,
            touches,
            ends,
        };
        if let [chunk] = self.chunks.as_mut_slice() {
            // Nobody has to be woken.
            chunk.step(&moment, 0, readings_kpa, wrench);
            return;
        }
        let of_chunk = self.of_chunk;
        let readings = readings_kpa.par_chunks_mut(of_chunk * self.n_taxels);
        let numbers = readings.zip(wrench.par_chunks_mut(of_chunk));
        let work = self.chunks.par_iter_mut().zip(numbers).enumerate();
        work.for_each(|(number, (chunk, (readings_kpa, wrench)))| {
            chunk.step(&moment, number * of_chunk, readings_kpa, wrench);
        });
    }

    /// One more moment in which everything stays where it was in the last step, as a step with the same touches would have it: gels are not read anew.
    /// Sensors that were replaced since then have to be stepped first.
    ///
    /// - `since_previous_s`, `readings_kpa`: as [`Self::step`] takes them.
    ///
    /// # Panics
    /// Readings of another length; sensors with a [`Coupling`], whose gels go on to give way.
    pub fn stay(&mut self, since_previous_s: f64, readings_kpa: &mut [f32]) {
        assert_eq!(
            readings_kpa.len(),
            self.n_sensors() * self.n_taxels,
            "a reading for each taxel of each sensor"
        );
        assert!(self.coupling.is_none(), "sensors that hold nothing");
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

    /// What each body did in the last step by itself, in the order of the touches: force on the gel, N, and torque about the top of the gel's middle, N mm, in the
    /// frame in which the sensor should be. Sensors without a [`Coupling`] have none.
    pub fn wrench_of_touches(&self) -> impl Iterator<Item = &[f32; 6]> {
        self.chunks.iter().flat_map(|chunk| &chunk.wrench_of_touch)
    }

    /// Lets the gel of one sensor rest until its next step, with the imperfections that it has.
    ///
    /// # Panics
    /// A sensor that is not there.
    pub fn rest(&mut self, sensor: usize) {
        let (chunk, own) = (&mut self.chunks[sensor / self.of_chunk], sensor % self.of_chunk);
        chunk.sensors[own].rest();
        chunk.holds[own] = Holds::default();
        if let Some(twin) = &mut chunk.twin {
            twin.rest(own);
        }
    }

    /// Puts another sensor in the place of one, with imperfections that are drawn anew, and lets it rest. `number` tells new sensors apart:
    /// those below the number of sensors are the first ones.
    ///
    /// # Panics
    /// A sensor that is not there.
    pub fn replace(&mut self, sensor: usize, number: u64) {
        let drawn = Sensor::draw(&self.imperfection, self.n_taxels, self.seed, number);
        self.chunks[sensor / self.of_chunk].sensors[sensor % self.of_chunk] = drawn;
        self.rest(sensor);
    }
}

impl Chunk {
    /// One more moment of these sensors, of which the first one has this number.
    fn step(&mut self, moment: &Moment, first: usize, readings_kpa: &mut [f32], wrench: &mut [[f32; 6]]) {
        self.mount(moment, first);
        let (touches, ends) = (&self.touches, &self.ends);
        self.gel
            .read_many(moment.bodies, touches, ends, &mut self.pressure_kpa, wrench);
        if let Some(coupling) = moment.coupling {
            self.hold(moment, coupling, wrench);
        }
        self.sense(moment.imperfection, moment.since_previous_s, readings_kpa);
    }

    /// What sensors deliver of what their gels show.
    fn sense(&mut self, imperfection: &Imperfection, since_previous_s: f64, readings_kpa: &mut [f32]) {
        for (seen, pressure_kpa) in self.seen.iter_mut().zip(&self.pressure_kpa) {
            *seen = f64::from(*pressure_kpa);
        }
        let true_kpa = match &mut self.twin {
            Some(twin) => {
                twin.step(since_previous_s, &self.seen, &mut self.true_kpa);
                &self.true_kpa
            }
            None => &self.seen,
        };
        let n_taxels = self.gel.n_taxels().max(1);
        let taxels = true_kpa
            .chunks_exact(n_taxels)
            .zip(readings_kpa.chunks_exact_mut(n_taxels));
        for (sensor, (true_kpa, readings_kpa)) in self.sensors.iter_mut().zip(taxels) {
            sensor.step(imperfection, since_previous_s, true_kpa, readings_kpa);
        }
    }

    /// Friction and loss of each body on each gel.
    fn hold(&mut self, moment: &Moment, coupling: &Coupling, wrench: &mut [[f32; 6]]) {
        self.wrench_of_touch.clear();
        self.wrench_of_touch.resize(self.touches.len(), [0.0; 6]);
        let n_taxels = self.gel.n_taxels().max(1);
        let pressures = self.pressure_kpa.chunks_exact_mut(n_taxels);
        let sensors = self
            .sensors
            .iter()
            .zip(&mut self.holds)
            .zip(pressures)
            .zip(wrench);
        let mut start = 0;
        for ((((sensor, holds), pressure_kpa), wrench), end) in sensors.zip(&self.ends) {
            let own = start..*end;
            start = *end;
            let (touches, apart) = (&self.touches[own.clone()], &mut self.wrench_of_touch[own]);
            holds.step(
                coupling,
                moment.since_previous_s,
                &mut self.gel,
                (moment.bodies, touches),
                pressure_kpa,
                (wrench, apart),
            );
            let described_from_actual = sensor.actual_from_described.rotation.inverse().as_quat();
            for wrench in apart {
                for part in wrench.as_chunks_mut::<3>().0 {
                    *part = (described_from_actual * Vec3::from_array(*part)).to_array();
                }
            }
        }
    }

    /// What touches, seen from where the sensors are.
    fn mount(&mut self, moment: &Moment, first: usize) {
        self.touches.clear();
        self.ends.clear();
        let mut start = if first == 0 { 0 } else { moment.ends[first - 1] };
        for (sensor, end) in self.sensors.iter().zip(&moment.ends[first..]) {
            let actual = &sensor.actual_from_described;
            let is_elsewhere = actual.rotation != DQuat::IDENTITY || actual.position_mm != DVec3::ZERO;
            for touch in &moment.touches[start..*end] {
                let mut touch = *touch;
                if is_elsewhere {
                    touch.gel_from_body = Pose {
                        position_mm: actual.position_mm + actual.rotation * touch.gel_from_body.position_mm,
                        rotation: actual.rotation * touch.gel_from_body.rotation,
                    };
                }
                self.touches.push(touch);
            }
            self.ends.push(self.touches.len());
            start = *end;
        }
    }
}
