//! The pressure on the base of a gel, at more points than the taxels.

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::array::rows;
use crate::contact::{Contact, Origin};
use crate::error::unusable;
use crate::fast::PROVENANCE;
use crate::pickle::refused;
use crate::shared::Shared;

/// Computes the pressure on the base of a gel under an estimated contact, on a grid of points, with
/// the surrogate. `Inverse.floor_map` returns it.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct FloorMap {
    map: Shared<twintac::FloorMap>,
    /// Positions of columns and rows, mm.
    places_mm: [Vec<f64>; 2],
    origin: Origin,
}

impl FloorMap {
    pub(crate) fn new(map: twintac::FloorMap, origin: Origin) -> Self {
        let along = |axis: usize| {
            let place_mm = |number: usize| {
                let at = [number, 0];
                map.place_mm(at[axis], at[1 - axis]).to_array()[axis]
            };
            (0..map.n()[axis]).map(place_mm).collect()
        };
        Self {
            places_mm: [along(0), along(1)],
            map: Shared::new(map),
            origin,
        }
    }
}

#[pymethods]
impl FloorMap {
    /// Provenance of the pressures: `"simulated"`, whatever the provenance of the readings from
    /// which the contact was estimated.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// Positions of the columns along x in the gel's plane, mm; `[n_columns]`.
    #[getter]
    fn x_mm<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.places_mm[0])
    }

    /// Positions of the rows along y in the gel's plane, mm; `[n_rows]`.
    #[getter]
    fn y_mm<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.places_mm[1])
    }

    /// Computes the map under a contact that the same inverse has estimated.
    ///
    /// - `contact`: the contact.
    ///
    /// Returns the pressures, kPa, `[n_rows, n_columns]`, the row of smallest y first. Each value
    /// is the mean over a disc as large as a port; NaN where that is not within the gel, as in the
    /// corners around a round one.
    ///
    /// Raises `Error` for a contact that another inverse has estimated.
    fn read<'py>(&self, py: Python<'py>, contact: &Contact) -> PyResult<Bound<'py, PyArray2<f32>>> {
        if !contact.origin.is(&self.origin) {
            let problem = "was found by another inverse, expected one of the inverse that made this map";
            return Err(unusable(py, "contact", problem));
        }
        let [n_columns, n_rows] = self.places_mm.each_ref().map(Vec::len);
        let pressure_kpa = self.map.work(py, |map| map.read(&contact.contact).to_vec())?;
        rows(py, pressure_kpa, [n_rows, n_columns])
    }

    /// Raises `TypeError`: a `FloorMap` cannot be pickled or copied.
    fn __reduce__(&self) -> PyResult<()> {
        refused(
            "FloorMap",
            "keep what FloorMap.read returns, or prepare one in each process",
        )
    }

    fn __repr__(&self) -> String {
        let [n_columns, n_rows] = self.places_mm.each_ref().map(Vec::len);
        format!("<FloorMap of {n_columns} by {n_rows} places, simulated>")
    }
}
