//! The sensors of one thread.

use digitac::{Twin, TwinState};
use glam::{DQuat, DVec3, Vec3};
use twintac_fast::{Body, FastReader, Touch};
use twintac_shape::Pose;

use crate::hold::{Holding, Holds};
use crate::sensor::Sensor;
use crate::state::SensorState;
use crate::{Coupling, HeldTouch, SensorVariation};

/// The sensors of one thread.
#[derive(Clone, Debug)]
pub(crate) struct Chunk {
    pub(crate) sensors: Vec<Sensor>,
    /// What the gel of each sensor holds, in a [`CoupledBatch`](crate::CoupledBatch). `[n_sensors]`
    holds: Vec<Holds>,
    holding: Holding,
    gel: FastReader,
    /// The touches in the actual frames of the sensors.
    touches: Vec<Touch>,
    /// Where each sensor's touches end. `[n_sensors]`
    ends: Vec<usize>,
    twin: Option<TwinState>,
    /// Pressures of the gels in single and in double precision, and readings of ideal sensors, kPa.
    /// `[n_sensors * n_taxels]`
    pressure_kpa: Vec<f32>,
    seen: Vec<f64>,
    true_kpa: Vec<f64>,
    /// The wrench of each touch, in the frame of its sensor as described; in a
    /// [`CoupledBatch`](crate::CoupledBatch) only. `[n_touches]`
    pub(crate) wrench_of_touch: Vec<[f32; 6]>,
    /// How fast each touch slips over its gel, mm/s, along x and y of the gel; in a
    /// [`CoupledBatch`](crate::CoupledBatch) only. `[n_touches]`
    pub(crate) slip_of_touch: Vec<[f32; 2]>,
}

/// Inputs of a step, for all sensors.
pub(crate) struct Moment<'a, T> {
    pub(crate) since_previous_s: f64,
    pub(crate) bodies: &'a [Body],
    pub(crate) touches: &'a [T],
    pub(crate) ends: &'a [usize],
}

impl<T> Moment<'_, T> {
    /// Where the touches of a sensor begin.
    fn start(&self, sensor: usize) -> usize {
        if sensor == 0 { 0 } else { self.ends[sensor - 1] }
    }
}

impl Chunk {
    /// Sensors with relaxed gels.
    pub(crate) fn new(sensors: Vec<Sensor>, gel: FastReader, twin: Option<&Twin>) -> Self {
        let n = sensors.len();
        let n_readings = n * gel.n_taxels();
        Self {
            twin: twin.map(|twin| {
                let mut twin = twin.states(n);
                twin.tare_untouched();
                twin
            }),
            holds: vec![Holds::default(); n],
            holding: Holding::of(gel.n_taxels()),
            touches: Vec::new(),
            ends: Vec::with_capacity(n),
            pressure_kpa: vec![0.0; n_readings],
            seen: vec![0.0; n_readings],
            true_kpa: vec![0.0; n_readings],
            wrench_of_touch: Vec::new(),
            slip_of_touch: Vec::new(),
            sensors,
            gel,
        }
    }

    /// The surrogate of their gel.
    pub(crate) fn gel(&self) -> &FastReader {
        &self.gel
    }

    /// Evaluates the gels; `first` is the number of the first sensor.
    pub(crate) fn read<T: Copy + Into<Touch>>(
        &mut self,
        moment: &Moment<T>,
        first: usize,
        wrench: &mut [[f32; 6]],
    ) {
        self.mount(moment, first);
        let (touches, ends) = (&self.touches, &self.ends);
        self.gel
            .read_many(moment.bodies, touches, ends, &mut self.pressure_kpa, wrench);
    }

    /// Scales all forces and pressures after [`Self::read`] and [`Self::hold`] to the moduli of the
    /// gels: at given poses, stresses are proportional to the modulus.
    pub(crate) fn stiffen(&mut self, wrench: &mut [[f32; 6]]) {
        let n_taxels = self.gel.n_taxels().max(1);
        let pressures = self.pressure_kpa.chunks_exact_mut(n_taxels);
        let sensors = self.sensors.iter().zip(&self.ends).zip(pressures).zip(wrench);
        let mut start = 0;
        for (((sensor, end), pressure_kpa), wrench) in sensors {
            let apart = self.wrench_of_touch.get_mut(start..*end).into_iter().flatten();
            start = *end;
            if sensor.modulus != 1.0 {
                for number in pressure_kpa.iter_mut().chain(wrench).chain(apart.flatten()) {
                    *number *= sensor.modulus;
                }
            }
        }
    }

