//! The distance to the nearest of the contacts that were taught (nearest neighbours as a measure of novelty: Ramaswamy, Rastogi and Shim, 2000).

use twintac_learn::Matrix;

use super::descriptor::{N_TRAITS, traits};
use crate::surface::SurfaceGrid;
use crate::training::Frames;

/// Contacts that stand for all that were taught.
const N_KEPT: usize = 4096;

/// One lesson of so many is not kept, but says how far contacts of the same kinds are from those that are.
const ONE_APART_OF: usize = 8;

/// The part of those contacts whose novelty is at most 1.
const FAMILIAR: f64 = 0.99;

/// What was taught, as far as it tells what is new.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Novelty {
    /// Traits of contacts, each over its deviation among all that were taught. `[n_kept][N_TRAITS]`
    pub(crate) kept: Matrix,
    /// One over the deviation of each trait. `[N_TRAITS]`
    pub(crate) scale: Vec<f32>,
    /// The distance that counts as 1.
    pub(crate) unit: f32,
}

impl Novelty {
    /// Of the frames of lessons.
    pub(crate) fn of(frames: &Frames, grid: &SurfaceGrid) -> Self {
        let contacts: Vec<(usize, [f32; N_TRAITS])> = frames
            .frames
            .iter()
            .filter_map(|frame| Some((frame.lesson, traits(grid, of_grid(grid, &frame.inputs))?)))
            .collect();
        let scale: Vec<f32> = (0..N_TRAITS)
            .map(|number| 1.0 / deviation(contacts.iter().map(|(_, traits)| traits[number])))
            .collect();
        let scaled = |traits: &[f32; N_TRAITS]| std::array::from_fn(|number| traits[number] * scale[number]);
        let is_apart = |lesson: usize| lesson.is_multiple_of(ONE_APART_OF);
        let of = |apart: bool| {
            let own = contacts.iter().filter(|(lesson, _)| is_apart(*lesson) == apart);
            own.map(|(_, traits)| scaled(traits)).collect::<Vec<_>>()
        };
        let kept = spread_out(&of(false));
        let mut novelty = Self {
            kept: Matrix {
                values: kept.into_flattened(),
                n_columns: N_TRAITS,
            },
            scale: scale.clone(),
            unit: 1.0,
        };
        let mut apart: Vec<f32> = of(true).iter().map(|traits| novelty.nearest(traits)).collect();
        apart.sort_by(f32::total_cmp);
        let last_familiar = (FAMILIAR * apart.len() as f64) as usize;
        novelty.unit = apart
            .get(last_familiar)
            .or(apart.last())
            .map_or(1.0, |unit| unit.max(f32::MIN_POSITIVE));
        novelty
    }

    /// 0 where nothing is near, above 1 where a contact is farther from all that were taught than 99 of 100 of the same kinds.
    pub(crate) fn score(&self, grid: &SurfaceGrid, inputs: &[f32]) -> f32 {
        let Some(mut traits) = traits(grid, of_grid(grid, inputs)) else {
            return 0.0;
        };
        for (value, scale) in traits.iter_mut().zip(&self.scale) {
            *value *= scale;
        }
        self.nearest(&traits) / self.unit
    }

    fn nearest(&self, traits: &[f32; N_TRAITS]) -> f32 {
        let kept = self.kept.values.as_chunks::<N_TRAITS>().0;
        let nearest = kept.iter().map(|kept| distance_squared(kept, traits));
        nearest.fold(f32::INFINITY, f32::min).sqrt()
    }
}

/// The inputs of the first grid.
fn of_grid<'a>(grid: &SurfaceGrid, inputs: &'a [f32]) -> &'a [f32] {
    &inputs[..grid.len() * crate::contact::N_CHANNELS]
}

/// At most [`N_KEPT`] contacts: each next one is the farthest from those before it (Gonzalez, 1985).
fn spread_out(contacts: &[[f32; N_TRAITS]]) -> Vec<[f32; N_TRAITS]> {
    let mut kept: Vec<[f32; N_TRAITS]> = contacts.first().copied().into_iter().collect();
    let mut nearest = vec![f32::INFINITY; contacts.len()];
    while let Some(last) = kept.last().copied().filter(|_| kept.len() < N_KEPT) {
        for (nearest, contact) in nearest.iter_mut().zip(contacts) {
            *nearest = nearest.min(distance_squared(contact, &last));
        }
        let farthest = (0..contacts.len()).max_by(|a, b| nearest[*a].total_cmp(&nearest[*b]));
        match farthest.filter(|farthest| nearest[*farthest] > 0.0) {
            Some(farthest) => kept.push(contacts[farthest]),
            None => break,
        }
    }
    kept
}

fn distance_squared(a: &[f32; N_TRAITS], b: &[f32; N_TRAITS]) -> f32 {
    let mut sum = 0.0;
    for (a, b) in a.iter().zip(b) {
        sum += (a - b) * (a - b);
    }
    sum
}

/// The standard deviation; 1 of numbers that are all the same.
fn deviation(values: impl Iterator<Item = f32> + Clone) -> f32 {
    let n = values.clone().count().max(1) as f64;
    let mean = values.clone().map(f64::from).sum::<f64>() / n;
    let square = values.map(|value| (f64::from(value) - mean).powi(2)).sum::<f64>() / n;
    if square > 1e-12 { square.sqrt() as f32 } else { 1.0 }
}
