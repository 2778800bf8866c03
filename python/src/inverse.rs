//! From readings back to what touches.

use std::collections::BTreeMap;

use numpy::PyArray2;
use numpy::ndarray::Ix1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use twintac::{FastModel, InverseSettings, KnownShape, Surfaces};

use crate::array::{Numbers, in_order, rows};
use crate::error::{OrRaise, unusable};
use crate::fast::FastGel;
use crate::long_call::long_call;
use crate::recording::Provenance;
use crate::sensors::since;
use crate::settings::from_python;
use crate::shape::Shape;

/// Finds from readings what touches: place, depth, force, and which of the known shapes.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Inverse {
    inverse: twintac::Inverse<FastModel>,
    shapes: Vec<String>,
    n_taxels: usize,
}

#[pymethods]
impl Inverse {
    /// Of a fast gel and the shapes, by name, that may touch it, upright. Keywords are settings: `noise_kpa=0.1`.
    #[new]
    #[pyo3(signature = (gel, shapes, **settings))]
    fn new(
        py: Python<'_>,
        gel: &FastGel,
        shapes: BTreeMap<String, Shape>,
        settings: Option<Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let settings: InverseSettings = match settings {
            Some(settings) => from_python(settings.as_any(), "settings")?,
            None => InverseSettings::default(),
        };
        let (gel, n_taxels) = (gel.gel.clone(), gel.gel.n_taxels());
        let names = shapes.keys().cloned().collect();
        let surfaces: Surfaces = shapes.values().flat_map(|shape| shape.surfaces.clone()).collect();
        let known = shapes.into_iter().map(|(name, shape)| KnownShape {
            name,
            shape: shape.shape,
        });
        let known: Vec<KnownShape> = known.collect();
        let inverse = long_call(py, move || {
            twintac::Inverse::of_fast_gel(&gel, &known, &surfaces, settings)
        })?;
        Ok(Self {
            inverse: inverse.or_raise(py)?,
            shapes: names,
            n_taxels,
        })
    }

    /// Names of the shapes.
    #[getter]
    fn shapes(&self) -> Vec<String> {
        self.shapes.clone()
    }

    /// Follows the contact of a sensor that nothing has touched yet, and whose readings come from where `provenance` says.
    fn start(&self, provenance: Provenance) -> Tracker {
        Tracker {
            tracker: self.inverse.start(),
            shapes: self.shapes.clone(),
            n_taxels: self.n_taxels,
            provenance,
        }
    }
}

/// Follows the contact of one sensor, frame by frame.
#[pyclass(module = "twintac")]
pub(crate) struct Tracker {
    tracker: twintac::Tracker<FastModel>,
    shapes: Vec<String>,
    n_taxels: usize,
    provenance: Provenance,
}

#[pymethods]
impl Tracker {
    /// Where the readings come from.
    #[getter]
    fn provenance(&self) -> String {
        self.provenance.to_string()
    }

    /// Takes a frame, `since_previous_s` after the one before: readings above the untouched sensor, kPa, `[n_taxels]`. Returns what touches, or
    /// nothing if the readings are within noise.
    fn update(
        &mut self,
        py: Python<'_>,
        since_previous_s: f64,
        readings_kpa: Numbers<'_, Ix1>,
    ) -> PyResult<Option<Contact>> {
        since(py, since_previous_s)?;
        let readings_kpa = in_order(&readings_kpa);
        if readings_kpa.len() != self.n_taxels || !readings_kpa.iter().all(|kpa| kpa.is_finite()) {
            let problem = format!("has to have {} finite numbers", self.n_taxels);
            return Err(unusable(py, "readings_kpa", &problem));
        }
        let contact = py.detach(|| self.tracker.update(since_previous_s, &readings_kpa).cloned());
        Ok(contact.map(|contact| Contact {
            shapes: self.shapes.clone(),
            provenance: self.provenance.to_string(),
            contact,
        }))
    }
}

/// What touches, with how sure that is. Deviations are standard deviations.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Contact {
    contact: twintac::Contact,
    shapes: Vec<String>,
    /// Where the readings come from.
    #[pyo3(get)]
    provenance: String,
}

#[pymethods]
impl Contact {
    /// Name of the most probable shape, of which the rest is said.
    #[getter]
    fn shape(&self) -> &str {
        &self.shapes[self.contact.shape]
    }

    /// How probable each of the known shapes is; they sum up to 1.
    #[getter]
    fn shape_probabilities(&self) -> BTreeMap<&str, f64> {
        let names = self.shapes.iter().map(String::as_str);
        names
            .zip(self.contact.shape_probabilities.iter().copied())
            .collect()
    }

    /// Place of the shape's origin in the gel's plane, mm.
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
