//! The pressure on a gel's floor, finer than the taxels.

use std::sync::Arc;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::array::rows;
use crate::error::unusable;
use crate::fast::PROVENANCE;
use crate::inverse::Contact;

/// Reads the pressure on a gel's floor on a grid: what a contact would make there by the fast gel. What `Inverse.floor_map` returns.
#[pyclass(module = "twintac")]
pub(crate) struct FloorMap {
    map: twintac::FloorMap,
    /// Names of the shapes of the inverse, which are in memory once.
    shapes: Arc<[String]>,
}

impl FloorMap {
    pub(crate) fn new(map: twintac::FloorMap, shapes: Arc<[String]>) -> Self {
        Self { map, shapes }
    }

    /// Places along an axis, mm.
    fn along(&self, axis: usize) -> Vec<f64> {
        let place_mm = |number: usize| {
            let at = [number, 0];
            self.map.place_mm(at[axis], at[1 - axis]).to_array()[axis]
        };
        (0..self.map.n()[axis]).map(place_mm).collect()
    }
}

#[pymethods]
impl FloorMap {
    /// What every pressure is: simulated, whatever the readings were that the contact was found from.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// Places of the columns in the gel's plane, mm; `[n_columns]`.
    #[getter]
    fn x_mm<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.along(0))
    }

    /// Places of the rows in the gel's plane, mm; `[n_rows]`.
    #[getter]
    fn y_mm<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.along(1))
    }

    /// The map under a contact that the same inverse has found, kPa; `[n_rows, n_columns]`, the row of smallest y first. Each point is the mean over a disc as large as a port.
    ///
    /// Raises `Error` for a contact that another inverse has found.
    fn read<'py>(&mut self, py: Python<'py>, contact: &Contact) -> PyResult<Bound<'py, PyArray2<f32>>> {
        if !Arc::ptr_eq(&contact.shapes, &self.shapes) {
            let problem = "was found by another inverse, expected one of the inverse that made this map";
            return Err(unusable(py, "contact", problem));
        }
        let [n_columns, n_rows] = self.map.n();
        let pressure_kpa = py.detach(|| self.map.read(&contact.contact).to_vec());
        rows(py, pressure_kpa, [n_rows, n_columns])
    }

    fn __repr__(&self) -> String {
        let [n_columns, n_rows] = self.map.n();
        format!("<FloorMap of {n_columns} by {n_rows} places, simulated>")
    }
}
