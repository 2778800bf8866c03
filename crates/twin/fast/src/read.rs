//! A fast gel in use.

use twintac_shape::Pose;

use crate::contact::ContactGrid;
use crate::engine::{Engine, Scratch};
use crate::{Body, FastGel};

/// A fast gel, ready to be read: it owns all memory that a reading needs.
#[derive(Clone, Debug)]
pub struct FastReader {
    grid: ContactGrid,
    engine: Engine,
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
            n_taxels: self.ports_mm.len(),
            grid,
            engine,
        }
    }
}

impl FastReader {
    /// What the gel does under bodies at these poses.
    ///
    /// # Panics
    /// A slice of pressures of another length than there are taxels.
    pub fn read(&mut self, bodies: &[(&Body, Pose)], pressure_kpa: &mut [f32], wrench: &mut [f32; 6]) {
        assert_eq!(pressure_kpa.len(), self.n_taxels, "a pressure for each taxel");
        self.grid.fill(bodies, &mut self.inputs);
        self.engine
            .read(&self.inputs, &mut self.scratch, pressure_kpa, wrench);
    }
}
