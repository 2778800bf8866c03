//! Sensors whose gels hold what touches them.

use thiserror::Error;
use twintac_fast::{Body, FastGelMismatch};

use crate::batch::SensorBatch;
use crate::chunk::Moment;
use crate::state::SensorState;
use crate::{Coupling, HeldTouch, TouchId};

/// Many sensors of one kind whose gels hold what touches them, with friction and loss. What each
/// remembers of a thing is kept under the thing's [`TouchId`].
#[derive(Clone, Debug)]
pub struct CoupledBatch {
    batch: SensorBatch,
    coupling: Coupling,
}

/// One thing twice on one sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("sensor {sensor} is touched twice by the thing {}: give each thing a number of its own", .id.0)]
pub struct TouchedTwice {
    /// Number of the sensor.
    pub sensor: usize,
    /// Which thing.
    pub id: TouchId,
}

impl SensorBatch {
    /// The same sensors, which hold what touches them, with friction and loss.
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

    /// One more moment of every sensor: what [`SensorBatch::step`] does, with what the [`Coupling`]
    /// adds to readings and wrenches.
    ///
    /// A thing that was not there in the step before is new: its friction begins where it is, and
    /// its loss with the next step.
    ///
    /// # Errors
    /// A thing that touches one sensor twice; nothing has been done then.
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
            |imperfection, chunk, first, readings_kpa, wrench| {
                chunk.read(&moment, first, wrench);
                chunk.hold(&moment, first, coupling, wrench);
                chunk.sense(imperfection, since_previous_s, readings_kpa);
            },
        );
        Ok(())
    }

    /// What each thing did in the last step by itself, in the order of the touches: force on the
    /// gel, N, and torque about the top of the gel's middle, N mm, in the
    /// frame in which the sensor should be.
    pub fn wrench_of_touches(&self) -> impl Iterator<Item = &[f32; 6]> {
        self.batch.chunks.iter().flat_map(|chunk| &chunk.wrench_of_touch)
    }

    /// [`SensorBatch::rest`].
    ///
    /// # Panics
    /// A sensor that is not there.
    pub fn rest(&mut self, sensor: usize) {
        self.batch.rest(sensor);
    }

    /// [`SensorBatch::replace`].
    ///
    /// # Panics
    /// A sensor that is not there.
    pub fn replace(&mut self, sensor: usize, number: u64) {
        self.batch.replace(sensor, number);
    }

    /// [`SensorBatch::state`], with what the gel holds.
    ///
    /// # Panics
    /// A sensor that is not there.
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

/// Every thing at most once on each sensor. Sensors have few touches: looking through them is
/// faster than sorting.
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
