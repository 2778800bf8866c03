//! Friction of a body on a fast gel.

use pyo3::prelude::*;

use crate::error::{OrRaise, unusable};
use crate::fast::{FastReader, Reading};
use crate::pose::Pose;
use crate::sensor::Sensor;
use crate::shape::Body;

/// Friction of one body on one sensor's gel, from one moment to the next: the gel's top is sheared with the body, until it slips. Nothing is held yet.
///
/// `coefficient` is Coulomb's, 0 or more; anything else raises `Error`.
#[pyclass(module = "twintac")]
pub(crate) struct Friction {
    friction: twintac::Friction,
}

#[pymethods]
impl Friction {
    #[new]
    fn new(py: Python<'_>, sensor: &Sensor, coefficient: f64) -> PyResult<Self> {
        Ok(Self {
            friction: friction(py, sensor, ("coefficient", coefficient))?,
        })
    }

    /// One more moment of a sensor that this body alone touches: what `FastReader.read` returns, with friction.
    ///
    /// Raises `Error` for the reader of another gel.
    fn read<'py>(
        &mut self,
        py: Python<'py>,
        reader: &mut FastReader,
        body: &Body,
        gel_from_body: Pose,
    ) -> PyResult<Reading<'py>> {
        self.friction.check(reader.reader()).or_raise(py)?;
        Ok(reader.answer(py, |reader, pressure_kpa, wrench| {
            let touching = (&*body.body, gel_from_body.pose);
            self.friction.read(reader, touching, pressure_kpa, wrench);
        }))
    }

    /// Lets go of what touches: the next moment begins without friction.
    fn release(&mut self) {
        self.friction.release();
    }
}

/// Friction with a coefficient that can be.
pub(crate) fn friction(
    py: Python<'_>,
    sensor: &Sensor,
    (field, coefficient): (&str, f64),
) -> PyResult<twintac::Friction> {
    if !(coefficient.is_finite() && coefficient >= 0.0) {
        return Err(unusable(
            py,
            field,
            &format!("is {coefficient}, expected 0 or more"),
        ));
    }
    Ok(twintac::Friction::on(&sensor.sensor.file().sensor, coefficient))
}
