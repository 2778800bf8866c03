//! Coverage: how often and how deep training presses pressed each point of the grid.

use crate::contact::{N_CHANNELS, TOUCHED, levels_mm};
use crate::distance::REACH_MM;
use crate::surface::SurfaceGrid;

/// Number of presses that a point counts for where no training press pressed.
const LEAST_PRESSES: f32 = 0.01;

/// More training presses at a point make no difference: the remaining error does not come from its
/// location.
const MOST_PRESSES: f32 = 100.0;

/// Factor by which a contact may be deeper than the training presses: where many pressed, next to
/// none went all the way to the largest depth.
const SLIGHTLY_DEEPER: f32 = 1.05;

/// Lower limit of the error where one training press pressed. It is large enough that contacts
/// where none pressed get a score above 1.
pub(super) const LEAST_ERROR_OF_ONE: f32 = 0.02;

/// Which points training presses pressed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Coverage {
    /// Number of training presses that pressed each point, mirror images included where they are
    /// trained on. `[n_points]`
    pub(crate) presses: Vec<f32>,
    /// The largest depth that one of them had there, mm. `[n_points]`
    pub(crate) deepest_mm: Vec<f32>,
    /// 90th percentile of the relative error where one training press pressed. With `n` presses the
    /// error is smaller by the root of `n`.
    pub(crate) error_of_one: f32,
}

/// Coverage of one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Covered {
    /// One over the root of the number of training presses at its points: mean, weighted by how far
    /// the points are pressed.
    pub(crate) sparsity: f32,
    /// Its depth over the largest depth (slightly increased) of training presses at any of its
    /// points.
    pub(crate) depth: f32,
}

impl Coverage {
    /// From the inputs of frames of training presses, with the numbers of the presses:
    /// `[n_points * N_CHANNELS]` of the grid. `is_symmetric`: whether frames are also used mirrored
    /// across x and across y.
    pub(crate) fn of<'a>(
        grid: &SurfaceGrid,
        frames: impl Iterator<Item = (usize, &'a [f32])>,
        is_symmetric: [bool; 2],
    ) -> Self {
        let n_points = grid.len();
        let (mut presses, mut deepest_mm) = (vec![0.0; n_points], vec![0.0f32; n_points]);
        // The last press that was counted at each point.
        let mut counted = vec![usize::MAX; n_points];
        for (press, inputs) in frames {
            for (point, channels) in inputs.as_chunks::<N_CHANNELS>().0.iter().enumerate() {
                let depth_mm = depth_mm(grid, channels);
                if depth_mm <= 0.0 {
                    continue;
                }
                deepest_mm[point] = depth_mm.max(deepest_mm[point]);
                if std::mem::replace(&mut counted[point], press) != press {
                    presses[point] += 1.0;
                }
            }
        }
        let images = |point: usize| {
            let [n_x, n_y] = grid.n;
            let (i, j) = (point % n_x, point / n_x);
            let columns = if is_symmetric[0] {
                vec![i, n_x - 1 - i]
            } else {
                vec![i]
            };
            let rows = if is_symmetric[1] {
                vec![j, n_y - 1 - j]
            } else {
                vec![j]
            };
            let mut images: Vec<usize> = rows
                .iter()
                .flat_map(|j| columns.iter().map(move |i| j * n_x + i))
                .collect();
            images.sort_unstable();
            images.dedup();
            images
        };
        Self {
            presses: (0..n_points)
                .map(|point| images(point).into_iter().map(|image| presses[image]).sum())
                .collect(),
            deepest_mm: (0..n_points)
                .map(|point| {
                    images(point)
                        .into_iter()
                        .map(|image| deepest_mm[image])
                        .fold(0.0, f32::max)
                })
                .collect(),
            error_of_one: LEAST_ERROR_OF_ONE,
        }
    }

    /// Start of the last interval of 1 mm that the depths of training presses reach, mm.
    pub(crate) fn deepest_whole_mm(&self) -> u32 {
        let deepest_mm = self.deepest_mm.iter().copied().fold(0.0, f32::max);
        (deepest_mm.ceil() as u32).saturating_sub(1)
    }

