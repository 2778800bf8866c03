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
use crate::touches::{Counts, Touches, bodies, touch_ids};
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
    sensor: twintac::Sensor,
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
            sensor: sensor.sensor.clone(),
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
/// Raises `Error` for a twin or a coupling of a sensor whose gel it is not, and if there is no
/// body.
#[pyclass(module = "twintac")]
pub(crate) struct SensorBatch {
    batch: Batch,
    bodies: Vec<twintac::Body>,
    n_taxels: usize,
    has_twin: bool,
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
    state: std::sync::Arc<twintac::SensorState>,
}

#[pymethods]
impl SensorState {
    fn __repr__(&self) -> String {
        format!("<SensorState of {} taxels, simulated>", self.state.n_taxels())
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
            agrees(py, "twin", &gel.gel, twin.sensor())?;
            let n_of_twin = twin.sensor().taxels().count();
            if n_of_twin != n_taxels {
                let problem = format!("has {n_of_twin} taxels, the gel {n_taxels}");
                return Err(unusable(py, "twin", &problem));
            }
        }
        if let Some(coupling) = &coupling {
            agrees(py, "coupling", &gel.gel, &coupling.sensor)?;
        }
        let has_twin = twin.is_some();
        let sizes = [n_sensors, n_threads.unwrap_or_else(n_cores)];
        let batch = py.detach(|| match twin {
            Some(twin) => twin.sensors(&gel.gel, imperfection, sizes, seed),
            None => twintac::SensorBatch::new(&gel.gel, None, imperfection, sizes, seed),
        });
        let batch = match coupling {
            Some(own) => Batch::Coupled(batch.with_coupling(own.coupling)),
            None => Batch::Free(batch),
        };
        Ok(Self {
            batch,
            bodies,
            n_taxels,
            has_twin,
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
    fn set_bodies(&mut self, py: Python<'_>, bodies: Vec<Body>) -> PyResult<()> {
        self.bodies = self::bodies(py, bodies)?;
        Ok(())
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
        &mut self,
        py: Python<'py>,
        since_previous_s: f64,
        gel_from_body: Numbers<'_, Ix2>,
        body: Option<Counts<'_>>,
        ends: Option<Counts<'_>>,
        touch_id: Option<Counts<'_>>,
    ) -> PyResult<Answers<'py>> {
        since(py, since_previous_s)?;
        let Touches { touches, ends } = Touches::checked(
            py,
            &gel_from_body,
            body.as_ref(),
            ends.as_ref(),
            self.bodies.len(),
        )?;
        let ids = touch_id
            .map(|ids| touch_ids(py, &ids, touches.len()))
            .transpose()?;
        let n_sensors = self.n_sensors();
        if ends.len() != n_sensors {
            let problem = format!(
                "has {} numbers, expected one for each of {n_sensors} sensors",
                ends.len()
            );
            return Err(unusable(py, "ends", &problem));
        }
        let mut readings_kpa = vec![0.0; n_sensors * self.n_taxels];
        let mut wrench = vec![[0.0; 6]; n_sensors];
        let (bodies, readings, wrenches) = (&self.bodies, &mut readings_kpa, &mut wrench);
        match &mut self.batch {
            Batch::Free(batch) => {
                py.detach(|| batch.step(since_previous_s, bodies, &touches, &ends, readings, wrenches));
            }
            Batch::Coupled(batch) => {
                let ids = ids.ok_or_else(|| unusable(py, "touch_id", NO_TOUCH_ID))?;
                let held: Vec<twintac::HeldTouch> = ids
                    .into_iter()
                    .zip(touches)
                    .map(|(id, touch)| twintac::HeldTouch { id, touch })
                    .collect();
                py.detach(|| batch.step(since_previous_s, bodies, &held, &ends, readings, wrenches))
                    .map_err(|twice| unusable(py, "touch_id", &format!("is wrong: {twice}")))?;
            }
        }
        Ok((
            rows(py, readings_kpa, [n_sensors, self.n_taxels])?,
            rows(py, wrench.into_flattened(), [n_sensors, 6])?,
        ))
    }

    /// What each thing did in the last step by itself, in the order of the touches: force on the
    /// gel, N, and torque about the top of its middle, N mm,
    /// `[n_touches, 6]`, in the frame in which the sensor should be. Without a `Coupling` there are none: `[0, 6]`.
    fn wrench_of_touches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let wrenches: Vec<f32> = match &self.batch {
            Batch::Free(_) => Vec::new(),
            Batch::Coupled(batch) => batch.wrench_of_touches().flatten().copied().collect(),
        };
        let n_touches = wrenches.len() / 6;
        rows(py, wrenches, [n_touches, 6])
    }

