//! Many imperfect sensors.

use std::path::PathBuf;

use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::rows;
use crate::error::{OrRaise, unreadable, unusable};
use crate::fast::{Answers, FastGel, PROVENANCE};
use crate::given::{Given, since, threads};
use crate::pickle::{Kept, Reduced, reduced, refused as no_pickle};
use crate::pool::in_parallel;
use crate::sensor::Sensor;
use crate::settings::{as_toml, refused};
use crate::shape::Body;
use crate::shared::Shared;
use crate::touches::{Touches, bodies};
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

    /// What a pickle keeps.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!("<{:?}>", self.imperfection)
    }
}

impl Kept for Imperfection {
    type State = twintac::Imperfection;

    fn state(&self, _: Python<'_>) -> PyResult<twintac::Imperfection> {
        Ok(self.imperfection.clone())
    }

    fn restored(_: Python<'_>, imperfection: twintac::Imperfection) -> PyResult<Self> {
        Ok(Self { imperfection })
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
    /// Of what it was made.
    sensor: Sensor,
    friction: f64,
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
            sensor: sensor.clone(),
            friction,
        })
    }

    /// What a pickle keeps.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!(
            "<Coupling on {:?}, friction {}, retardation {} s>",
            self.sensor.sensor.name(),
            self.friction,
            self.coupling.retardation_s
        )
    }
}

impl Kept for Coupling {
    type State = (<Sensor as Kept>::State, [f64; 2]);

    fn state(&self, py: Python<'_>) -> PyResult<Self::State> {
        Ok((
            self.sensor.state(py)?,
            [self.friction, self.coupling.retardation_s],
        ))
    }

    fn restored(py: Python<'_>, (sensor, [friction, retardation_s]): Self::State) -> PyResult<Self> {
        Self::new(py, &Sensor::restored(py, sensor)?, friction, retardation_s)
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
/// - `n_sensors`: 1 or more, and at most ten million readings: 1,250,000 sensors of eight taxels.
/// - `n_threads`: as many as there are cores unless given, at most 1024; results do not depend on it.
///
/// Raises `Error` for a twin of another number of taxels than the gel has, if there is no body, and for a number that is out of its range.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct SensorBatch {
    batch: Shared<twintac::SensorBatch>,
    bodies: Vec<twintac::Body>,
    n_sensors: usize,
    n_taxels: usize,
    n_threads: usize,
}

#[pymethods]
impl SensorBatch {
    #[new]
    #[pyo3(signature = (gel, bodies, n_sensors, *, imperfection=None, twin=None, coupling=None, seed=None, n_threads=None), text_signature = "(gel, bodies, n_sensors, *, imperfection=None, twin=None, coupling=None, seed=0, n_threads=None)")]
    #[allow(clippy::too_many_arguments)] // keywords in Python
    fn new(
        py: Python<'_>,
        gel: &FastGel,
        bodies: Vec<Body>,
        n_sensors: Given<'_>,
        imperfection: Option<Imperfection>,
        twin: Option<PyRef<'_, Twin>>,
        coupling: Option<Coupling>,
        seed: Option<Given<'_>>,
        n_threads: Option<Given<'_>>,
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
        let n_sensors = n_sensors.count("n_sensors", 1..=twintac::most_sensors(n_taxels))?;
        let seed = seed.map_or(Ok(0), |seed| seed.seed("seed"))?;
        let n_threads = threads(n_threads)?;
        let sizes = [n_sensors, n_threads];
        let batch = py.detach(|| match twin {
            Some(twin) => twin.sensors(&gel.gel, imperfection, sizes, seed),
            None => twintac::SensorBatch::new(&gel.gel, None, imperfection, sizes, seed),
        });
        let batch = match coupling {
            Some(own) => batch.with_coupling(own.coupling),
            None => batch,
        };
        Ok(Self {
            batch: Shared::new(batch),
            bodies,
            n_sensors,
            n_taxels,
            n_threads,
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
        &self,
        py: Python<'py>,
        since_previous_s: f64,
        gel_from_body: Given<'_>,
        body: Option<Given<'_>>,
        ends: Option<Given<'_>>,
    ) -> PyResult<Answers<'py>> {
        since(py, since_previous_s)?;
        let Touches { touches, ends } = Touches::checked(
            py,
            &gel_from_body,
            body.as_ref(),
            ends.as_ref(),
            self.bodies.len(),
        )?;
        let n_sensors = self.n_sensors;
        if ends.len() != n_sensors {
            let problem = format!(
                "has {} numbers, expected one for each of {n_sensors} sensors",
                ends.len()
            );
            return Err(unusable(py, "ends", &problem));
        }
        let mut readings_kpa = vec![0.0; n_sensors * self.n_taxels];
        let mut wrench = vec![[0.0; 6]; n_sensors];
        self.batch.work(py, |batch| {
            let bodies = &self.bodies;
            let (readings_kpa, wrench) = (&mut readings_kpa[..], &mut wrench[..]);
            let mut step = || batch.step(since_previous_s, bodies, &touches, &ends, readings_kpa, wrench);
            // Nobody has to be woken for one thread.
            if self.n_threads > 1 {
                in_parallel(step)
            } else {
                step()
            }
        })?;
        Ok((
            rows(py, readings_kpa, [n_sensors, self.n_taxels])?,
            rows(py, wrench.into_flattened(), [n_sensors, 6])?,
        ))
    }

    /// What each body did in the last step by itself, in the order of the touches: force on the gel, N, and torque about the top of its middle, N mm,
    /// `[n_touches, 6]`, in the frame in which the sensor should be. Without a `Coupling` there are none: `[0, 6]`.
    fn wrench_of_touches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let wrenches: Vec<f32> = self
            .batch
            .look(py, |batch| batch.wrench_of_touches().flatten().copied().collect())?;
        let n_touches = wrenches.len() / 6;
        rows(py, wrenches, [n_touches, 6])
    }

    /// Lets the gel of one sensor, counted from 0, rest until its next step, with the imperfections that it has.
    fn rest(&self, py: Python<'_>, sensor: Given<'_>) -> PyResult<()> {
        let sensor = sensor.count("sensor", 0..=self.n_sensors - 1)?;
        self.batch.look(py, |batch| batch.rest(sensor))
    }

    /// Puts another sensor in the place of one, counted from 0, with imperfections that are drawn anew, and lets it rest. `number` tells new sensors apart: those
    /// below the number of sensors are the first ones.
    fn replace(&self, py: Python<'_>, sensor: Given<'_>, number: Given<'_>) -> PyResult<()> {
        let sensor = sensor.count("sensor", 0..=self.n_sensors - 1)?;
        let number = number.seed("number")?;
        self.batch.look(py, |batch| batch.replace(sensor, number))
    }

    /// Sensors that are stepped are no value.
    fn __reduce__(&self) -> PyResult<()> {
        no_pickle(
            "SensorBatch",
            "pickle its gel, bodies and imperfection, and make one in each process",
        )
    }

    fn __len__(&self) -> usize {
        self.n_sensors
    }

    fn __repr__(&self) -> String {
        let (n_sensors, n_taxels, n_bodies) = (self.n_sensors, self.n_taxels, self.bodies.len());
        format!("<SensorBatch of {n_sensors} sensors of {n_taxels} taxels, {n_bodies} bodies, {PROVENANCE}>")
    }
}
