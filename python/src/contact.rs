//! What touches.

use std::collections::BTreeMap;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

use numpy::PyArray2;
use pyo3::prelude::*;

use crate::array::rows;
use crate::pickle::{Kept, Reduced, reduced};

/// An inverse, as what it has found knows it.
#[derive(Clone)]
pub(crate) struct Origin {
    /// Tells it from the others, in all processes.
    number: u64,
    /// Names of its shapes, which are in memory once.
    pub(crate) shapes: Arc<[String]>,
}

impl Origin {
    /// A new one.
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

    /// Whether both are of one inverse.
    pub(crate) fn is(&self, other: &Self) -> bool {
        self.number == other.number
    }
}

/// What touches, with how sure that is: what `Tracker.update` returns. Deviations are standard deviations. An inverse by tables may not know the force: it is 0 then.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Contact {
    pub(crate) contact: twintac::Contact,
    /// Of the inverse that has found it.
    pub(crate) origin: Origin,
    /// Where the readings come from: `"real"`, `"emulated"` or `"simulated"`.
    #[pyo3(get)]
    pub(crate) provenance: String,
}

#[pymethods]
impl Contact {
    /// Name of the most probable shape, of which the rest is said.
    #[getter]
    fn shape(&self) -> &str {
        &self.origin.shapes[self.contact.shape]
    }

    /// How probable each of the known shapes is; they sum up to 1.
    #[getter]
    fn shape_probabilities(&self) -> BTreeMap<&str, f64> {
        let names = self.origin.shapes.iter().map(String::as_str);
        names
            .zip(self.contact.shape_probabilities.iter().copied())
            .collect()
    }

    /// Place of the shape's origin in the gel's plane, x and y, mm.
    #[getter]
    fn place_mm(&self) -> (f64, f64) {
        self.contact.place_mm.into()
    }

    /// Depth below first touch, mm.
    #[getter]
    fn depth_mm(&self) -> f64 {
        self.contact.depth_mm
    }

    /// Turn about the vertical, radians, up to what makes no difference to the shape; 0 for a round one.
    #[getter]
    fn spin_rad(&self) -> f64 {
        self.contact.spin_rad
    }

    /// Force into the gel, N.
    #[getter]
    fn force_n(&self) -> f64 {
        self.contact.force_n
    }

    /// Deviation of the place along x and along y, mm.
    #[getter]
    fn place_deviation_mm(&self) -> (f64, f64) {
        self.contact.place_deviation_mm.into()
    }

    /// Deviation of the depth, mm.
    #[getter]
    fn depth_deviation_mm(&self) -> f64 {
        self.contact.depth_deviation_mm
    }

    /// Deviation of the spin, radians; 0 for a round shape.
    #[getter]
    fn spin_deviation_rad(&self) -> f64 {
        self.contact.spin_deviation_rad
    }

    /// Deviation of the force, N.
    #[getter]
    fn force_deviation_n(&self) -> f64 {
        self.contact.force_deviation_n
    }

    /// Covariance of x, y and depth, mm, and spin, radians; `[4, 4]`.
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(py, self.contact.covariance.as_flattened().to_vec(), [4, 4])
    }

    /// What the shape leaves of the readings, in deviations of a frame by itself: far above 1, something else touches.
    #[getter]
    fn misfit(&self) -> f64 {
        self.contact.misfit
    }

    /// What a pickle keeps.
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