    /// What one sensor, counted from 0, is and remembers now: set back, it goes on to the same
    /// bits.
    fn state(&self, py: Python<'_>, sensor: usize) -> PyResult<SensorState> {
        self.check(py, sensor)?;
        let state = match &self.batch {
            Batch::Free(batch) => batch.state(sensor),
            Batch::Coupled(batch) => batch.state(sensor),
        };
        Ok(SensorState {
            state: std::sync::Arc::new(state),
        })
    }

    /// Lets one sensor, counted from 0, go on from a state, of its own or of another sensor of such
    /// a batch.
    ///
    /// Raises `Error` for the state of a sensor with other taxels, or with a twin where this one
    /// has none.
    fn set_state(&mut self, py: Python<'_>, sensor: usize, state: SensorState) -> PyResult<()> {
        self.check(py, sensor)?;
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
        match &mut self.batch {
            Batch::Free(batch) => batch.set_state(sensor, &state.state),
            Batch::Coupled(batch) => batch.set_state(sensor, &state.state),
        }
        Ok(())
    }

    /// Lets the gel of one sensor, counted from 0, rest until its next step, with the imperfections that it has.
    fn rest(&mut self, py: Python<'_>, sensor: usize) -> PyResult<()> {
        self.check(py, sensor)?;
        match &mut self.batch {
            Batch::Free(batch) => batch.rest(sensor),
            Batch::Coupled(batch) => batch.rest(sensor),
        }
        Ok(())
    }

    /// Puts another sensor in the place of one, counted from 0, with imperfections that are drawn anew, and lets it rest. `number` tells new sensors apart: those
    /// below the number of sensors are the first ones.
    fn replace(&mut self, py: Python<'_>, sensor: usize, number: u64) -> PyResult<()> {
        self.check(py, sensor)?;
        match &mut self.batch {
            Batch::Free(batch) => batch.replace(sensor, number),
            Batch::Coupled(batch) => batch.replace(sensor, number),
        }
        Ok(())
    }

    fn __len__(&self) -> usize {
        self.n_sensors()
    }
}

impl SensorBatch {
    fn n_sensors(&self) -> usize {
        match &self.batch {
            Batch::Free(batch) => batch.n_sensors(),
            Batch::Coupled(batch) => batch.n_sensors(),
        }
    }

    fn check(&self, py: Python<'_>, sensor: usize) -> PyResult<()> {
        let n_sensors = self.n_sensors();
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

/// Refuses a fast gel that is not that of a sensor: whose top over the sensor's taxels has another
/// height.
fn agrees(py: Python<'_>, field: &str, gel: &twintac::FastGel, sensor: &twintac::Sensor) -> PyResult<()> {
    let described = &sensor.file().sensor;
    let solid = &described.gel.solid;
    let is_same = described.taxels.iter().all(|taxel| {
        let place_mm = taxel.position_mm.truncate();
        let top_mm = solid.top_height_mm(place_mm.x, place_mm.y, &described.surfaces);
        top_mm.is_none_or(|top_mm| (top_mm - gel.height_mm_at(place_mm)).abs() < 0.5)
    });
    if is_same {
        return Ok(());
    }
    let problem = format!(
        "is of the sensor `{}`, and `gel` of `{}`, whose gel is another",
        described.name,
        gel.sensor()
    );
    Err(unusable(py, field, &problem))
}

/// A time between frames that can be.
pub(crate) fn since(py: Python<'_>, since_previous_s: f64) -> PyResult<()> {
    if since_previous_s >= 0.0 && since_previous_s.is_finite() {
        return Ok(());
    }
    let problem = format!("is {since_previous_s}, expected 0 or more");
    Err(unusable(py, "since_previous_s", &problem))
}
