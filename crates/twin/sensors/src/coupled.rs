//! Sensors with friction and loss between their gels and bodies.

use thiserror::Error;
use twintac_fast::{Body, FastGelMismatch};

use crate::batch::SensorBatch;
use crate::chunk::Moment;
use crate::state::SensorState;
use crate::{Coupling, HeldTouch, TouchId};

/// Many sensors of one kind with friction and loss between their gels and the things that touch
/// them. What a gel remembers of a thing is stored under the thing's [`TouchId`].
#[derive(Clone, Debug)]
pub struct CoupledBatch {
    batch: SensorBatch,
    coupling: Coupling,
}

/// The error for one thing that touches a sensor twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("sensor {sensor} is touched twice by the body {}: give each body a number of its own", .id.0)]
pub struct TouchedTwice {
    /// Number of the sensor.
    pub sensor: usize,
    /// The thing.
    pub id: TouchId,
}

impl SensorBatch {
    /// The same sensors, with friction and loss.
    ///
    /// # Errors
    /// Friction on another gel.
    pub fn with_coupling(self, mut coupling: Coupling) -> Result<CoupledBatch, FastGelMismatch> {
        if let Some(chunk) = self.chunks.first() {
            coupling.friction.check(chunk.gel())?;
        }
        Ok(CoupledBatch {
            batch: self,
            coupling,
        })
    }
}

impl CoupledBatch {
    /// Number of sensors.
    #[must_use]
    pub fn n_sensors(&self) -> usize {
        self.batch.n_sensors()
    }

    /// Number of taxels of a sensor.
    #[must_use]
    pub fn n_taxels(&self) -> usize {
        self.batch.n_taxels()
    }

    /// One step of every sensor: as [`SensorBatch::step`], with what the [`Coupling`] adds to
    /// readings and wrenches.
    ///
    /// A thing that was absent in the step before is new: its friction begins at its pose, and its
    /// loss begins with the next step.
    ///
    /// # Errors
    /// A thing that touches one sensor twice; then no sensor has been changed.
    ///
    /// # Panics
    /// Those of [`SensorBatch::step`].
    pub fn step(
        &mut self,
        since_previous_s: f64,
        bodies: &[Body],
        touches: &[HeldTouch],
        ends: &[usize],
        readings_kpa: &mut [f32],
        wrench: &mut [[f32; 6]],
    ) -> Result<(), TouchedTwice> {
        self.batch.check(ends, touches.len(), readings_kpa, wrench);
        each_once(touches, ends)?;
        let moment = Moment {
            since_previous_s,
            bodies,
            touches,
            ends,
        };
        let coupling = &self.coupling;
        self.batch.each(
            readings_kpa,
            wrench,
            |variation, chunk, first, readings_kpa, wrench| {
                chunk.read(&moment, first, wrench);
                chunk.hold(&moment, first, coupling, wrench);
                chunk.stiffen(wrench);
                chunk.sense(variation, since_previous_s, readings_kpa);
            },
        );
        Ok(())
    }

    /// The wrench of each touch by itself in the last step, in the order of the touches: force on
    /// the gel, N, and torque about the centre of the top of its bounding box, N mm, in the frame
    /// of the sensor as described.
    pub fn wrench_of_touches(&self) -> impl Iterator<Item = &[f32; 6]> {
        self.batch.chunks.iter().flat_map(|chunk| &chunk.wrench_of_touch)
    }

    /// How fast each touch slipped over its gel in the last step, mm/s, along x and y of the gel,
    /// in the order of the touches: 0 while it sticks or does not touch.
    pub fn slip_of_touches(&self) -> impl Iterator<Item = &[f32; 2]> {
        self.batch.chunks.iter().flat_map(|chunk| &chunk.slip_of_touch)
    }

    /// [`SensorBatch::ground_truth_kpa`].
    pub fn ground_truth_kpa(&self) -> impl Iterator<Item = f32> + '_ {
        self.batch.ground_truth_kpa()
    }

    /// [`SensorBatch::proximity`].
    pub fn proximity(&self) -> impl Iterator<Item = f32> + '_ {
        self.batch.proximity()
    }

    /// [`SensorBatch::rest`].
    ///
    /// # Panics
    /// If there is no such sensor.
    pub fn rest(&mut self, sensor: usize) {
        self.batch.rest(sensor);
    }

    /// [`SensorBatch::replace`].
    ///
    /// # Panics
    /// If there is no such sensor.
    pub fn replace(&mut self, sensor: usize, number: u64) {
        self.batch.replace(sensor, number);
    }

    /// [`SensorBatch::state`], with what the gel holds.
    ///
    /// # Panics
    /// If there is no such sensor.
    #[must_use]
    pub fn state(&self, sensor: usize) -> SensorState {
        self.batch.state(sensor)
    }

    /// [`SensorBatch::set_state`].
    ///
    /// # Panics
    /// Those of [`SensorBatch::set_state`].
    pub fn set_state(&mut self, sensor: usize, state: &SensorState) {
        self.batch.set_state(sensor, state);
    }
}

/// Checks that every thing touches each sensor at most once. Sensors have few touches, so a linear
/// search is faster than sorting.
fn each_once(touches: &[HeldTouch], ends: &[usize]) -> Result<(), TouchedTwice> {
    let mut start = 0;
    for (sensor, end) in ends.iter().enumerate() {
        let own = &touches[start..*end];
        start = *end;
        for (place, held) in own.iter().enumerate() {
            if own[..place].iter().any(|before| before.id == held.id) {
                return Err(TouchedTwice { sensor, id: held.id });
            }
        }
    }
    Ok(())
}
