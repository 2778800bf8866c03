//! Friction of a body on the surrogate of a gel.

use pyo3::prelude::*;

use crate::error::{OrRaise, unusable};
use crate::fast::{FastReader, Reading};
use crate::pickle::refused;
use crate::pose::Pose;
use crate::sensor::Sensor;
use crate::shape::Body;
use crate::shared::Shared;

/// Friction of one body on one sensor's gel, frame by frame: the body shears the top of the gel
/// until it slips. At first, there is no contact.
///
/// - `sensor`: the sensor.
/// - `coefficient`: Coulomb's coefficient, 0 or more.
///
/// Raises `Error` for a coefficient that is negative or not finite.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Friction {
    friction: Shared<twintac::Friction>,
    sensor: String,
    coefficient: f64,
}

#[pymethods]
impl Friction {
    #[new]
    fn new(py: Python<'_>, sensor: &Sensor, coefficient: f64) -> PyResult<Self> {
        Ok(Self {
            friction: Shared::new(friction(py, sensor, ("coefficient", coefficient))?),
            sensor: sensor.sensor.name().to_owned(),
            coefficient,
        })
    }

    /// Computes one more frame of a sensor that this body alone touches.
    ///
    /// - `reader`: the reader of the sensor's surrogate.
    /// - `body`: the body.
    /// - `gel_from_body`: pose of the body in the gel's frame.
    ///
    /// Returns what `FastReader.read` returns, with friction.
    ///
    /// Raises `Error` for the reader of another gel.
    fn read<'py>(
        &self,
        py: Python<'py>,
        reader: &FastReader,
        body: &Body,
        gel_from_body: Pose,
    ) -> PyResult<Reading<'py>> {
        self.friction.look(py, |friction| {
            let check = reader.reader().look(py, |reader| friction.check(reader))?;
            check.or_raise(py)?;
            reader.answer(py, |reader, pressure_kpa, wrench| {
                let touching = (&*body.body, gel_from_body.pose);
                friction.read(reader, touching, pressure_kpa, wrench);
            })
        })?
    }

    /// Ends the contact: the next frame begins without friction.
    fn release(&self, py: Python<'_>) -> PyResult<()> {
        self.friction.look(py, twintac::Friction::release)
    }

    /// Raises `TypeError`: a `Friction` cannot be pickled or copied.
    fn __reduce__(&self) -> PyResult<()> {
        refused(
            "Friction",
            "make one in each process, of the same sensor and coefficient",
        )
    }

    fn __repr__(&self) -> String {
        format!(
            "<Friction on {:?}, coefficient {}>",
            self.sensor, self.coefficient
        )
    }
}

/// Friction, if the coefficient is allowed.
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
