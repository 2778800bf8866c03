//! Many imperfect sensors.

use std::path::PathBuf;

use numpy::PyArray2;
use numpy::ndarray::Ix2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::{Numbers, rows};
use crate::error::{OrRaise, unreadable, unusable};
use crate::fast::{Answers, FastGel, PROVENANCE, n_cores};
use crate::sensor::Sensor;
use crate::settings::as_toml;
use crate::shape::Body;
use crate::touches::{Counts, Touches, bodies};
use crate::twin::Twin;

/// How far sensors are from perfect: from what each sensor's own imperfections are drawn.
#[pyclass(frozen, eq, from_py_object, module = "twintac")]
#[derive(Clone, PartialEq)]
pub(crate) struct Imperfection {
    pub(crate) imperfection: twintac::Imperfection,
}

impl Imperfection {
    fn parse(py: Python<'_>, file: &str, text: &str) -> PyResult<Self> {
        let parsed = twintac::Imperfection::parse(file, text).map_err(twintac::RunError::from);
        Ok(Self {
            imperfection: parsed.or_raise(py)?,
        })
    }
}

#[pymethods]
impl Imperfection {
    /// Without keywords, a perfect sensor. Keywords are the fields of `[imperfection]` in a file: `gain_deviation=0.05`.
    #[new]
    #[pyo3(signature = (**fields))]
    fn new(py: Python<'_>, fields: Option<Bound<'_, PyDict>>) -> PyResult<Self> {
        let file = PyDict::new(py);
        file.set_item("imperfection", fields.unwrap_or_else(|| PyDict::new(py)))?;
        Self::parse(py, "imperfection", &as_toml(file.as_any())?)
    }

    /// Reads a file (TOML) with the table `[imperfection]`, as `twintac fast imperfection` makes them.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let text = std::fs::read_to_string(&path).map_err(|error| unreadable(py, &path, &error))?;
        Self::parse(py, &path.display().to_string(), &text)
    }

    fn __repr__(&self) -> String {
        format!("<{:?}>", self.imperfection)
    }
}

/// How bodies and gels hold each other where bodies move freely: friction, with Coulomb's coefficient, and the gel's loss, as of a Kelvin-Voigt solid: its force leads the
/// elastic one by a time.
#[pyclass(frozen, from_py_object, module = "twintac")]
#[derive(Clone)]
pub(crate) struct Coupling {
    coupling: twintac::Coupling,
}

#[pymethods]
impl Coupling {
    #[new]
    #[pyo3(signature = (sensor, *, friction, retardation_s=0.0))]
    fn new(py: Python<'_>, sensor: &Sensor, friction: f64, retardation_s: f64) -> PyResult<Self> {
        if !(retardation_s.is_finite() && retardation_s >= 0.0) {
            return Err(unusable(py, "retardation_s", "is not a number from 0 on"));
        }
        Ok(Self {
            coupling: twintac::Coupling {
                friction: crate::friction::friction(py, sensor, friction)?,
                retardation_s,
            },
        })
    }
}

/// Many sensors of one kind, each imperfect in its own way, stepped in one call.
#[pyclass(module = "twintac")]
pub(crate) struct SensorBatch {
    batch: twintac::SensorBatch,
    bodies: Vec<twintac::Body>,
    n_taxels: usize,
}

#[pymethods]
impl SensorBatch {
    /// So many sensors whose gels have rested, which these bodies touch. With a twin, readings are those of its barometers; without, the
    /// pressures at the ports. Sensor `n` is the same under the same seed, whatever the other sensors are.
    #[new]
    #[pyo3(signature = (gel, bodies, n_sensors, *, imperfection=None, twin=None, coupling=None, seed=0, n_threads=None))]
    #[allow(clippy::too_many_arguments)] // keywords in Python
    fn new(
        py: Python<'_>,
        gel: &FastGel,
        bodies: Vec<Body>,
        n_sensors: usize,
        imperfection: Option<Imperfection>,
        twin: Option<PyRef<'_, Twin>>,
        coupling: Option<Coupling>,
        seed: u64,
        n_threads: Option<usize>,
    ) -> PyResult<Self> {
        let bodies = self::bodies(py, bodies)?;
        let imperfection = imperfection.map(|own| own.imperfection).unwrap_or_default();
        let n_taxels = gel.gel.n_taxels();
        let twin = twin.map(|twin| std::sync::Arc::clone(&twin.twin));
        if let Some(twin) = &twin {
            let n_of_twin = twin.sensor().taxels().count();
            if n_of_twin != n_taxels {
                let problem = format!("has {n_of_twin} taxels, the gel {n_taxels}");
                return Err(unusable(py, "twin", &problem));
            }
        }
        let sizes = [n_sensors, n_threads.unwrap_or_else(n_cores)];
        let batch = py.detach(|| match twin {
            Some(twin) => twin.sensors(&gel.gel, imperfection, sizes, seed),
            None => twintac::SensorBatch::new(&gel.gel, None, imperfection, sizes, seed),
        });
        let batch = match coupling {
            Some(own) => batch.with_coupling(own.coupling),
            None => batch,
        };
        Ok(Self {
            batch,
            bodies,
            n_taxels,
        })
    }