    /// Coverage of a contact; `None` where nothing touches.
    pub(crate) fn covered(&self, grid: &SurfaceGrid, inputs: &[f32]) -> Option<Covered> {
        let points = inputs.as_chunks::<N_CHANNELS>().0;
        let nearest = points.iter().map(|point| point[0]).fold(0.0, f32::max);
        if REACH_MM * (1.0 - nearest) >= TOUCHED[1] * grid.spacing_mm as f32 {
            return None;
        }
        // A body that presses between the points counts by the points nearest to it.
        let floor = nearest.min(1.0) * (1.0 - 1e-3);
        let (mut weights, mut sparsity) = (0.0, 0.0);
        let (mut depth, mut deepest_mm) = (0.0f32, f32::MIN_POSITIVE);
        for (point, channels) in points.iter().enumerate() {
            let weight = channels[0] - floor;
            if weight <= 0.0 {
                continue;
            }
            weights += weight;
            sparsity += weight / self.presses[point].clamp(LEAST_PRESSES, MOST_PRESSES).sqrt();
            depth = depth.max(depth_mm(grid, channels));
            deepest_mm = deepest_mm.max(self.deepest_mm[point]);
        }
        Some(Covered {
            sparsity: sparsity / weights,
            depth: if depth > 0.0 {
                depth / (SLIGHTLY_DEEPER * deepest_mm)
            } else {
                0.0
            },
        })
    }
}

/// Depth of a point inside a body, mm, from the level at which this is deepest; 0 outside.
fn depth_mm(grid: &SurfaceGrid, channels: &[f32; N_CHANNELS]) -> f32 {
    let levels = channels.iter().zip(levels_mm(grid.spacing_mm as f32));
    let inside = levels.filter(|(share, _)| **share > 1.0);
    inside
        .map(|(share, level_mm)| REACH_MM * (share - 1.0) - level_mm)
        .fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::Layout;
    use twintac_sensor::SensorFile;

    /// Inputs of a body that presses one point this deep, mm.
    fn pressed(grid: &SurfaceGrid, [i, j]: [usize; 2], depth_mm: f32) -> Vec<f32> {
        let mut inputs = vec![0.0; grid.len() * N_CHANNELS];
        let point = &mut inputs.as_chunks_mut::<N_CHANNELS>().0[j * grid.n[0] + i];
        for (share, level_mm) in point.iter_mut().zip(levels_mm(grid.spacing_mm as f32)) {
            *share = 1.0 + (depth_mm + level_mm) / REACH_MM;
        }
        inputs
    }

    #[test]
    fn presses_and_their_mirror_images_cover_places_and_depths() {
        let sensor = SensorFile::phystac().unwrap().sensor;
        let layout = Layout::of(&sensor);
        let grid = layout.grid();
        let [n_x, n_y] = grid.n;
        let presses = [(0, 1.0), (0, 2.0), (1, 1.5)];
        let frames: Vec<(usize, Vec<f32>)> = presses
            .into_iter()
            .map(|(press, depth_mm)| (press, pressed(grid, [3, 2], depth_mm)))
            .collect();
        let frames = || frames.iter().map(|(press, inputs)| (*press, &inputs[..]));
        let coverage = Coverage::of(grid, frames(), [true, false]);
        let covered =
            |at: [usize; 2], depth_mm: f32| coverage.covered(grid, &pressed(grid, at, depth_mm)).unwrap();
        // Two training presses, however many frames each has.
        for there in [[3, 2], [n_x - 4, 2]] {
            assert!((covered(there, 1.0).sparsity - 0.5f32.sqrt()).abs() < 1e-5);
            assert!(covered(there, 2.0).depth < 1.0 && covered(there, 2.2).depth > 1.0);
        }
        for elsewhere in [[3, n_y - 3], [4, 2]] {
            assert!(covered(elsewhere, 1.0).sparsity > 9.0);
        }
        let whole = Coverage::of(grid, frames(), [true, true]);
        let there = pressed(grid, [3, n_y - 3], 1.0);
        assert!(whole.covered(grid, &there).unwrap().sparsity < 1.0);
        // A hovering body has no contact.
        assert_eq!(coverage.covered(grid, &pressed(grid, [3, 2], -1.0)), None);
    }
}
