//! Described sensors.

use std::collections::BTreeMap;
use std::path::PathBuf;

use numpy::PyArray2;
use pyo3::prelude::*;

use crate::array::rows;
use crate::error::OrRaise;
use crate::pickle::{Kept, Reduced, reduced};
use crate::shape::corners_mm;

/// A sensor, as its description says: gel, taxels and indenters.
///
/// `Sensor.phystac()` and `Sensor.phystac_tip()` are built in. `Sensor.load` reads the description
/// of another sensor.
#[pyclass(frozen, from_py_object, module = "twintac")]
#[derive(Clone)]
pub(crate) struct Sensor {
    pub(crate) sensor: twintac::Sensor,
}

#[pymethods]
impl Sensor {
    /// PhysTac: eight barometers under a flat gel of 34 × 18 × 8.5 mm.
    #[staticmethod]
    fn phystac(py: Python<'_>) -> PyResult<Self> {
        let sensor = twintac::Sensor::phystac().or_raise(py)?;
        Ok(Self { sensor })
    }

    /// PhysTac's fingertip: eight barometers under a dome, 19.2 mm high.
    #[staticmethod]
    fn phystac_tip(py: Python<'_>) -> PyResult<Self> {
        let sensor = twintac::Sensor::phystac_tip().or_raise(py)?;
        Ok(Self { sensor })
    }

    /// Reads a sensor description (TOML).
    ///
    /// Raises `Error` with file, line and field if the description is wrong, and with the file if
    /// it cannot be read.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let sensor = py.detach(|| twintac::Sensor::read(path)).or_raise(py)?;
        Ok(Self { sensor })
    }

    /// Name of the sensor in its description.
    #[getter]
    fn name(&self) -> &str {
        self.sensor.name()
    }

    /// Names of the taxels, in the order of every row of readings.
    #[getter]
    fn taxels(&self) -> Vec<&str> {
        self.sensor.taxels().collect()
    }

    /// Centres of the taxels' ports in the gel's frame, mm; `[n_taxels, 3]`.
    #[getter]
    fn taxel_positions_mm<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let taxels = &self.sensor.file().sensor.taxels;
        let positions = taxels.iter().flat_map(|taxel| taxel.position_mm.to_array());
        rows(py, positions.collect(), [taxels.len(), 3])
    }

    /// Lowest and highest corner of the box that contains the gel, in the gel's frame, mm;
    /// `[2, 3]`.
    #[getter]
    pub(crate) fn bounds_mm<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let sensor = &self.sensor.file().sensor;
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        rows(py, [low.to_array(), high.to_array()].concat(), [2, 3])
    }

    /// Names of the indenters in the description. `Press` takes one of them.
    #[getter]
    fn indenters(&self) -> Vec<&str> {
        self.sensor.indenters().collect()
    }

    /// Frame rate of the sensor, Hz.
    #[getter]
    fn rate_hz(&self) -> f64 {
        self.sensor.file().sensor.readout.rate_hz
    }

    /// The whole description, with units, as a text for people.
    fn describe(&self) -> String {
        self.sensor.file().sensor.describe()
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    /// The picture that a notebook shows: the sensor from above and in section, as the text of an
    /// SVG file.
    fn _repr_svg_(&self) -> String {
        self.sensor.svg()
    }

    fn __repr__(&self) -> String {
        format!(
            "<Sensor {:?} with {} taxels>",
            self.name(),
            self.sensor.taxels().count()
        )
    }
}

impl Kept for Sensor {
    /// The description's path, its text, and the corners of the triangles of each surface that it
    /// names, mm.
    type State = (PathBuf, String, BTreeMap<String, Vec<[[f64; 3]; 3]>>);

    fn state(&self, _: Python<'_>) -> PyResult<Self::State> {
        let file = self.sensor.file();
        let surfaces = file.sensor.surfaces.iter();
        let surfaces = surfaces.map(|(name, surface)| (name.clone(), corners_mm(surface)));
        Ok((file.path(), file.text.clone(), surfaces.collect()))
    }

    fn restored(py: Python<'_>, (path, text, surfaces): Self::State) -> PyResult<Self> {
        let sensor = twintac::Sensor::with_surfaces(&path, &text, &surfaces).or_raise(py)?;
        Ok(Self { sensor })
    }
}
