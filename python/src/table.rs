//! What is read of a shape at places and depths.

use numpy::ndarray::{Ix1, Ix3, Ix4};
use pyo3::prelude::*;

use crate::array::{Numbers, in_order};
use crate::error::unusable;

/// How far the distances of an axis may differ, as part of them.
const EVENNESS: f64 = 1e-6;

/// What is read of one shape at the nodes of a grid over place and depth, for `Inverse.of_tables`. An axis of one node is not looked for. Between nodes readings are cubic.
///
/// - `x_mm`, `y_mm`: places of the shape's origin in the gel's plane, mm, evenly apart and increasing; `[n_x]` and `[n_y]`.
/// - `depth_mm`: depths below first touch, mm, evenly apart and increasing; `[n_depth]`.
/// - `readings_kpa`: readings above the untouched sensor, kPa; `[n_depth, n_y, n_x, n_taxels]`.
/// - `force_n`: force into the gel, N, `[n_depth, n_y, n_x]`; unknown unless given.
///
/// Raises `Error`, whose `field` is the array that has another shape, or numbers that cannot be.
#[pyclass(frozen, from_py_object, module = "twintac")]
#[derive(Clone)]
pub(crate) struct ReadingTable {
    pub(crate) table: twintac::ReadingTable,
}

impl ReadingTable {
    pub(crate) fn n_taxels(&self) -> usize {
        self.table.readings_kpa.first().map_or(0, Vec::len)
    }
}

#[pymethods]
impl ReadingTable {
    #[new]
    #[pyo3(signature = (x_mm, y_mm, depth_mm, readings_kpa, force_n=None))]
    fn new(
        py: Python<'_>,
        x_mm: Numbers<'_, Ix1>,
        y_mm: Numbers<'_, Ix1>,
        depth_mm: Numbers<'_, Ix1>,
        readings_kpa: Numbers<'_, Ix4>,
        force_n: Option<Numbers<'_, Ix3>>,
    ) -> PyResult<Self> {
        let axes = [("x_mm", &x_mm), ("y_mm", &y_mm), ("depth_mm", &depth_mm)];
        let axes = axes.map(|(field, axis)| (field, in_order(axis).into_owned()));
        let [mut first_mm, mut step_mm] = [[0.0; 3], [1.0; 3]];
        for (number, (field, axis)) in axes.iter().enumerate() {
            [first_mm[number], step_mm[number]] = even(axis).ok_or_else(|| {
                unusable(
                    py,
                    field,
                    "has to have numbers that are evenly apart and increase",
                )
            })?;
        }
        let n = axes.map(|(_, axis)| axis.len());
        let [n_x, n_y, n_depth] = n;
        let shape = readings_kpa.as_array().shape().to_vec();
        let n_taxels = shape[3];
        if shape[..3] != [n_depth, n_y, n_x] || n_taxels == 0 {
            let problem = format!("has the shape {shape:?}, expected [{n_depth}, {n_y}, {n_x}, n_taxels]");
            return Err(unusable(py, "readings_kpa", &problem));
        }
        let readings_kpa = in_order(&readings_kpa);
        let force_n = match &force_n {
            None => vec![0.0; n.iter().product()],
            Some(force_n) if force_n.as_array().shape() == [n_depth, n_y, n_x] => {
                in_order(force_n).into_owned()
            }
            Some(force_n) => {
                let shape = force_n.as_array().shape().to_vec();
                let problem = format!("has the shape {shape:?}, expected [{n_depth}, {n_y}, {n_x}]");
                return Err(unusable(py, "force_n", &problem));
            }
        };
        for (field, numbers) in [("readings_kpa", &*readings_kpa), ("force_n", &force_n)] {
            if !numbers.iter().all(|number| number.is_finite()) {
                return Err(unusable(py, field, "has a number that is not finite"));
            }
        }
        Ok(Self {
            table: twintac::ReadingTable {
                first_mm,
                step_mm,
                n,
                readings_kpa: readings_kpa.chunks_exact(n_taxels).map(<[f64]>::to_vec).collect(),
                force_n,
            },
        })
    }

    fn __repr__(&self) -> String {
        let [n_x, n_y, n_depth] = self.table.n;
        format!(
            "<ReadingTable of {n_x} by {n_y} places, {n_depth} depths and {} taxels>",
            self.n_taxels()
        )
    }
}

/// The first number and the distance of numbers that are evenly apart; a lone one has the distance 1.
fn even(numbers: &[f64]) -> Option<[f64; 2]> {
    let (first, last) = (*numbers.first()?, *numbers.last()?);
    let step = match numbers.len() {
        1 => 1.0,
        n => (last - first) / (n - 1) as f64,
    };
    let is_even = |pair: &[f64]| (pair[1] - pair[0] - step).abs() <= EVENNESS * step;
    let can_be = first.is_finite() && step > 0.0 && step.is_finite();
    (can_be && numbers.windows(2).all(is_even)).then_some([first, step])
}
