//! Out-of-distribution (OOD) score: how far a contact is from those of the training presses.

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

/// Tolerated relative error of a prediction.
const TOLERATED: f32 = 0.1;

/// Fraction of predictions that are to have no larger error.
const SURE: f64 = 0.9;

/// What the score is computed from.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct OodScore {
    /// Descriptors of the training contacts, without their locations.
    pub(crate) nearest: Nearest,
    /// Locations and depths of the training presses, whatever shape pressed there.
    pub(crate) coverage: Coverage,
}

impl OodScore {
    /// From the frames of training presses. `is_symmetric`: whether they are also used mirrored
    /// across x and across y.
    pub(crate) fn of(frames: &Frames, grid: &SurfaceGrid, is_symmetric: [bool; 2]) -> Self {
        let pressed = frames.frames.iter().filter(|frame| frame.wrench[2] != 0.0);
        let pressed = pressed.map(|frame| (frame.press, nearest::of_grid(grid, &frame.inputs)));
        Self {
            nearest: Nearest::of(frames, grid),
            coverage: Coverage::of(grid, pressed, is_symmetric),
        }
    }

    /// Learns the error of predictions from held-out presses: inputs of the grid, and relative
    /// errors.
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

    /// The score: 0 where nothing is near. It is above 1 where the distance to the nearest training
    /// contact is larger than for 99 of 100 contacts of the same kinds, where the contact is deeper
    /// than the training presses, and where so few of them pressed that more than one of ten
    /// predictions would have an error of more than a tenth.
    pub(crate) fn score(&self, grid: &SurfaceGrid, inputs: &[f32]) -> f32 {
        let contact = self.nearest.score(grid, inputs);
        let Some(covered) = self.coverage.covered(grid, nearest::of_grid(grid, inputs)) else {
            return contact;
        };
        let error = self.coverage.error_of_one * covered.sparsity;
        contact.max(covered.depth).max(error / TOLERATED)
    }
}