    /// Computes the readings from the pressures of the gels.
    pub(crate) fn sense(
        &mut self,
        variation: &SensorVariation,
        since_previous_s: f64,
        readings_kpa: &mut [f32],
    ) {
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
            sensor.step(variation, since_previous_s, true_kpa, readings_kpa);
        }
    }

    /// What perfect sensors would have delivered in the last step, kPa. `[n_sensors * n_taxels]`
    pub(crate) fn ground_truth_kpa(&self) -> impl Iterator<Item = f32> + '_ {
        let of_twin = self
            .twin
            .is_some()
            .then(|| self.true_kpa.iter().map(|kpa| *kpa as f32));
        let of_gel = self.twin.is_none().then(|| self.pressure_kpa.iter().copied());
        of_twin.into_iter().flatten().chain(of_gel.into_iter().flatten())
    }

    /// Adds friction and loss to each touch after [`Self::read`]; `first` is the number of the
    /// first sensor.
    pub(crate) fn hold(
        &mut self,
        moment: &Moment<HeldTouch>,
        first: usize,
        coupling: &Coupling,
        wrench: &mut [[f32; 6]],
    ) {
        self.wrench_of_touch.clear();
        self.wrench_of_touch.resize(self.touches.len(), [0.0; 6]);
        self.slip_of_touch.clear();
        self.slip_of_touch.resize(self.touches.len(), [0.0; 2]);
        let n_taxels = self.gel.n_taxels().max(1);
        let pressures = self.pressure_kpa.chunks_exact_mut(n_taxels);
        let sensors = self
            .sensors
            .iter()
            .zip(&mut self.holds)
            .zip(pressures)
            .zip(wrench);
        let offset = moment.start(first);
        let mut start = 0;
        for ((((sensor, holds), pressure_kpa), wrench), end) in sensors.zip(&self.ends) {
            let own = start..*end;
            start = *end;
            let apart = &mut self.wrench_of_touch[own.clone()];
            let slip = &mut self.slip_of_touch[own.clone()];
            let ids = moment.touches[offset + own.start..].iter().map(|held| held.id);
            holds.step(
                coupling,
                moment.since_previous_s,
                (&mut self.gel, &mut self.holding),
                (moment.bodies, &self.touches[own], ids),
                pressure_kpa,
                (wrench, &mut *apart, slip),
            );
            let described_from_actual = sensor.actual_from_described.rotation.inverse().as_quat();
            for wrench in apart {
                for part in wrench.as_chunks_mut::<3>().0 {
                    *part = (described_from_actual * Vec3::from_array(*part)).to_array();
                }
            }
        }
    }

    /// Transforms the touches to the actual frames of the sensors.
    fn mount<T: Copy + Into<Touch>>(&mut self, moment: &Moment<T>, first: usize) {
        self.touches.clear();
        self.ends.clear();
        let mut start = moment.start(first);
        for (sensor, end) in self.sensors.iter().zip(&moment.ends[first..]) {
            let actual = &sensor.actual_from_described;
            let is_elsewhere = actual.rotation != DQuat::IDENTITY || actual.position_mm != DVec3::ZERO;
            for touch in &moment.touches[start..*end] {
                let mut touch: Touch = (*touch).into();
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

    /// Resets one sensor to rest.
    pub(crate) fn rest(&mut self, own: usize) {
        self.sensors[own].rest();
        self.holds[own] = Holds::default();
        if let Some(twin) = &mut self.twin {
            twin.rest(own);
        }
    }

    /// Replaces one sensor by another one at rest.
    pub(crate) fn replace(&mut self, own: usize, sensor: Sensor) {
        self.sensors[own] = sensor;
        self.rest(own);
    }

    /// The state of one sensor.
    pub(crate) fn state(&self, own: usize) -> SensorState {
        SensorState {
            sensor: self.sensors[own].clone(),
            holds: self.holds[own].clone(),
            twin: self.twin.as_ref().map(|twin| twin.memory(own)),
            pressure_kpa: self.pressure_kpa[self.taxels(own)].to_vec(),
        }
    }

    /// Sets one sensor to a state.
    pub(crate) fn set_state(&mut self, own: usize, state: &SensorState) {
        self.sensors[own].clone_from(&state.sensor);
        self.holds[own].clone_from(&state.holds);
        match (&mut self.twin, &state.twin) {
            (Some(twin), Some(memory)) => twin.set_memory(own, memory),
            (None, None) => {}
            _ => panic!("a state of sensors with a twin, or without, as these are"),
        }
        let taxels = self.taxels(own);
        self.pressure_kpa[taxels].copy_from_slice(&state.pressure_kpa);
    }

    fn taxels(&self, own: usize) -> std::ops::Range<usize> {
        let n_taxels = self.gel.n_taxels();
        own * n_taxels..(own + 1) * n_taxels
    }
}
