//! The weights of a map as a linear function of the readings.

use crate::error::input;
use crate::geometry::{distance_mm, pitch_mm};
use crate::kernel::{self, Plane};
use crate::width::leave_one_out_width_mm;
use crate::{Kernel, MapError, MapSettings, Weights};

/// Everything that depends only on the taxels and the settings.
#[derive(Clone, Debug)]
pub(crate) struct Fit {
    taxels_mm: Vec<[f64; 2]>,
    kernel: Kernel,
    /// The unit of distances: the Gaussian's width, or the taxels' pitch for a thin plate, mm.
    pub(crate) length_mm: f64,
    planes: Vec<Plane>,
    /// `[weights and planes][taxels]`. `None`: the weights are the readings.
    solution: Option<Vec<Vec<f64>>>,
}

impl Fit {
    /// If no width is given, it is chosen from `fields`: readings above the baseline, kPa.
    pub(crate) fn new(
        taxels_mm: &[[f64; 2]],
        settings: &MapSettings,
        fields: &[&[f64]],
    ) -> Result<Self, MapError> {
        let kernel = settings.kernel;
        let ridge = match settings.weights {
            Weights::Regularised(ridge) if !(ridge >= 0.0 && ridge.is_finite()) => {
                return Err(input(
                    "regularisation of a pressure map",
                    "a number not below 0",
                    ridge,
                ));
            }
            Weights::Regularised(ridge) => Some(ridge),
            Weights::Interpolating => Some(0.0),
            Weights::Readings if kernel == Kernel::ThinPlate => {
                let what = "weights of a pressure map";
                return Err(input(
                    what,
                    "fitted ones for a thin plate",
                    "the readings themselves",
                ));
            }
            Weights::Readings => None,
        };
        let pitch_mm = pitch_mm(taxels_mm);
        let length_mm = match (kernel, settings.width_mm, ridge) {
            (Kernel::ThinPlate, ..) => pitch_mm,
            (Kernel::Gaussian, Some(width_mm), _) => width_mm,
            (Kernel::Gaussian, None, None) => 0.5 * pitch_mm,
            (Kernel::Gaussian, None, Some(ridge)) => leave_one_out_width_mm(taxels_mm, fields, ridge),
        };
        if !(length_mm > 0.0 && length_mm.is_finite()) {
            let what = "width of a pressure map's Gaussian";
            return Err(input(what, "a positive number of mm", length_mm));
        }
        let planes = kernel::planes(kernel, taxels_mm, length_mm);
        let solution = match ridge {
            None => None,
            Some(ridge) => {
                let system = kernel::system(kernel, taxels_mm, length_mm, ridge, &planes);
                Some(kernel::inverse(system)?)
            }
        };
        Ok(Self {
            taxels_mm: taxels_mm.to_vec(),
            kernel,
            length_mm,
            planes,
            solution,
        })
    }

    /// The weights of the functions for readings above the baseline, kPa.
    pub(crate) fn weights(&self, above_kpa: &[f64]) -> Vec<f64> {
        let Some(solution) = &self.solution else {
            return above_kpa.to_vec();
        };
        let product = |row: &Vec<f64>| {
            row.iter()
                .zip(above_kpa)
                .map(|(entry, above)| entry * above)
                .sum()
        };
        solution.iter().map(product).collect()
    }

    /// The functions' values at a location, in the order of the weights.
    pub(crate) fn functions(&self, place: [f64; 2]) -> impl Iterator<Item = f64> {
        let kernels = self
            .taxels_mm
            .iter()
            .map(move |&taxel| kernel::value(self.kernel, distance_mm(place, taxel) / self.length_mm));
        kernels.chain(self.planes.iter().map(move |plane| kernel::height(plane, place)))
    }

    /// The pressure at a location if one taxel reads 1 kPa and the others 0, for each taxel, kPa.
    pub(crate) fn shares(&self, place: [f64; 2]) -> Vec<f64> {
        let Some(solution) = &self.solution else {
            return self.functions(place).collect();
        };
        let mut shares = vec![0.0; self.taxels_mm.len()];
        for (value, row) in self.functions(place).zip(solution) {
            for (share, entry) in shares.iter_mut().zip(row) {
                *share += value * entry;
            }
        }
        shares
    }
}
