//! From readings back to what touches.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use numpy::PyArray2;
use numpy::ndarray::Ix1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use twintac::{FastModel, InverseSettings, KnownShape, Locator, LocatorTracker, Surfaces, TableModel};

use crate::array::{Numbers, in_order, rows};
use crate::error::{OrRaise, unusable};
use crate::fast::FastGel;
use crate::floor::FloorMap;
use crate::long_call::{followed, long_call};
use crate::recording::Provenance;
use crate::sensors::since;
use crate::settings::over;
use crate::shape::Shape;
use crate::table::ReadingTable;

/// Finds from readings what touches: place, depth, force, and which of the known shapes.
///
/// Made like this it knows what is read by a fast gel and the shapes, by name, that may touch it, upright; `of_twin` takes a trained twin in its place, `of_tables` tables of readings.
/// Keywords are settings:
///
/// - `noise_kpa`: standard deviation of a reading's noise, kPa; 0.05 unless given.
/// - `model_part`, `model_part_of_largest`: standard deviation of the model's error as part of each reading, 0.03, and as part of the frame's largest one, 0.01.
/// - `force_part`: the same of the force, as part of it; 0.03.
/// - `correlated_s`: time within which errors of the model count as one, s; 0.1.
/// - `touch_deviations`: a contact is what reads so many deviations of the noise, at one taxel at least; 6.
/// - `place_walk_mm`, `depth_walk_mm`, `spin_walk_rad`: how far a contact wanders in a second: 3 mm, 2 mm, 1 radian.
/// - `shape_memory_s`: time after which what told the shape is forgotten to a part of 1/e, s; 3.
/// - `n_starts`, `n_steps`: presses of each shape that are followed at once, 3, and steps towards the best of them in a frame, 1.
/// - `deepest_mm`: deepest press that is thought of, mm; 5. Not deeper than the gel was taught.
///
/// Raises `Error`, whose `field` is the setting that cannot be, for a shape that cannot be, and if there is no shape.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Inverse {
    model: Model,
    /// Names; where they are in memory tells contacts of this inverse from those of others.
    shapes: Arc<[String]>,
    n_taxels: usize,
}

/// By what it knows what is read of a contact.
enum Model {
    Fast(Box<twintac::Inverse<FastModel>>),
    Tables(twintac::Inverse<TableModel>),
    Twin(Box<Locator>),
}

#[pymethods]
impl Inverse {
    #[new]
    #[pyo3(signature = (gel, shapes, **settings))]
    fn new(
        py: Python<'_>,
        gel: &FastGel,
        shapes: BTreeMap<String, Shape>,
        settings: Option<Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let settings = over(InverseSettings::default(), settings.as_ref(), py)?;
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
            model: Model::Fast(Box::new(inverse.or_raise(py)?)),
            shapes: names,
            n_taxels,
        })
    }

    /// By what is read of each shape, by name, at places and depths: measured, or simulated. Keywords are those of the class, which has the names of the settings.
    ///
    /// Raises `Error` for tables of different numbers of taxels, a setting that cannot be, and if there is no shape.
    #[staticmethod]
    #[pyo3(signature = (tables, **settings))]
    fn of_tables(
        py: Python<'_>,
        tables: BTreeMap<String, ReadingTable>,
        settings: Option<Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let settings = over(InverseSettings::default(), settings.as_ref(), py)?;
        let (shapes, tables): (Vec<String>, Vec<ReadingTable>) = tables.into_iter().unzip();
        let n_taxels = tables.first().map_or(0, ReadingTable::n_taxels);
        if let Some(other) = tables.iter().map(ReadingTable::n_taxels).find(|n| *n != n_taxels) {
            return Err(unusable(
                py,
                "tables",
                &format!("have {n_taxels} and {other} taxels"),
            ));
        }
        let tables = tables.into_iter().map(|table| table.table).collect();
        let inverse = long_call(py, move || {
            twintac::Inverse::new(TableModel::new(tables), settings)
        })?;
        Ok(Self {
            model: Model::Tables(inverse.or_raise(py)?),
            shapes: shapes.into(),
            n_taxels,
        })
    }

    /// By the trained twin in a folder (`Run.model_folder`), whose memory is taken off the readings. Shapes are the named indenters of its sensor, or all of them, turned as described.
    /// Keywords are those of the class, which has the names of the settings; unless given, `noise_kpa` is 0.03, `model_part_of_largest` 0.02, `n_steps` 3 and
    /// `deepest_mm` 2.5. Taxels that the description calls doubtful are not used. The gel is solved at places all over the taxels, which takes minutes; Ctrl-C stops it.
    ///
    /// Raises `Error` for a folder that holds no twin, an indenter that the sensor does not have, and a setting that cannot be.
    #[staticmethod]
    #[pyo3(signature = (folder, indenters=Vec::new(), *, progress=None, **settings))]
    fn of_twin(
        py: Python<'_>,
        folder: PathBuf,
        indenters: Vec<String>,
        progress: Option<Bound<'_, PyAny>>,
        settings: Option<Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let settings = over(Locator::settings(None).or_raise(py)?, settings.as_ref(), py)?;
        let locator = followed(py, progress.as_ref(), move |progress| {
            Locator::open(&folder, &indenters, settings, progress.as_ref())
        })?;
        let locator = locator.or_raise(py)?;
        Ok(Self {
            shapes: locator.indenters().to_vec().into(),
            n_taxels: locator.taxels().len(),
            model: Model::Twin(Box::new(locator)),
        })
    }

    /// Names of the shapes; in alphabetical order, or of a twin as its sensor's description has its indenters.
    #[getter]
    fn shapes(&self) -> Vec<String> {
        self.shapes.to_vec()
    }

    /// Follows the contact of a sensor that nothing has touched yet. `provenance` says where its readings come from: `"real"`, `"emulated"` or `"simulated"`.
    fn start(&self, provenance: Provenance) -> Tracker {
        Tracker {
            tracker: match &self.model {
                Model::Fast(inverse) => Follower::Fast(Box::new(inverse.start())),
                Model::Tables(inverse) => Follower::Tables(Box::new(inverse.start())),
                Model::Twin(locator) => Follower::Twin(Box::new(locator.start())),
            },
            shapes: Arc::clone(&self.shapes),
            n_taxels: self.n_taxels,
            provenance,
        }
    }

    /// Prepares maps of the pressure on the gel's floor under contacts, finer than the taxels: on a grid of this spacing, mm, in the middle of the gel. 0.5 mm makes about 2,500 points
    /// of PhysTac's floor.
    ///
    /// Raises `Error` for a spacing that is not above 0 or makes more than ten million points, and for an inverse that is not of a fast gel.
    #[pyo3(signature = (spacing_mm=0.5))]
    fn floor_map(&self, py: Python<'_>, spacing_mm: f64) -> PyResult<FloorMap> {
        let Model::Fast(inverse) = &self.model else {
            return Err(unusable(
                py,
                "inverse",
                "is not of a fast gel, which alone knows the floor",
            ));
        };
        let map = py.detach(|| inverse.floor_map(spacing_mm)).or_raise(py)?;
        Ok(FloorMap::new(map, Arc::clone(&self.shapes)))
    }

    fn __repr__(&self) -> String {
        format!("<Inverse of {:?}>", self.shapes)
    }
}

