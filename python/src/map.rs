//! The pressure between the taxels.

use std::path::PathBuf;

use numpy::PyArray2;
use pyo3::prelude::*;

use crate::array::rows;
use crate::error::{OrRaise, unusable};
use crate::given::{Array, Given};
use crate::pickle::{Kept, Reduced, reduced};
use crate::plot::plot;
use crate::recording::Provenance;
use crate::sensor::Sensor;

/// A pressure map: the readings of a few taxels, interpolated over the gel, on 96 columns and 64
/// rows. A notebook shows its picture.
///
/// - `sensor`: the sensor.
/// - `readings_kpa`: readings above the unloaded baseline, kPa; `[n_taxels]`. A taxel whose reading
///   is NaN or masked is left out: the map is interpolated from the other taxels. It is NaN
///   everywhere if there is none.
/// - `provenance`: provenance of the readings: `"real"`, `"emulated"` or `"simulated"`.
///
/// Raises `Error` if the number of readings is not the number of taxels, and for an infinite
/// reading.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct PressureMap {
    map: twintac::PressureMap,
    sensor: Sensor,
    readings_kpa: Vec<f64>,
    provenance: Provenance,
}

impl PressureMap {
    fn of(py: Python<'_>, sensor: &Sensor, readings_kpa: Vec<f64>, provenance: Provenance) -> PyResult<Self> {
        Ok(Self {
            map: twintac::PressureMap::of(&sensor.sensor, &readings_kpa).or_raise(py)?,
            sensor: sensor.clone(),
            readings_kpa,
            provenance,
        })
    }
}

#[pymethods]
impl PressureMap {
    #[new]
    fn new(
        py: Python<'_>,
        sensor: &Sensor,
        readings_kpa: Given<'_>,
        provenance: Provenance,
    ) -> PyResult<Self> {
        let expected = format!("one for each of {} taxels, kPa", sensor.sensor.taxels().count());
        let readings_kpa: Array<1> = readings_kpa.numbers("readings_kpa", &expected)?;
        if readings_kpa.values.len() != sensor.sensor.taxels().count() {
            let problem = format!("has {} numbers, expected {expected}", readings_kpa.values.len());
            return Err(unusable(py, "readings_kpa", &problem));
        }
        if readings_kpa.values.iter().any(|kpa| kpa.is_infinite()) {
            let problem =
                "has an infinite number, expected finite ones, and NaN for a taxel without a reading";
            return Err(unusable(py, "readings_kpa", problem));
        }
        Self::of(py, sensor, readings_kpa.values, provenance)
    }

    /// Provenance of the readings: `"real"`, `"emulated"` or `"simulated"`.
    #[getter]
    fn provenance(&self) -> String {
        self.provenance.to_string()
    }

    /// Pressure above the baseline, kPa; `[n_rows, n_columns]`, the row of smallest y first. The
    /// grid spans the box that contains the gel (`Sensor.bounds_mm`).
    #[getter]
    fn pressure_kpa<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let [n_columns, n_rows] = self.map.grid();
        rows(py, self.map.pressure_kpa().to_vec(), [n_rows, n_columns])
    }

    /// Names of the taxels without a reading. The map was made without them.
    #[getter]
    fn missing(&self) -> Vec<String> {
        self.map.missing().to_vec()
    }

    /// The picture that a notebook shows: the text of an SVG file.
    fn _repr_svg_(&self) -> String {
        self.map.svg()
    }

    /// Draws the map into a file, and marks the taxels that have a reading.
    ///
    /// - `path`: path of the file, with the ending `.svg` or `.png`.
    ///
    /// Raises `Error` for a name with another ending, and for a file that cannot be written.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.map.write(path)).or_raise(py)
    }

    /// Draws the map in the gel's plane with Matplotlib, with a scale in kPa.
    ///
    /// - `axes`: the axes to draw in; new axes unless given.
    ///
    /// Returns the axes, so that they can be restyled. Raises `ModuleNotFoundError` without
    /// Matplotlib.
    #[pyo3(signature = (axes=None))]
    fn plot<'py>(map: &Bound<'py, Self>, axes: Option<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        let bounds_mm = map.get().sensor.bounds_mm(map.py())?;
        plot(map.py(), "pressure_map", (map, bounds_mm, axes))
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        let (sensor, provenance) = (self.sensor.sensor.name(), &self.provenance);
        match self.map.missing() {
            [] => format!("<PressureMap of {sensor:?}, {provenance}>"),
            names => format!(
                "<PressureMap of {sensor:?} without {}, {provenance}>",
                names.join(", ")
            ),
        }
    }
}

impl Kept for PressureMap {
    type State = (<Sensor as Kept>::State, Vec<f64>, Provenance);

    fn state(&self, py: Python<'_>) -> PyResult<Self::State> {
        Ok((self.sensor.state(py)?, self.readings_kpa.clone(), self.provenance))
    }

    fn restored(py: Python<'_>, (sensor, readings_kpa, provenance): Self::State) -> PyResult<Self> {
        Self::of(py, &Sensor::restored(py, sensor)?, readings_kpa, provenance)
    }
}
