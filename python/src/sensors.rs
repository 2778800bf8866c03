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
use crate::settings::{as_toml, refused};
use crate::shape::Body;
use crate::touches::{Counts, Touches, bodies};
use crate::twin::Twin;

/// The table of a file in which imperfections stand.
const TABLE: &str = "imperfection";

/// How far sensors are from perfect: from what each sensor's own imperfections are drawn.
///
/// Keywords are the fields of `[imperfection]` in a file; each is 0 unless given, and `Imperfection()` is a perfect sensor. A *deviation* is the standard deviation of
/// a normal distribution about zero.
///
/// - `gain_deviation`: of each taxel's gain, as part of it.
/// - `growth_deviation_per_kpa`: of how much each taxel's reading grows beyond proportion for each kPa of it, 1/kPa.
/// - `offset_deviation_kpa`: of each taxel's zero, kPa.
/// - `drift_kpa_per_k`, `drift_deviation_kpa_per_k`: how much all taxels drift with temperature, and the deviation of each beyond that, kPa/K.
/// - `temperature_deviation_k`, `temperature_time_s`: deviation of the temperature from that of the tare, K, and the time in which it forgets what it was, s.
/// - `noise_deviation_kpa`: of each reading's noise, kPa.
/// - `quantum_kpa`: distance of the values that are told apart, kPa.
/// - `hysteresis`: half of the gap between loading and unloading, as part of the reading, 0 to 1.
/// - `dead_chance`, `stuck_chance`, `late_chance`: chances, 0 to 1, that a taxel reads zero for ever, stays at its first value, reads a frame late.
/// - `rate_hz`, `jitter`: frames that the bus delivers in a second, Hz (0: one at each step), and the deviation of the time between them, as part of it.
/// - `height_deviation_mm`, `place_deviation_mm`, `turn_deviation_rad`, `tilt_deviation_rad`: of how the sensor is mounted, mm and radians.
///
/// Raises `Error`, whose `field` is the one that cannot be.
#[pyclass(frozen, eq, from_py_object, module = "twintac")]
#[derive(Clone, PartialEq)]
pub(crate) struct Imperfection {
    pub(crate) imperfection: twintac::Imperfection,
}

#[pymethods]
impl Imperfection {
    #[new]
    #[pyo3(signature = (**fields))]
    fn new(py: Python<'_>, fields: Option<Bound<'_, PyDict>>) -> PyResult<Self> {
        let text = as_toml(py, fields.as_ref(), TABLE)?;
        let imperfection = twintac::Imperfection::parse(TABLE, &text);
        Ok(Self {
            imperfection: imperfection
                .map_err(|error| refused(py, TABLE, [&error.field, &error.problem, &error.hint]))?,
        })
    }

    /// Reads a file (TOML) with the table `[imperfection]`, as `twintac fast imperfection` makes them.
    ///
    /// Raises `Error` with file, line and field if it is wrong.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let text = std::fs::read_to_string(&path).map_err(|error| unreadable(py, &path, &error))?;
        let imperfection = twintac::Imperfection::parse(&path.display().to_string(), &text);
        Ok(Self {
            imperfection: imperfection.map_err(twintac::RunError::from).or_raise(py)?,
        })
    }

    fn __repr__(&self) -> String {
        format!("<{:?}>", self.imperfection)
    }
}

/// How bodies and gels hold each other where bodies move freely: with friction, and with the gel's loss, which lets what hits it come to rest.
///
/// - `friction`: Coulomb's coefficient of each body on each gel, 0 or more.
/// - `retardation_s`: time by which the gel's force leads its elastic one, s, as of a Kelvin-Voigt solid: `F + t dF/dt`. 0 for a gel without loss.
///
/// Raises `Error`, whose `field` is the number that cannot be.
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
                friction: crate::friction::friction(py, sensor, ("friction", friction))?,
                retardation_s,
            },
        })
    }
}

/// Many sensors of one kind, each imperfect in its own way, stepped in one call. Their gels have rested. `len()` is the number of sensors.
///
/// - `gel`: the fast gel of all of them.
/// - `bodies`: what may touch them, at least one.
/// - `imperfection`: from what each sensor's own imperfections are drawn; perfect sensors unless given.
/// - `twin`: its barometers read, with gains and memory; pressures at the ports unless given.
/// - `coupling`: how bodies and gels hold each other; neither friction nor loss unless given.
/// - `seed`: sensor `n` is the same under the same seed, whatever the other sensors are.
/// - `n_threads`: as many as there are cores unless given; results do not depend on it.
///
/// Raises `Error` for a twin or a coupling of another gel, and if there is no body.
#[pyclass(module = "twintac")]
pub(crate) struct SensorBatch {
    batch: twintac::SensorBatch,
    bodies: Vec<twintac::Body>,
    n_taxels: usize,
}

#[pymethods]
impl SensorBatch {
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
            let mismatch = gel.gel.check(&twin.sensor().file().sensor).err();
            if let Some(mismatch) = mismatch {
                return Err(unusable(py, "twin", &format!("does not go with `gel`: {mismatch}")));
            }
        }
        let sizes = [n_sensors, n_threads.unwrap_or_else(n_cores)];
        let batch = py.detach(|| match twin {
            Some(twin) => twin.sensors(&gel.gel, imperfection, sizes, seed),
            None => Ok(twintac::SensorBatch::new(&gel.gel, None, imperfection, sizes, seed)),
        });
        let batch = batch.or_raise(py)?;
        let batch = match coupling {
            Some(own) => batch.with_coupling(own.coupling).map_err(|mismatch| {
                unusable(py, "coupling", &format!("does not go with `gel`: {mismatch}"))
            })?,
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
    /// Returns what the bus of each sensor delivered last, kPa, `[n_sensors, n_taxels]`, and force on each gel, N, and torque about the top of its middle, N mm, in the frame of
    /// the sensor where it is, `[n_sensors, 6]`.
    ///
    /// Raises `Error`, whose `field` is the argument that has another shape, or numbers that cannot be.
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
    /// `[n_touches, 6]`, in the frame in which the sensor should be. Without a `Coupling` there are none: `[0, 6]`.
    fn wrench_of_touches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let wrenches: Vec<f32> = self.batch.wrench_of_touches().flatten().copied().collect();
        let n_touches = wrenches.len() / 6;
        rows(py, wrenches, [n_touches, 6])
    }

    /// Lets the gel of one sensor, counted from 0, rest until its next step, with the imperfections that it has.
    fn rest(&mut self, py: Python<'_>, sensor: usize) -> PyResult<()> {
        self.check(py, sensor)?;
        self.batch.rest(sensor);
        Ok(())
    }

    /// Puts another sensor in the place of one, counted from 0, with imperfections that are drawn anew, and lets it rest. `number` tells new sensors apart: those
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
