//! Tables of readings of a shape at locations and depths.

use pyo3::prelude::*;

use crate::error::unusable;
use crate::given::{Array, Given};
use crate::pickle::{Kept, Reduced, reduced};

/// Largest relative difference between the steps of an axis.
const EVENNESS: f64 = 1e-6;

/// The readings under one shape at the nodes of a grid over location and depth, for
/// `Inverse.of_tables`. A coordinate whose axis has one node is not estimated. Between the nodes,
/// readings are interpolated with cubic polynomials.
///
/// - `x_mm`, `y_mm`: locations of the shape's origin in the gel's plane, mm, evenly spaced and
///   increasing; `[n_x]` and `[n_y]`.
/// - `depth_mm`: depths below first touch, mm, evenly spaced and increasing; `[n_depth]`.
/// - `readings_kpa`: readings above the untouched sensor, kPa; `[n_depth, n_y, n_x, n_taxels]`.
/// - `force_n`: force into the gel, N, `[n_depth, n_y, n_x]`; unknown unless given.
///
/// Raises `Error` for an array with another shape or with numbers that are not allowed; its `field`
/// names the array.
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
        x_mm: Given<'_>,
        y_mm: Given<'_>,
        depth_mm: Given<'_>,
        readings_kpa: Given<'_>,
        force_n: Option<Given<'_>>,
    ) -> PyResult<Self> {
        let [x_mm, y_mm, depth_mm] =
            [("x_mm", x_mm), ("y_mm", y_mm), ("depth_mm", depth_mm)].map(|(field, axis)| {
                let axis: Array<1> = axis.numbers(field, "numbers in mm, evenly apart and increasing")?;
                PyResult::Ok((field, axis.values))
            });
        let axes = [x_mm?, y_mm?, depth_mm?];
        let [mut first_mm, mut step_mm] = [[0.0; 3], [1.0; 3]];
        for (number, (field, axis)) in axes.iter().enumerate() {
            [first_mm[number], step_mm[number]] = even(axis).ok_or_else(|| {
                unusable(
                    py,
                    field,
                    "has to have numbers in mm that are evenly apart and increase, and span a metre at most",
                )
            })?;
        }
        let n = axes.map(|(_, axis)| axis.len());
        let [n_x, n_y, n_depth] = n;
        let expected = format!("[{n_depth}, {n_y}, {n_x}, n_taxels], kPa");
        let readings_kpa: Array<4> = readings_kpa.numbers("readings_kpa", &expected)?;
        let (shape, readings_kpa) = (readings_kpa.shape, readings_kpa.values);
        let n_taxels = shape[3];
        if shape[..3] != [n_depth, n_y, n_x] || n_taxels == 0 {
            let problem = format!("has the shape {shape:?}, expected {expected}");
            return Err(unusable(py, "readings_kpa", &problem));
        }
        let expected = format!("[{n_depth}, {n_y}, {n_x}], N");
        let force_n = force_n
            .map(|force_n| force_n.numbers::<3>("force_n", &expected))
            .transpose()?;
        let force_n = match force_n {
            None => vec![0.0; n.iter().product()],
            Some(force_n) if force_n.shape == [n_depth, n_y, n_x] => force_n.values,
            Some(force_n) => {
                let problem = format!("has the shape {:?}, expected {expected}", force_n.shape);
                return Err(unusable(py, "force_n", &problem));
            }
        };
        for (field, numbers) in [("readings_kpa", &readings_kpa), ("force_n", &force_n)] {
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

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        let [n_x, n_y, n_depth] = self.table.n;
        format!(
            "<ReadingTable of {n_x} by {n_y} places, {n_depth} depths and {} taxels>",
            self.n_taxels()
        )
    }
}

impl Kept for ReadingTable {
    /// First node and step of the nodes along x, y and depth, mm; numbers of nodes; readings and
    /// forces at each node.
    type State = ([[f64; 3]; 2], [usize; 3], Vec<Vec<f64>>, Vec<f64>);

    fn state(&self, _: Python<'_>) -> PyResult<Self::State> {
        let table = self.table.clone();
        Ok((
            [table.first_mm, table.step_mm],
            table.n,
            table.readings_kpa,
            table.force_n,
        ))
    }

    fn restored(
        _: Python<'_>,
        ([first_mm, step_mm], n, readings_kpa, force_n): Self::State,
    ) -> PyResult<Self> {
        let table = twintac::ReadingTable {
            first_mm,
            step_mm,
            n,
            readings_kpa,
            force_n,
        };
        Ok(Self { table })
    }
}

/// Longest axis, mm.
const LONGEST_MM: f64 = 1000.0;

/// First number and step of evenly spaced numbers. A single number has the step 1.
fn even(numbers: &[f64]) -> Option<[f64; 2]> {
    let (first, last) = (*numbers.first()?, *numbers.last()?);
    let step = match numbers.len() {
        1 => 1.0,
        n => (last - first) / (n - 1) as f64,
    };
    let is_even = |pair: &[f64]| (pair[1] - pair[0] - step).abs() <= EVENNESS * step;
    let can_be = first.abs() <= LONGEST_MM && step > 0.0 && last - first <= LONGEST_MM;
    (can_be && numbers.windows(2).all(is_even)).then_some([first, step])
}
