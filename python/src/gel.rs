//! Gels, pressed.

use std::sync::Arc;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use twintac::{PressFrame, RunSettings};

use crate::array::rows;
use crate::error::OrRaise;
use crate::long_call::long_call;
use crate::press::Press;
use crate::sensor::Sensor;
use crate::settings::but;

/// The gel of a sensor, ready to be pressed: a finite-element model with the material of the description.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Gel {
    gel: Arc<twintac::Gel>,
}

#[pymethods]
impl Gel {
    /// `settings` are those of the simulation that differ from the usual ones for single presses: `{"edges_per_height": 4.0}`.
    #[new]
    #[pyo3(signature = (sensor, settings=None))]
    fn new(py: Python<'_>, sensor: &Sensor, settings: Option<Bound<'_, PyDict>>) -> PyResult<Self> {
        let of_run = PyDict::new(py);
        of_run.set_item("simulate", settings.unwrap_or_else(|| PyDict::new(py)))?;
        let settings = but(RunSettings::fine(), Some(&of_run))?;
        let gel = twintac::Gel::with_settings(&sensor.sensor, settings.simulate);
        Ok(Self { gel: Arc::new(gel) })
    }

    /// Presses the gel down to the depth of the press, which takes about a second. Ctrl-C ends the wait.
    fn press(&self, py: Python<'_>, press: &Press) -> PyResult<Pressed> {
        let (gel, press) = (Arc::clone(&self.gel), twintac::Press::from(press));
        let pressed = long_call(py, move || gel.press(&press))?.or_raise(py)?;
        Ok(Pressed { pressed })
    }
}

/// A simulated press, from first touch to full depth.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Pressed {
    pressed: twintac::Pressed,
}

impl Pressed {
    fn each<'py>(&self, py: Python<'py>, value: impl Fn(&PressFrame) -> f64) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, self.pressed.frames().iter().map(value))
    }
}

#[pymethods]
impl Pressed {
    /// What every number here is: simulated.
    #[getter]
    fn provenance(&self) -> &'static str {
        twintac::Pressed::PROVENANCE
    }

    /// Depth below first touch, mm; `[n_frames]`. The first frame is the untouched gel.
    #[getter]
    fn depth_mm<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.each(py, |frame| frame.depth_mm)
    }

    /// Force of the indenter on the gel, N; `[n_frames]`.
    #[getter]
    fn force_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.each(py, |frame| frame.force_n)
    }

    /// Hydrostatic pressure in the gel over each taxel's port, kPa; `[n_frames, n_taxels]`. A barometer there would read this if it followed
    /// the gel without gain, delay and creep.
    #[getter]
    fn readings_kpa<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let frames = self.pressed.frames();
        let readings: Vec<f64> = frames
            .iter()
            .flat_map(|frame| frame.port_pressure_kpa.clone())
            .collect();
        rows(py, readings, [frames.len(), self.pressed.readings_kpa().len()])
    }

    fn __repr__(&self) -> String {
        format!("<Pressed, {} frames, simulated>", self.pressed.frames().len())
    }
}
