//! Contact estimation from readings.

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

/// Contact estimation from readings: location, depth and force of the contact, and which of the
/// known shapes it is.
///
/// The constructor takes the surrogate of the gel as the model of the readings. `of_twin` takes a
/// trained twin instead, and `of_tables` takes tables of readings.
///
/// - `gel`: the surrogate of the gel.
/// - `shapes`: the known shapes that may touch the gel, by name. They are upright.
///
/// The other keywords are settings, here with their defaults:
///
/// - `noise_kpa`: standard deviation of a reading's noise, kPa; 0.05.
/// - `model_part`, `model_part_of_largest`: standard deviation of the model's error, as a fraction
///   of each reading, 0.03, and as a fraction of the largest reading of the frame, 0.01.
/// - `force_part`: standard deviation of the model's error of the force, as a fraction of the
///   force; 0.03.
/// - `correlated_s`: time within which errors of the model count as one, s; 0.1.
/// - `touch_deviations`: there is a contact if at least one reading is this many standard
///   deviations of the noise above zero; 6.
/// - `place_walk_mm`, `depth_walk_mm`, `yaw_walk_rad`: standard deviation of the random motion of
///   a contact in one second: location, 3 mm, depth, 2 mm, and yaw, 1 radian.
/// - `shape_memory_s`: time after which evidence for a shape is reduced to 1/e, s; 3.
/// - `n_starts`, `n_steps`: number of possible presses of each shape that are followed at once, 3,
///   and number of steps that each of them takes in a frame, 1.
/// - `deepest_mm`: largest depth that is considered, mm; 5. Give no more than the largest depth
///   that the surrogate was trained on.
///
/// Raises `Error` for a setting that is not allowed (its `field` names the setting), for an
/// impossible shape, and if there is no shape.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Inverse {
    model: Model,
    origin: Origin,
    n_taxels: usize,
}

/// The model of the readings that it uses.
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

    /// An inverse that takes tables of readings, measured or simulated, as the model of the
    /// readings.
    ///
    /// - `tables`: for each shape, by name, the readings at locations and depths.
    ///
    /// The other keywords are settings, as in the class.
    ///
    /// Raises `Error` for tables with different numbers of taxels, for a setting that is not
    /// allowed, and if there is no shape.
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

    /// An inverse that takes a trained twin as the model of the readings. It removes the twin's
    /// viscoelastic relaxation from the readings. Excluded taxels (`doubtful` in the description)
    /// are not used. The gel is computed by finite elements at locations all over the taxels, which
    /// takes minutes; Ctrl-C stops it.
    ///
    /// - `folder`: folder of the twin (`Run.model_folder`).
    /// - `indenters`: names of the sensor's indenters that are the known shapes, in the described
    ///   orientation; all of them unless given.
    /// - `progress`: display of the progress, see `Progress`.
    ///
    /// The other keywords are settings, as in the class. Unless given, `noise_kpa` is 0.03,
    /// `model_part_of_largest` 0.02, `n_steps` 3 and `deepest_mm` 2.5.
    ///
    /// Raises `Error` for a folder that holds no twin, for an indenter that the sensor does not
    /// have, and for a setting that is not allowed.
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

    /// Names of the known shapes, in alphabetical order; for a twin, in the order of the indenters
    /// in the sensor description.
    #[getter]
    fn shapes(&self) -> Vec<String> {
        self.origin.shapes.to_vec()
    }

    /// Starts the contact estimation for a sensor that nothing has touched yet.
    ///
    /// - `provenance`: provenance of its readings: `"real"`, `"emulated"` or `"simulated"`.
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

    /// Prepares maps of the pressure on the base of the gel under contacts, at more points than the
    /// taxels.
    ///
    /// - `spacing_mm`: spacing of the grid of points, mm. The grid is centred on the gel, and
    ///   covers the locations at which a port is within it. 0.5 mm makes about 2,000 points for
    ///   PhysTac.
    ///
    /// Raises `Error` for a spacing that is not above 0 or makes more than ten million points, for
    /// an inverse without a surrogate, and for a gel with boxes cast into it.
    #[pyo3(signature = (spacing_mm=0.5))]
    fn floor_map(&self, py: Python<'_>, spacing_mm: f64) -> PyResult<FloorMap> {
        let Model::Fast(inverse) = &self.model else {
            return Err(unusable(
                py,
                "inverse",
                "is not of a `FastGel`, which alone computes pressures at the base of the gel",
            ));
        };
        let map = py.detach(|| inverse.floor_map(spacing_mm)).or_raise(py)?;
        Ok(FloorMap::new(map, self.origin.clone()))
    }

    /// Raises `TypeError`: an `Inverse` cannot be pickled or copied.
    fn __reduce__(&self) -> PyResult<()> {
        refused(
            "Inverse",
            "make it in each process, of the same shapes and settings",
        )
    }

    fn __repr__(&self) -> String {
        let by = match self.model {
            Model::Fast(_) => "a surrogate",
            Model::Tables(_) => "tables",
            Model::Twin(_) => "a twin",
        };
        format!("<Inverse by {by}, of {:?}>", self.origin.shapes)
    }
}

/// Estimates the contact of one sensor, frame by frame. `Inverse.start` returns it.
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
    /// Provenance of the readings: `"real"`, `"emulated"` or `"simulated"`.
    #[getter]
    fn provenance(&self) -> String {
        self.provenance.to_string()
    }

    /// Takes one more frame, and estimates the contact.
    ///
    /// - `since_previous_s`: time since the previous frame, s.
    /// - `readings_kpa`: readings above the untouched sensor, kPa; `[n_taxels]`. With a twin as the
    ///   model, NaN marks a taxel without a usable reading; its last usable reading is taken.
    ///
    /// Returns the contact, or `None` if the readings are within noise.
    ///
    /// Raises `Error` for a time below 0, for another number of readings, and for readings that are
    /// beyond a million kPa or, without a twin as the model, not finite.
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

    /// Raises `TypeError`: a `Tracker` cannot be pickled or copied.
    fn __reduce__(&self) -> PyResult<()> {
        refused("Tracker", "start one in each process, with Inverse.start")
    }

    fn __repr__(&self) -> String {
        let (n_taxels, provenance) = (self.n_taxels, &self.provenance);
        format!("<Tracker of {n_taxels} taxels, {provenance}>")
    }
}