/// Follows the contact of one sensor, frame by frame: what `Inverse.start` returns.
#[pyclass(module = "twintac")]
pub(crate) struct Tracker {
    tracker: Follower,
    shapes: Arc<[String]>,
    n_taxels: usize,
    provenance: Provenance,
}

enum Follower {
    Fast(Box<twintac::Tracker<FastModel>>),
    Tables(Box<twintac::Tracker<TableModel>>),
    Twin(Box<LocatorTracker>),
}

#[pymethods]
impl Tracker {
    /// Where the readings come from: `"real"`, `"emulated"` or `"simulated"`.
    #[getter]
    fn provenance(&self) -> String {
        self.provenance.to_string()
    }

    /// Takes a frame, `since_previous_s` after the one before: readings above the untouched sensor, kPa, `[n_taxels]`. Of an inverse by a twin, a NaN is a taxel without
    /// a usable reading: its last usable one stands. Returns what touches, or `None` if the readings are within noise.
    ///
    /// Raises `Error` for a time below 0, another number of readings, and readings that are not finite.
    fn update(
        &mut self,
        py: Python<'_>,
        since_previous_s: f64,
        readings_kpa: Numbers<'_, Ix1>,
    ) -> PyResult<Option<Contact>> {
        since(py, since_previous_s)?;
        let readings_kpa = in_order(&readings_kpa).into_owned(); // other threads may write into the array meanwhile
        let is_usable = |kpa: &f64| kpa.is_finite() || matches!(self.tracker, Follower::Twin(_));
        if readings_kpa.len() != self.n_taxels || !readings_kpa.iter().all(is_usable) {
            let problem = format!("has to have {} finite numbers", self.n_taxels);
            return Err(unusable(py, "readings_kpa", &problem));
        }
        let tracker = &mut self.tracker;
        let contact = py.detach(|| match tracker {
            Follower::Fast(tracker) => tracker
                .update(since_previous_s, &readings_kpa)
                .map(Option::<&_>::cloned),
            Follower::Tables(tracker) => tracker
                .update(since_previous_s, &readings_kpa)
                .map(Option::<&_>::cloned),
            Follower::Twin(tracker) => {
                let valid: Vec<bool> = readings_kpa.iter().map(|kpa| kpa.is_finite()).collect();
                tracker
                    .update(since_previous_s, &readings_kpa, &valid)
                    .map(Option::<&_>::cloned)
            }
        });
        Ok(contact.or_raise(py)?.map(|contact| Contact {
            shapes: Arc::clone(&self.shapes),
            provenance: self.provenance.to_string(),
            contact,
        }))
    }
}

/// What touches, with how sure that is: what `Tracker.update` returns. Deviations are standard deviations. An inverse by tables may not know the force: it is 0 then.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Contact {
    pub(crate) contact: twintac::Contact,
    /// Names of the shapes of the inverse that has found it, which are in memory once.
    pub(crate) shapes: Arc<[String]>,
    /// Where the readings come from: `"real"`, `"emulated"` or `"simulated"`.
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
