//! Pressure between the taxels.

use std::path::PathBuf;

use numpy::PyArray2;
use numpy::ndarray::Ix1;
use pyo3::prelude::*;

use crate::array::{Numbers, in_order, rows};
use crate::error::OrRaise;
use crate::recording::Provenance;
use crate::sensor::Sensor;

/// A continuous map over the gel of what a few taxels read: 96 columns and 64 rows, interpolated between the taxels. A notebook shows its picture.
///
/// - `readings_kpa`: readings of the sensor above its unloaded baseline, kPa; `[n_taxels]`.
/// - `provenance`: where they come from: `"real"`, `"emulated"` or `"simulated"`.
///
/// Raises `Error` for another number of readings than the sensor has taxels.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct PressureMap {
    map: twintac::PressureMap,
    provenance: Provenance,
}

#[pymethods]
impl PressureMap {
    #[new]
    fn new(
        py: Python<'_>,
        sensor: &Sensor,
        readings_kpa: Numbers<'_, Ix1>,
        provenance: Provenance,
    ) -> PyResult<Self> {
        let map = twintac::PressureMap::of(&sensor.sensor, &in_order(&readings_kpa)).or_raise(py)?;
        Ok(Self { map, provenance })
    }

    /// Where the readings come from: `"real"`, `"emulated"` or `"simulated"`.
    #[getter]
    fn provenance(&self) -> String {
        self.provenance.to_string()
    }

    /// Pressure above the baseline, kPa; `[n_rows, n_columns]`, the row of smallest y first. The grid spans the box that holds the gel (`Sensor.bounds_mm`).
    #[getter]
    fn pressure_kpa<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let [n_columns, n_rows] = self.map.grid();
        rows(py, self.map.pressure_kpa().to_vec(), [n_rows, n_columns])
    }

    /// The picture that a notebook shows: the text of an SVG file.
    fn _repr_svg_(&self) -> String {
        self.map.svg()
    }

    /// Draws the map, with the taxels marked, into a file: `.svg` or `.png`.
    ///
    /// Raises `Error` for a name with another ending, and for a file that cannot be written.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.map.write(path)).or_raise(py)
    }
}
