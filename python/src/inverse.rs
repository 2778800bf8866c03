//! From readings back to what touches.

use std::collections::BTreeMap;
use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use twintac::{FastModel, InverseSettings, KnownShape, Locator, LocatorTracker, Surfaces, TableModel};

use crate::contact::{Contact, Origin};
use crate::error::{OrRaise, unusable};
use crate::fast::FastGel;
use crate::floor::FloorMap;
use crate::given::{Array, Given, since};
use crate::long_call::{followed, long_call};
use crate::pickle::refused;
use crate::recording::Provenance;
use crate::settings::over;
use crate::shape::Shape;
use crate::shared::Shared;
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
    origin: Origin,
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
        let origin = Origin::of(shapes.keys().cloned().collect());
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
            origin,
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
            origin: Origin::of(shapes.into()),
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
            origin: Origin::of(locator.indenters().to_vec().into()),
            n_taxels: locator.taxels().len(),
            model: Model::Twin(Box::new(locator)),
        })
    }

    /// Names of the shapes; in alphabetical order, or of a twin as its sensor's description has its indenters.
    #[getter]
    fn shapes(&self) -> Vec<String> {
        self.origin.shapes.to_vec()
    }

    /// Follows the contact of a sensor that nothing has touched yet. `provenance` says where its readings come from: `"real"`, `"emulated"` or `"simulated"`.
    fn start(&self, provenance: Provenance) -> Tracker {
        Tracker {
            tracker: Shared::new(match &self.model {
                Model::Fast(inverse) => Follower::Fast(Box::new(inverse.start())),
                Model::Tables(inverse) => Follower::Tables(Box::new(inverse.start())),
                Model::Twin(locator) => Follower::Twin(Box::new(locator.start())),
            }),
            origin: self.origin.clone(),
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
        Ok(FloorMap::new(map, self.origin.clone()))
    }

    /// An inverse is none: it is made where it is used.
    fn __reduce__(&self) -> PyResult<()> {
        refused(
            "Inverse",
            "make it in each process, of the same shapes and settings",
        )
    }

    fn __repr__(&self) -> String {
        let by = match self.model {
            Model::Fast(_) => "a fast gel",
            Model::Tables(_) => "tables",
            Model::Twin(_) => "a twin",
        };
        format!("<Inverse by {by}, of {:?}>", self.origin.shapes)
    }
}

/// Follows the contact of one sensor, frame by frame: what `Inverse.start` returns.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Tracker {
    tracker: Shared<Follower>,
    origin: Origin,
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
    /// Raises `Error` for a time below 0, another number of readings, and readings that are not finite or beyond a million kPa.
    fn update(
        &self,
        py: Python<'_>,
        since_previous_s: f64,
        readings_kpa: Given<'_>,
    ) -> PyResult<Option<Contact>> {
        since(py, since_previous_s)?;
        let expected = format!("{} numbers, kPa", self.n_taxels);
        let readings_kpa: Array<1> = readings_kpa.numbers("readings_kpa", &expected)?;
        let readings_kpa = readings_kpa.values;
        if readings_kpa.len() != self.n_taxels {
            let problem = format!("has {} numbers, expected {expected}", readings_kpa.len());
            return Err(unusable(py, "readings_kpa", &problem));
        }
        let contact = self.tracker.work(py, |tracker| match tracker {
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
        })?;
        Ok(contact.or_raise(py)?.map(|contact| Contact {
            origin: self.origin.clone(),
            provenance: self.provenance.to_string(),
            contact,
        }))
    }

    /// A tracker is none: it is started where it is used.
    fn __reduce__(&self) -> PyResult<()> {
        refused("Tracker", "start one in each process, with Inverse.start")
    }

    fn __repr__(&self) -> String {
        let (n_taxels, provenance) = (self.n_taxels, &self.provenance);
        format!("<Tracker of {n_taxels} taxels, {provenance}>")
    }
}
