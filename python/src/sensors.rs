//! Many imperfect sensors.

use std::path::PathBuf;
use std::sync::Arc;

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
use crate::touches::{Touches, bodies, touch_ids};
use crate::twin::Twin;

/// Why a coupling needs to know what is what.
const NO_TOUCH_ID: &str = "is missing: sensors with a `coupling` remember each thing that touches them. Give an integer for each touch, the same as long as it is the same thing; \
    `touch_id=body` where each body is one thing";

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
/// - `cross_talk`, `cross_talk_deviation`: part of what each other taxel feels that a taxel reads as well, beyond what the gel spreads, and its deviation from pair to pair.
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
            imperfection: imperfection.map_err(twintac::WorkError::from).or_raise(py)?,
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
/// Raises `Error` for a twin or a coupling of another gel, if there is no body, and for a number that is out of its range.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct SensorBatch {
    batch: Shared<Batch>,
    bodies: Shared<Arc<[twintac::Body]>>,
    n_sensors: usize,
    n_taxels: usize,
    has_twin: bool,
    is_coupled: bool,
    n_threads: usize,
}

/// Sensors that hold what touches them, or not.
enum Batch {
    Free(twintac::SensorBatch),
    Coupled(twintac::CoupledBatch),
}

/// What one sensor of a `SensorBatch` is and remembers at a moment: its imperfections and the noise
/// to come, its twin's memory, and what its gel holds. What `SensorBatch.state`
/// returns.
#[pyclass(frozen, from_py_object, module = "twintac")]
#[derive(Clone)]
pub(crate) struct SensorState {
    state: Arc<twintac::SensorState>,
}

#[pymethods]
impl SensorState {
    fn __repr__(&self) -> String {
        format!("<SensorState of {} taxels, simulated>", self.state.n_taxels())
    }

    /// A state goes on where it was taken: the memory of a process.
    fn __reduce__(&self) -> PyResult<()> {
        no_pickle("SensorState", "set it back in the process that took it")
    }

