//! Friction of a body on a fast gel.

use numpy::PyArray1;
use pyo3::prelude::*;

use crate::error::unusable;
use crate::pose::Pose;
use crate::sensor::Sensor;

/// Friction of one body on one sensor's gel, from one moment to the next: the gel's top is sheared with the body, until it slips. Readings do not feel it.
#[pyclass(module = "twintac")]
pub(crate) struct Friction {
    friction: twintac::Friction,
}

#[pymethods]
impl Friction {
    /// Friction with Coulomb's coefficient; nothing is held yet.
    #[new]
    fn new(py: Python<'_>, sensor: &Sensor, coefficient: f64) -> PyResult<Self> {
        if !(coefficient.is_finite() && coefficient >= 0.0) {
            return Err(unusable(py, "coefficient", "is not a number from 0 on"));
        }
        let sensor = &sensor.sensor.file().sensor;
        Ok(Self {
            friction: twintac::Friction::on(sensor, coefficient),
        })
    }

    /// One more moment: the wrench of `FastReader.read` under the body alone, `[6]`, with friction. `area_mm2` is `FastReader.contact_area_mm2` of the body.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        gel_from_body: Pose,
        area_mm2: f32,
        mut wrench: [f32; 6],
    ) -> Bound<'py, PyArray1<f32>> {
        self.friction.step(&gel_from_body.pose, area_mm2, &mut wrench);
        PyArray1::from_slice(py, &wrench)
    }

    /// Lets go of what touches: the next moment begins without friction.
    fn release(&mut self) {
        self.friction.release();
    }
}
