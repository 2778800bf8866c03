//! Distance to the nearest training contact (nearest neighbours as an OOD score: Ramaswamy,
//! Rastogi and Shim, 2000).

use twintac_learn::Matrix;

use super::descriptor::{N_TRAITS, traits};
use crate::surface::SurfaceGrid;
use crate::training::{Frames, TrainingFrame};

/// One of this many training presses is used to find how far its contacts are from those of all
/// other presses.
const ONE_ASKED_OF: usize = 8;

/// Fraction of those contacts whose score is at most 1.
const IN_DISTRIBUTION: f64 = 0.99;

/// Descriptors of the training contacts, without their locations.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Nearest {
    /// Descriptors of all training contacts, each number divided by its standard deviation among
    /// those that press. `[n_kept][N_TRAITS]`
    pub(crate) kept: Matrix,
    /// One over the standard deviation of each number. `[N_TRAITS]`
    pub(crate) scale: Vec<f32>,
    /// The distance that counts as a score of 1.
    pub(crate) unit: f32,
}

impl Nearest {
    /// From the frames of training presses.
    pub(crate) fn of(frames: &Frames, grid: &SurfaceGrid) -> Self {
        let contacts: Vec<(&TrainingFrame, [f32; N_TRAITS])> = frames
            .frames
            .iter()
            .filter_map(|frame| Some((frame, traits(grid, of_grid(grid, &frame.inputs))?)))
            .collect();
        // Hovering shapes are kept as well, but if they counted here, pressed contacts would look
        // alike.
        let pressed = || contacts.iter().filter(|(frame, _)| frame.wrench[2] != 0.0);
        let scale: Vec<f32> = (0..N_TRAITS)
            .map(|number| 1.0 / deviation(pressed().map(|(_, traits)| traits[number])))
            .collect();
        let scaled = contacts
            .iter()
            .map(|(_, traits)| std::array::from_fn(|number| traits[number] * scale[number]));
        let kept: Vec<[f32; N_TRAITS]> = scaled.collect();
        let mut distances: Vec<f32> = contacts
            .iter()
            .zip(&kept)
            .filter(|((frame, _), _)| frame.press.is_multiple_of(ONE_ASKED_OF) && frame.wrench[2] != 0.0)
            .map(|((asked, _), traits)| {
                let others = contacts.iter().zip(&kept);
                let others = others.filter(|((other, _), _)| other.press != asked.press);
                nearest(others.map(|(_, kept)| kept), traits)
            })
            .collect();
        distances.sort_by(f32::total_cmp);
        let last_in_distribution = (IN_DISTRIBUTION * distances.len() as f64) as usize;
        let unit = distances.get(last_in_distribution).or(distances.last());
        Self {
            unit: unit.map_or(1.0, |unit| unit.max(f32::MIN_POSITIVE)),
            kept: Matrix {
                values: kept.into_flattened(),
                n_columns: N_TRAITS,
            },
            scale,
        }
    }

    /// The score: 0 where nothing is near, above 1 where the distance to the nearest training
    /// contact is larger than for 99 of 100 contacts of the same kinds.
    pub(crate) fn score(&self, grid: &SurfaceGrid, inputs: &[f32]) -> f32 {
        let Some(mut traits) = traits(grid, of_grid(grid, inputs)) else {
            return 0.0;
        };
        for (value, scale) in traits.iter_mut().zip(&self.scale) {
            *value *= scale;
        }
        nearest(self.kept.values.as_chunks::<N_TRAITS>().0, &traits) / self.unit
    }
}

/// The distance to the nearest of some contacts.
fn nearest<'a>(contacts: impl IntoIterator<Item = &'a [f32; N_TRAITS]>, traits: &[f32; N_TRAITS]) -> f32 {
    let squares = contacts
        .into_iter()
        .map(|contact| distance_squared(contact, traits));
    squares.fold(f32::INFINITY, f32::min).sqrt()
}

/// The inputs of the first grid.
pub(super) fn of_grid<'a>(grid: &SurfaceGrid, inputs: &'a [f32]) -> &'a [f32] {
    &inputs[..grid.len() * crate::contact::N_CHANNELS]
}

fn distance_squared(a: &[f32; N_TRAITS], b: &[f32; N_TRAITS]) -> f32 {
    let mut sum = 0.0;
    for (a, b) in a.iter().zip(b) {
        sum += (a - b) * (a - b);
    }
    sum
}

/// The standard deviation; 1 if all numbers are the same.
fn deviation(values: impl Iterator<Item = f32> + Clone) -> f32 {
    let n = values.clone().count().max(1) as f64;
    let mean = values.clone().map(f64::from).sum::<f64>() / n;
    let square = values.map(|value| (f64::from(value) - mean).powi(2)).sum::<f64>() / n;
    if square > 1e-12 { square.sqrt() as f32 } else { 1.0 }
}