    /// It never changes: a copy is itself.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    /// It never changes: a copy is itself.
    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
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
        let twin = twin.map(|twin| Arc::clone(&twin.twin));
        if let Some(twin) = &twin
            && let Err(mismatch) = gel.gel.check(&twin.sensor().file().sensor)
        {
            return Err(unusable(
                py,
                "twin",
                &format!("does not go with `gel`: {mismatch}"),
            ));
        }
        let n_sensors = n_sensors.count("n_sensors", 1..=twintac::most_sensors(n_taxels))?;
        let seed = seed.map_or(Ok(0), |seed| seed.seed("seed"))?;
        let n_threads = threads(n_threads)?;
        let has_twin = twin.is_some();
        let sizes = [n_sensors, n_threads];
        let batch = py.detach(|| match twin {
            Some(twin) => twin.sensors(&gel.gel, imperfection, sizes, seed),
            None => Ok(twintac::SensorBatch::new(
                &gel.gel,
                None,
                imperfection,
                sizes,
                seed,
            )),
        });
        let batch = batch.or_raise(py)?;
        let is_coupled = coupling.is_some();
        let batch = match coupling {
            Some(own) => Batch::Coupled(batch.with_coupling(own.coupling).map_err(|mismatch| {
                unusable(py, "coupling", &format!("does not go with `gel`: {mismatch}"))
            })?),
            None => Batch::Free(batch),
        };
        Ok(Self {
            batch: Shared::new(batch),
            bodies: Shared::new(bodies.into()),
            n_sensors,
            n_taxels,
            has_twin,
            is_coupled,
            n_threads,
        })
    }

    /// What every reading is: simulated.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// Puts other bodies in the place of those that may touch. What gels hold, they go on to hold,
    /// under the things' `touch_id`.
    ///
    /// Raises `Error` if there is no body.
    fn set_bodies(&self, py: Python<'_>, bodies: Vec<Body>) -> PyResult<()> {
        let bodies = self::bodies(py, bodies)?.into();
        self.bodies.look(py, |held| *held = bodies)
    }

    /// One more moment of every sensor, `since_previous_s` after the last. `gel_from_body`, `body`
    /// and `ends` are those of `FastBatch.read`.
    ///
    /// `touch_id`, an integer for each touch, says which thing it is: the same as long as it is the
    /// same thing, and another for each other thing on that sensor. A sensor with a `Coupling`
    /// remembers each thing that touches it under this number, wherever it stands in the list and
    /// whatever body it has, so it has to be given. What is not in the list is forgotten.
    ///
    /// Returns what the bus of each sensor delivered last, kPa, `[n_sensors, n_taxels]`, and force on each gel, N, and torque about the top of its middle, N mm, in the frame of
    /// the sensor where it is, `[n_sensors, 6]`.
    ///
    /// Raises `Error`, whose `field` is the argument that has another shape, or numbers that cannot
    /// be, and if a thing touches one sensor twice. Nothing has been done then.
    #[pyo3(signature = (since_previous_s, gel_from_body, body=None, ends=None, *, touch_id=None))]
    fn step<'py>(
        &self,
        py: Python<'py>,
        since_previous_s: f64,
        gel_from_body: Given<'_>,
        body: Option<Given<'_>>,
        ends: Option<Given<'_>>,
        touch_id: Option<Given<'_>>,
    ) -> PyResult<Answers<'py>> {
        since(py, since_previous_s)?;
        let bodies = self.bodies.look(py, |held| Arc::clone(held))?;
        let Touches { touches, ends } =
            Touches::checked(py, &gel_from_body, body.as_ref(), ends.as_ref(), bodies.len())?;
        let ids = touch_id
            .map(|ids| touch_ids(py, &ids, touches.len()))
            .transpose()?;
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
        let held = match (self.is_coupled, ids) {
            (false, _) => Vec::new(),
            (true, None) => return Err(unusable(py, "touch_id", NO_TOUCH_ID)),
            (true, Some(ids)) => {
                let touches = ids.into_iter().zip(&touches);
                touches
                    .map(|(id, touch)| twintac::HeldTouch { id, touch: *touch })
                    .collect()
            }
        };
        let done = self.batch.work(py, |batch| {
            let (readings_kpa, wrench) = (&mut readings_kpa[..], &mut wrench[..]);
            let mut step = || match batch {
                Batch::Free(batch) => {
                    batch.step(since_previous_s, &bodies, &touches, &ends, readings_kpa, wrench);
                    Ok(())
                }
                Batch::Coupled(batch) => {
                    batch.step(since_previous_s, &bodies, &held, &ends, readings_kpa, wrench)
                }
            };
            // Nobody has to be woken for one thread.
            if self.n_threads > 1 {
                in_parallel(step)
            } else {
                step()
            }
        })?;
        done.map_err(|twice| unusable(py, "touch_id", &format!("is wrong: {twice}")))?;
        Ok((
            rows(py, readings_kpa, [n_sensors, self.n_taxels])?,
            rows(py, wrench.into_flattened(), [n_sensors, 6])?,
        ))
    }

    /// What each thing did in the last step by itself, in the order of the touches: force on the
    /// gel, N, and torque about the top of its middle, N mm,
    /// `[n_touches, 6]`, in the frame in which the sensor should be. Without a `Coupling` there are none: `[0, 6]`.
    fn wrench_of_touches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let wrenches: Vec<f32> = self.batch.look(py, |batch| match batch {
            Batch::Free(_) => Vec::new(),
            Batch::Coupled(batch) => batch.wrench_of_touches().flatten().copied().collect(),
        })?;
        let n_touches = wrenches.len() / 6;
        rows(py, wrenches, [n_touches, 6])
    }

    /// What one sensor, counted from 0, is and remembers now: set back, it goes on to the same
    /// bits.
    fn state(&self, py: Python<'_>, sensor: Given<'_>) -> PyResult<SensorState> {
        let sensor = self.number(&sensor)?;
        let state = self.batch.look(py, |batch| match batch {
            Batch::Free(batch) => batch.state(sensor),
            Batch::Coupled(batch) => batch.state(sensor),
        })?;
        Ok(SensorState {
            state: Arc::new(state),
        })
    }

    /// Lets one sensor, counted from 0, go on from a state, of its own or of another sensor of such
    /// a batch.
    ///
    /// Raises `Error` for the state of a sensor with other taxels, or with a twin where this one
    /// has none.
    #[allow(clippy::needless_pass_by_value)] // as Python gives it
    fn set_state(&self, py: Python<'_>, sensor: Given<'_>, state: SensorState) -> PyResult<()> {
        let sensor = self.number(&sensor)?;
        let (own, given) = (
            (self.n_taxels, self.has_twin),
            (state.state.n_taxels(), state.state.has_twin()),
        );
        if own != given {
            let text = |(n_taxels, has_twin): (usize, bool)| {
                format!(
                    "{n_taxels} taxels {} a twin",
                    if has_twin { "with" } else { "without" }
                )
            };
            let problem = format!("is of a sensor of {}, expected {}", text(given), text(own));
            return Err(unusable(py, "state", &problem));
        }
        self.batch.look(py, |batch| match batch {
            Batch::Free(batch) => batch.set_state(sensor, &state.state),
            Batch::Coupled(batch) => batch.set_state(sensor, &state.state),
        })
    }

    /// Lets the gel of one sensor, counted from 0, rest until its next step, with the imperfections that it has.
    fn rest(&self, py: Python<'_>, sensor: Given<'_>) -> PyResult<()> {
        let sensor = self.number(&sensor)?;
        self.batch.look(py, |batch| match batch {
            Batch::Free(batch) => batch.rest(sensor),
            Batch::Coupled(batch) => batch.rest(sensor),
        })
    }

    /// Puts another sensor in the place of one, counted from 0, with imperfections that are drawn anew, and lets it rest. `number` tells new sensors apart: those
    /// below the number of sensors are the first ones.
    fn replace(&self, py: Python<'_>, sensor: Given<'_>, number: Given<'_>) -> PyResult<()> {
        let sensor = self.number(&sensor)?;
        let number = number.seed("number")?;
        self.batch.look(py, |batch| match batch {
            Batch::Free(batch) => batch.replace(sensor, number),
            Batch::Coupled(batch) => batch.replace(sensor, number),
        })
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

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let n_bodies = self.bodies.look(py, |held| held.len())?;
        let (n_sensors, n_taxels) = (self.n_sensors, self.n_taxels);
        Ok(format!(
            "<SensorBatch of {n_sensors} sensors of {n_taxels} taxels, {n_bodies} bodies, {PROVENANCE}>"
        ))
    }
}

impl SensorBatch {
    /// Which sensor is meant, counted from 0.
    fn number(&self, sensor: &Given<'_>) -> PyResult<usize> {
        sensor.count("sensor", 0..=self.n_sensors - 1)
    }
}
