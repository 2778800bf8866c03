//! A fast gel in use.

use std::sync::Arc;

use twintac_shape::Pose;

use crate::contact::ContactGrid;
use crate::engine::{Engine, Scratch};
use crate::{Body, FastGel, Touch};

/// A fast gel, ready to be read: it owns all memory that a reading needs.
#[derive(Clone, Debug)]
pub struct FastReader {
    grid: Arc<ContactGrid>,
    engine: Arc<Engine>,
    inputs: Vec<f32>,
    scratch: Scratch,
    n_taxels: usize,
}

impl FastGel {
    /// Lays the networks out for reading.
    #[must_use]
    pub fn reader(&self) -> FastReader {
        let grid = ContactGrid::new(&self.layout.grid);
        let engine = Engine::of(self);
        FastReader {
            inputs: vec![0.0; grid.n_inputs()],
            scratch: engine.scratch(),
            n_taxels: self.n_taxels(),
            grid: Arc::new(grid),
            engine: Arc::new(engine),
        }
    }

    /// Number of taxels.
    #[must_use]
    pub fn n_taxels(&self) -> usize {
        self.ports_mm.len()
    }
}

impl FastReader {
    /// What the gel does under bodies at these poses in the gel's frame.
    ///
    /// - `pressure_kpa`: is written; hydrostatic pressure at each port. `[n_taxels]`
    /// - `wrench`: is written; force on the gel, N, and torque about the top of the gel's middle, N mm.
    ///
    /// # Panics
    /// A slice of pressures of another length than there are taxels, a pose that is not finite.
    pub fn read(&mut self, bodies: &[(&Body, Pose)], pressure_kpa: &mut [f32], wrench: &mut [f32; 6]) {
        self.grid.fill(bodies.iter().copied(), &mut self.inputs);
        self.evaluate(pressure_kpa, wrench);
    }

    /// The same of bodies that are known by their numbers.
    pub(crate) fn read_touches(
        &mut self,
        bodies: &[Body],
        touches: &[Touch],
        pressure_kpa: &mut [f32],
        wrench: &mut [f32; 6],
    ) {
        let touching = touches
            .iter()
            .map(|touch| (&bodies[touch.body as usize], touch.gel_from_body));
        self.grid.fill(touching, &mut self.inputs);
        self.evaluate(pressure_kpa, wrench);
    }

    fn evaluate(&mut self, pressure_kpa: &mut [f32], wrench: &mut [f32; 6]) {
        assert_eq!(pressure_kpa.len(), self.n_taxels, "a pressure for each taxel");
        self.engine
            .read(&self.inputs, &mut self.scratch, pressure_kpa, wrench);
    }
}
