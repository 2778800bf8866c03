//! How unlike a contact is to all that was taught.

mod coverage;
mod descriptor;
mod narrow;
mod nearest;

use crate::surface::SurfaceGrid;
use crate::training::Frames;

use coverage::LEAST_ERROR_OF_ONE;

pub(crate) use coverage::Coverage;
pub(crate) use descriptor::N_TRAITS;
pub(crate) use narrow::narrowness;
pub(crate) use nearest::Nearest;

/// Readings that are off by more than this part of them are said to be unsure.
const TOLERATED: f32 = 0.1;

/// The part of readings that are to be off by no more.
const SURE: f64 = 0.9;

/// What was taught, as far as it tells what is new.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Novelty {
    /// Contacts, wherever they were.
    pub(crate) nearest: Nearest,
    /// Places and depths, whatever pressed there.
    pub(crate) coverage: Coverage,
}

impl Novelty {
    /// Of the frames of lessons. `is_symmetric`: whether they teach their mirror images across x
    /// and across y.
    pub(crate) fn of(frames: &Frames, grid: &SurfaceGrid, is_symmetric: [bool; 2]) -> Self {
        let pressed = frames.frames.iter().filter(|frame| frame.wrench[2] != 0.0);
        let pressed = pressed.map(|frame| (frame.lesson, nearest::of_grid(grid, &frame.inputs)));
        Self {
            nearest: Nearest::of(frames, grid),
            coverage: Coverage::of(grid, pressed, is_symmetric),
        }
    }

    /// Learns from how far readings are off under presses that were not taught: inputs of the grid,
    /// and errors as part of the reading.
    pub(crate) fn calibrate(&mut self, grid: &SurfaceGrid, presses: &[(Vec<f32>, f32)]) {
        let errors = presses.iter().filter_map(|(inputs, error)| {
            let covered = self.coverage.covered(grid, nearest::of_grid(grid, inputs))?;
            Some(error / covered.sparsity)
        });
        let mut errors: Vec<f32> = errors.collect();
        errors.sort_by(f32::total_cmp);
        if let Some(error) = errors.get((SURE * errors.len() as f64) as usize) {
            self.coverage.error_of_one = error.max(LEAST_ERROR_OF_ONE);
        }
    }

    /// 0 where nothing is near; above 1 where a contact is farther from all that were taught than
    /// 99 of 100 of the same kinds, where it is deeper than lessons pressed, and where so few
    /// pressed that more than one of ten readings would be off by more than a tenth.
    pub(crate) fn score(&self, grid: &SurfaceGrid, inputs: &[f32]) -> f32 {
        let contact = self.nearest.score(grid, inputs);
        let Some(covered) = self.coverage.covered(grid, nearest::of_grid(grid, inputs)) else {
            return contact;
        };
        let error = self.coverage.error_of_one * covered.sparsity;
        contact.max(covered.depth).max(error / TOLERATED)
    }
}