    /// What every reading is: simulated.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// One more moment of every sensor, `since_previous_s` after the last. The other arguments are those of `FastBatch.read`.
    ///
    /// Returns what the bus of each sensor delivered last, kPa, `[n_sensors, n_taxels]`, and wrenches, N and N mm, `[n_sensors, 6]`.
    #[pyo3(signature = (since_previous_s, gel_from_body, body=None, ends=None))]
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        since_previous_s: f64,
        gel_from_body: Numbers<'_, Ix2>,
        body: Option<Counts<'_>>,
        ends: Option<Counts<'_>>,
    ) -> PyResult<Answers<'py>> {
        since(py, since_previous_s)?;
        let Touches { touches, ends } = Touches::checked(
            py,
            &gel_from_body,
            body.as_ref(),
            ends.as_ref(),
            self.bodies.len(),
        )?;
        let n_sensors = self.batch.n_sensors();
        if ends.len() != n_sensors {
            let problem = format!(
                "has {} numbers, expected one for each of {n_sensors} sensors",
                ends.len()
            );
            return Err(unusable(py, "ends", &problem));
        }
        let mut readings_kpa = vec![0.0; n_sensors * self.n_taxels];
        let mut wrench = vec![[0.0; 6]; n_sensors];
        py.detach(|| {
            let bodies = &self.bodies;
            self.batch.step(
                since_previous_s,
                bodies,
                &touches,
                &ends,
                &mut readings_kpa,
                &mut wrench,
            );
        });
        Ok((
            rows(py, readings_kpa, [n_sensors, self.n_taxels])?,
            rows(py, wrench.into_flattened(), [n_sensors, 6])?,
        ))
    }

    /// What each body did in the last step by itself, in the order of the touches: force on the gel, N, and torque about the top of its middle, N mm,
    /// `[n_touches, 6]`. None without a `Coupling`.
    fn wrench_of_touches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let wrenches: Vec<f32> = self.batch.wrench_of_touches().flatten().copied().collect();
        let n_touches = wrenches.len() / 6;
        rows(py, wrenches, [n_touches, 6])
    }

    /// Lets the gel of one sensor rest until its next step, with the imperfections that it has.
    fn rest(&mut self, py: Python<'_>, sensor: usize) -> PyResult<()> {
        self.check(py, sensor)?;
        self.batch.rest(sensor);
        Ok(())
    }

    /// Puts another sensor in the place of one, with imperfections that are drawn anew, and lets it rest. `number` tells new sensors apart: those
    /// below the number of sensors are the first ones.
    fn replace(&mut self, py: Python<'_>, sensor: usize, number: u64) -> PyResult<()> {
        self.check(py, sensor)?;
        self.batch.replace(sensor, number);
        Ok(())
    }

    fn __len__(&self) -> usize {
        self.batch.n_sensors()
    }
}

impl SensorBatch {
    fn check(&self, py: Python<'_>, sensor: usize) -> PyResult<()> {
        let n_sensors = self.batch.n_sensors();
        if sensor < n_sensors {
            return Ok(());
        }
        Err(unusable(
            py,
            "sensor",
            &format!("is {sensor}, there are {n_sensors}"),
        ))
    }
}

/// A time between frames that can be.
pub(crate) fn since(py: Python<'_>, since_previous_s: f64) -> PyResult<()> {
    if since_previous_s >= 0.0 && since_previous_s.is_finite() {
        return Ok(());
    }
    let problem = format!("is {since_previous_s}, expected 0 or more");
    Err(unusable(py, "since_previous_s", &problem))
}
