//! Estimated contacts.

use std::collections::BTreeMap;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

use numpy::PyArray2;
use pyo3::prelude::*;

use crate::array::rows;
use crate::pickle::{Kept, Reduced, reduced};

/// Identifies the inverse that found a contact.
#[derive(Clone)]
pub(crate) struct Origin {
    /// A number that differs between inverses, in all processes.
    number: u64,
    /// Names of its shapes, shared in memory.
    pub(crate) shapes: Arc<[String]>,
}

impl Origin {
    /// A new identity.
    pub(crate) fn of(shapes: Arc<[String]>) -> Self {
        let mut hasher = RandomState::new().build_hasher();
        hasher.write_u32(std::process::id());
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        hasher.write_u128(now.map_or(0, |now| now.as_nanos()));
        Self {
            number: hasher.finish(),
            shapes,
        }
    }

    /// Whether both belong to the same inverse.
    pub(crate) fn is(&self, other: &Self) -> bool {
        self.number == other.number
    }
}

/// The estimated contact, with its uncertainty: the result of `Tracker.update`. Deviations are
/// standard deviations. An inverse of tables (`Inverse.of_tables`) may not know the force, which is
/// 0 then.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Contact {
    pub(crate) contact: twintac::Contact,
    /// The inverse that found it.
    pub(crate) origin: Origin,
    /// Provenance of the readings: `"real"`, `"emulated"` or `"simulated"`.
    #[pyo3(get)]
    pub(crate) provenance: String,
}

#[pymethods]
impl Contact {
    /// Name of the most probable shape. The other properties describe the contact of this shape.
    #[getter]
    fn shape(&self) -> &str {
        &self.origin.shapes[self.contact.shape]
    }

    /// Probability of each known shape, by name. The sum is 1.
    #[getter]
    fn shape_probabilities(&self) -> BTreeMap<&str, f64> {
        let names = self.origin.shapes.iter().map(String::as_str);
        names
            .zip(self.contact.shape_probabilities.iter().copied())
            .collect()
    }

    /// Location of the shape's origin in the gel's plane: x and y, mm.
    #[getter]
    fn place_mm(&self) -> (f64, f64) {
        self.contact.place_mm.into()
    }

    /// Depth below first touch, mm.
    #[getter]
    fn depth_mm(&self) -> f64 {
        self.contact.depth_mm
    }

    /// Yaw (rotation about the vertical axis), radians, modulo the symmetry of the shape; 0 for a
    /// round shape.
    #[getter]
    fn yaw_rad(&self) -> f64 {
        self.contact.yaw_rad
    }

    /// Force into the gel, N.
    #[getter]
    fn force_n(&self) -> f64 {
        self.contact.force_n
    }

    /// Standard deviation of the location along x and along y, mm.
    #[getter]
    fn place_deviation_mm(&self) -> (f64, f64) {
        self.contact.place_deviation_mm.into()
    }

    /// Standard deviation of the depth, mm.
    #[getter]
    fn depth_deviation_mm(&self) -> f64 {
        self.contact.depth_deviation_mm
    }

    /// Standard deviation of the yaw, radians; 0 for a round shape.
    #[getter]
    fn yaw_deviation_rad(&self) -> f64 {
        self.contact.yaw_deviation_rad
    }

    /// Standard deviation of the force, N.
    #[getter]
    fn force_deviation_n(&self) -> f64 {
        self.contact.force_deviation_n
    }

    /// Covariance of x, y and depth, mm, and yaw, radians, in this order; `[4, 4]`. Its units are
    /// products of these: mm², mm rad and rad².
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(py, self.contact.covariance.as_flattened().to_vec(), [4, 4])
    }

    /// Root mean square of the residuals of the readings, in standard deviations of a single frame.
    /// If it is far above 1, something else touches the gel.
    #[getter]
    fn misfit(&self) -> f64 {
        self.contact.misfit
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        let (x_mm, y_mm) = self.place_mm();
        format!(
            "<Contact {:?} at ({x_mm:.2}, {y_mm:.2}) mm, {:.2} mm deep, {:.2} N, {}>",
            self.shape(),
            self.depth_mm(),
            self.force_n(),
            self.provenance
        )
    }
}

impl Kept for Contact {
    /// Number and shapes of the inverse, provenance, and the contact.
    type State = (u64, Vec<String>, String, twintac::Contact);

    fn state(&self, _: Python<'_>) -> PyResult<Self::State> {
        let Origin { number, shapes } = &self.origin;
        Ok((
            *number,
            shapes.to_vec(),
            self.provenance.clone(),
            self.contact.clone(),
        ))
    }

    fn restored(_: Python<'_>, (number, shapes, provenance, contact): Self::State) -> PyResult<Self> {
        let shapes = shapes.into();
        Ok(Self {
            contact,
            origin: Origin { number, shapes },
            provenance,
        })
    }
}
