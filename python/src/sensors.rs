//! Batches of imperfect sensors.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use numpy::{PyArray1, PyArray2};
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

/// Why a coupling needs the identity of each touch.
const NO_TOUCH_ID: &str = "is missing: sensors with a `coupling` remember each thing that touches them. Give an integer for each touch, the same as long as it is the same thing; \
    `touch_id=body` where each body is one thing";

/// Name of the table of sensor variation in a file.
const TABLE: &str = "variation";

/// Sensor variation: the distributions from which each sensor's deviations from a perfect sensor
/// are drawn.
///
/// Keywords are the fields of the table `[variation]` in a file. Each is 0 unless given;
/// `SensorVariation()` is a perfect sensor. A *deviation* is the standard deviation of a normal
/// distribution about zero.
///
/// - `gain_deviation`: deviation of each taxel's gain, as a fraction of the gain.
/// - `growth_deviation_per_kpa`: deviation of the relative growth of each taxel's gain with its
///   reading, 1/kPa.
/// - `offset_deviation_kpa`: deviation of each taxel's zero, kPa.
/// - `drift_kpa_per_k`, `drift_deviation_kpa_per_k`: temperature drift that all taxels share, and
///   the deviation of each taxel's drift from it, kPa/K.
/// - `temperature_deviation_k`, `temperature_time_s`: deviation of the temperature from that of the
///   tare, K, and the time constant with which the temperature fluctuates, s, above 0 if the
///   deviation is.
/// - `cross_talk`, `cross_talk_deviation`: fraction of every other taxel's pressure that a taxel
///   reads in addition, beyond what the gel spreads, and its deviation from pair to pair.
/// - `noise_deviation_kpa`: deviation of the noise of each reading, kPa.
/// - `quantum_kpa`: resolution of the readings, kPa.
/// - `hysteresis`: half of the gap between loading and unloading, as a fraction of the reading, 0
///   to 1.
/// - `dead_chance`, `stuck_chance`, `late_chance`: probabilities, 0 to 1, that a taxel always reads
///   zero, that it stays at its first reading, and that its readings are late by one frame. Their
///   sum is at most 1.
/// - `rate_hz`, `jitter`: frames that the bus delivers in a second, Hz (0: one at each step), and
///   the deviation of the time between frames, as a fraction of it.
/// - `modulus_deviation`: deviation of the logarithm of the gel's modulus from that of the
///   surrogate's gel. Forces and pressures at given poses are proportional to it.
/// - `height_deviation_mm`, `place_deviation_mm`, `turn_deviation_rad`, `tilt_deviation_rad`:
///   deviations of the installation of the sensor: height, position, rotation about the vertical
///   axis, and tilt, mm and radians.
///
/// Raises `Error` for a value that is not allowed; its `field` names the keyword.
#[pyclass(frozen, eq, from_py_object, module = "twintac")]
#[derive(Clone, PartialEq)]
pub(crate) struct SensorVariation {
    pub(crate) variation: twintac::SensorVariation,
}

#[pymethods]
impl SensorVariation {
    #[new]
    #[pyo3(signature = (**fields))]
    fn new(py: Python<'_>, fields: Option<Bound<'_, PyDict>>) -> PyResult<Self> {
        let text = as_toml(py, fields.as_ref(), TABLE)?;
        let variation = twintac::SensorVariation::parse(TABLE, &text);
        Ok(Self {
            variation: variation
                .map_err(|error| refused(py, TABLE, [&error.field, &error.problem, &error.hint]))?,
        })
    }

    /// Reads a file (TOML) with the table `[variation]`. `twintac fast variation` makes such
    /// files.
    ///
    /// Raises `Error` with file, line and field if the file is wrong, and with the file if it
    /// cannot be read.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let text = std::fs::read_to_string(&path).map_err(|error| unreadable(py, &path, &error))?;
        let variation = twintac::SensorVariation::parse(&path.display().to_string(), &text);
        Ok(Self {
            variation: variation.map_err(twintac::WorkError::from).or_raise(py)?,
        })
    }

    /// The sensor variation of a working sensor, the default of the tasks in `twintac.gymnasium`.
    /// Gains and their growth, noise, resolution and frame rate are those found on the emulated
    /// PhysTac; the drift of the zeros, hysteresis, installation and faults are assumed.
    #[staticmethod]
    fn usual() -> Self {
        Self {
            variation: twintac::usual_variation(),
        }
    }

    /// All fields by name, including those that are 0.
    fn fields(&self, py: Python<'_>) -> PyResult<BTreeMap<String, f64>> {
        let mut bytes = Vec::new();
        let written = ciborium::into_writer(&self.variation, &mut bytes);
        written.map_err(|error| unusable(py, TABLE, &error.to_string()))?;
        ciborium::from_reader(&bytes[..]).map_err(|error| unusable(py, TABLE, &error.to_string()))
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!("<{:?}>", self.variation)
    }
}

impl Kept for SensorVariation {
    type State = twintac::SensorVariation;

    fn state(&self, _: Python<'_>) -> PyResult<twintac::SensorVariation> {
        Ok(self.variation.clone())
    }

    fn restored(_: Python<'_>, variation: twintac::SensorVariation) -> PyResult<Self> {
        Ok(Self { variation })
    }
}

/// The forces between gels and bodies that move freely: friction, and the damping of the gel, which
/// brings a body that hits it to rest.
///
/// - `sensor`: the sensor.
/// - `friction`: Coulomb's coefficient of each body on each gel, 0 or more.
/// - `retardation_s`: time constant `t` of the gel's damping, s. The force is `F + t dF/dt` with
///   the elastic force `F`, as of a Kelvin-Voigt solid. 0 for a gel without damping.
///
/// Raises `Error` for a number that is not allowed; its `field` names the argument.
#[pyclass(frozen, from_py_object, module = "twintac")]
#[derive(Clone)]
pub(crate) struct Coupling {
    coupling: twintac::Coupling,
    /// The sensor and the coefficient from which it was made.
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

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
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

/// Many sensors of one kind, each with its own deviations, stepped in one call. Their gels are at
/// rest at first. `len()` is the number of sensors.
///
/// - `gel`: the surrogate of their gel.
/// - `bodies`: the bodies that may touch them, at least one.
/// - `n_sensors`: number of sensors, from 1 to as many as give ten million readings: 1,250,000
///   sensors of eight taxels.
/// - `variation`: the sensor variation from which each sensor's deviations are drawn; perfect
///   sensors unless given.
/// - `twin`: the twin whose barometers they have, with its gains and viscoelastic relaxation;
///   readings are the pressures at the ports unless given.
/// - `coupling`: the forces between bodies and gels; neither friction nor damping unless given.
/// - `seed`: seed of the deviations. Sensor `n` is the same for the same seed, whatever the other
///   sensors are.
/// - `n_threads`: number of threads, at most 1024; as many as there are cores unless given. Results
///   do not depend on it.
///
/// Raises `Error` for a twin or a coupling of another gel, if there is no body, and for a number
/// out of its range.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct SensorBatch {
    batch: Shared<Batch>,
    bodies: Shared<Arc<[twintac::Body]>>,
    n_sensors: usize,
    n_taxels: usize,
    /// Name of the sensor whose gel this is.
    of: String,
    has_twin: bool,
    is_coupled: bool,
    n_threads: usize,
}

/// Sensors without or with forces on freely moving bodies.
enum Batch {
    Free(Box<twintac::SensorBatch>),
    Coupled(Box<twintac::CoupledBatch>),
}

/// The state of one sensor of a `SensorBatch` at a moment: its deviations, the state of its noise,
/// the relaxation of its twin, and the contacts of its gel. `SensorBatch.state` returns it.
#[pyclass(frozen, from_py_object, module = "twintac")]
#[derive(Clone)]
pub(crate) struct SensorState {
    state: Arc<twintac::SensorState>,
    /// Name of the sensor whose gel it is of.
    of: String,
}

#[pymethods]
impl SensorState {
    fn __repr__(&self) -> String {
        format!("<SensorState of {} taxels, simulated>", self.state.n_taxels())
    }

    /// Raises `TypeError`: a `SensorState` cannot be pickled. Copying it returns the object itself.
    fn __reduce__(&self) -> PyResult<()> {
        no_pickle("SensorState", "set it back in the process that took it")
    }

    /// Returns the object itself, which never changes.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    /// Returns the object itself, which never changes.
    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
}

#[pymethods]
impl SensorBatch {
    #[new]
    #[pyo3(signature = (gel, bodies, n_sensors, *, variation=None, twin=None, coupling=None, seed=None, n_threads=None), text_signature = "(gel, bodies, n_sensors, *, variation=None, twin=None, coupling=None, seed=0, n_threads=None)")]
    #[allow(clippy::too_many_arguments)] // keywords in Python
    fn new(
        py: Python<'_>,
        gel: &FastGel,
        bodies: Vec<Body>,
        n_sensors: Given<'_>,
        variation: Option<SensorVariation>,
        twin: Option<PyRef<'_, Twin>>,
        coupling: Option<Coupling>,
        seed: Option<Given<'_>>,
        n_threads: Option<Given<'_>>,
    ) -> PyResult<Self> {
        let bodies = self::bodies(py, bodies)?;
        let variation = variation.map(|own| own.variation).unwrap_or_default();
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
            Some(twin) => twin.sensors(&gel.gel, variation, sizes, seed),
            None => Ok(twintac::SensorBatch::new(&gel.gel, None, variation, sizes, seed)),
        });
        let batch = batch.or_raise(py)?;
        let is_coupled = coupling.is_some();
        let batch = match coupling {
            Some(own) => {
                let coupled = batch.with_coupling(own.coupling).map_err(|mismatch| {
                    unusable(py, "coupling", &format!("does not go with `gel`: {mismatch}"))
                })?;
                Batch::Coupled(Box::new(coupled))
            }
            None => Batch::Free(Box::new(batch)),
        };
        Ok(Self {
            batch: Shared::new(batch),
            bodies: Shared::new(bodies.into()),
            n_sensors,
            n_taxels,
            of: gel.gel.sensor().to_owned(),
            has_twin,
            is_coupled,
            n_threads,
        })
    }

    /// Provenance of all numbers: `"simulated"`.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// Replaces the bodies that may touch the sensors. The gels keep the state of each touch under
    /// its `touch_id`.
    ///
    /// - `bodies`: the new bodies, at least one.
    ///
    /// Raises `Error` if there is no body.
    fn set_bodies(&self, py: Python<'_>, bodies: Vec<Body>) -> PyResult<()> {
        let bodies = self::bodies(py, bodies)?.into();
        self.bodies.look(py, |held| *held = bodies)
    }

    /// Computes one more step of every sensor.
    ///
    /// - `since_previous_s`: time since the last step, s.
    /// - `gel_from_body`, `body`, `ends`: the touches, as in `FastBatch.read`. Poses are in the
    ///   frame of the sensor as described.
    /// - `touch_id`: an integer for each touch, which identifies the touching thing, `[n_touches]`.
    ///   It is the same as long as it is the same thing, and differs between things on one sensor.
    ///   Sensors with a `Coupling` need it: they keep the state of each touch under this number,
    ///   whatever its position in the list and its body. The state of a touch that is not in the
    ///   list is deleted.
    ///
    /// Returns the last readings that the bus of each sensor delivered, kPa,
    /// `[n_sensors, n_taxels]`, and the wrenches, `[n_sensors, 6]`: force on each gel, N, and
    /// torque about the centre of the top of its bounding box, N mm, in the frame of the sensor as
    /// it is installed.
    ///
    /// Raises `Error` for an argument with another shape or with numbers that are not allowed (its
    /// `field` names the argument), and if a thing touches one sensor twice. The sensors are then
    /// unchanged.
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
            // A single thread needs no pool.
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

    /// Wrench of each touch by itself in the last step, in the order of the touches,
    /// `[n_touches, 6]`: force on the gel, N, and torque about the centre of the top of its
    /// bounding box, N mm, in the frame of the sensor as described. Without a `Coupling` there are
    /// none: `[0, 6]`.
    fn wrench_of_touches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let wrenches: Vec<f32> = self.batch.look(py, |batch| match batch {
            Batch::Free(_) => Vec::new(),
            Batch::Coupled(batch) => batch.wrench_of_touches().flatten().copied().collect(),
        })?;
        let n_touches = wrenches.len() / 6;
        rows(py, wrenches, [n_touches, 6])
    }

    /// How fast each thing slipped over its gel in the last step, mm/s, along x and y of the gel,
    /// in the order of the touches, `[n_touches, 2]`: 0 while it sticks. Without a `Coupling` there
    /// are none: `[0, 2]`.
    fn slip_of_touches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let slips: Vec<f32> = self.batch.look(py, |batch| match batch {
            Batch::Free(_) => Vec::new(),
            Batch::Coupled(batch) => batch.slip_of_touches().flatten().copied().collect(),
        })?;
        let n_touches = slips.len() / 2;
        rows(py, slips, [n_touches, 2])
    }

    /// The readings of the last step without sensor variation, kPa, `[n_sensors, n_taxels]`.
    fn read_ground_truth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let readings_kpa: Vec<f32> = self.batch.look(py, |batch| match batch {
            Batch::Free(batch) => batch.ground_truth_kpa().collect(),
            Batch::Coupled(batch) => batch.ground_truth_kpa().collect(),
        })?;
        rows(py, readings_kpa, [self.n_sensors, self.n_taxels])
    }

    /// How near the bodies were to each sensor in the last step, `[n_sensors]`: 1 where one
    /// touches, falling linearly to 0 where the nearest is 2 mm away or farther. Distances are
    /// those of points of the gel's surface, which are 2 mm apart on PhysTac. No readings depend on
    /// it: it is for rewards, and for sensors that measure proximity besides.
    fn proximity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let proximity: Vec<f32> = self.batch.look(py, |batch| match batch {
            Batch::Free(batch) => batch.proximity().collect(),
            Batch::Coupled(batch) => batch.proximity().collect(),
        })?;
        Ok(PyArray1::from_vec(py, proximity))
    }

    /// The state of one sensor. A sensor that is set back to it continues with the same bits.
    ///
    /// - `sensor`: index of the sensor, from 0.
    ///
    /// Raises `Error` for an index out of range.
    fn state(&self, py: Python<'_>, sensor: Given<'_>) -> PyResult<SensorState> {
        let sensor = self.number(&sensor)?;
        let state = self.batch.look(py, |batch| match batch {
            Batch::Free(batch) => batch.state(sensor),
            Batch::Coupled(batch) => batch.state(sensor),
        })?;
        Ok(SensorState {
            state: Arc::new(state),
            of: self.of.clone(),
        })
    }

    /// Sets one sensor to a state, its own or that of another sensor of such a batch.
    ///
    /// - `sensor`: index of the sensor, from 0.
    /// - `state`: the state.
    ///
    /// Raises `Error` for an index out of range, for the state of another kind of sensor or with
    /// another number of taxels, and for one with a twin if these sensors have none, or the
    /// reverse.
    #[allow(clippy::needless_pass_by_value)] // as Python gives it
    fn set_state(&self, py: Python<'_>, sensor: Given<'_>, state: SensorState) -> PyResult<()> {
        let sensor = self.number(&sensor)?;
        let (own, given) = (
            (self.n_taxels, self.has_twin, self.of.as_str()),
            (state.state.n_taxels(), state.state.has_twin(), state.of.as_str()),
        );
        if own != given {
            let text = |(n_taxels, has_twin, of): (usize, bool, &str)| {
                format!(
                    "`{of}`, {n_taxels} taxels {} a twin",
                    if has_twin { "with" } else { "without" }
                )
            };
            let problem = format!("is of {}, expected {}", text(given), text(own));
            return Err(unusable(py, "state", &problem));
        }
        self.batch.look(py, |batch| match batch {
            Batch::Free(batch) => batch.set_state(sensor, &state.state),
            Batch::Coupled(batch) => batch.set_state(sensor, &state.state),
        })
    }

    /// Resets one sensor to rest until its next step. Its deviations stay.
    ///
    /// - `sensor`: index of the sensor, from 0.
    ///
    /// Raises `Error` for an index out of range.
    fn rest(&self, py: Python<'_>, sensor: Given<'_>) -> PyResult<()> {
        let sensor = self.number(&sensor)?;
        self.batch.look(py, |batch| match batch {
            Batch::Free(batch) => batch.rest(sensor),
            Batch::Coupled(batch) => batch.rest(sensor),
        })
    }

    /// Replaces one sensor by another one at rest, whose deviations are drawn anew.
    ///
    /// - `sensor`: index of the sensor, from 0.
    /// - `number`: identifies the new sensor. Numbers below the number of sensors give the first
    ///   sensors of the batch.
    ///
    /// Raises `Error` for an index out of range.
    fn replace(&self, py: Python<'_>, sensor: Given<'_>, number: Given<'_>) -> PyResult<()> {
        let sensor = self.number(&sensor)?;
        let number = number.seed("number")?;
        self.batch.look(py, |batch| match batch {
            Batch::Free(batch) => batch.replace(sensor, number),
            Batch::Coupled(batch) => batch.replace(sensor, number),
        })
    }

    /// Raises `TypeError`: a `SensorBatch` cannot be pickled or copied.
    fn __reduce__(&self) -> PyResult<()> {
        no_pickle(
            "SensorBatch",
            "pickle its gel, bodies and variation, and make one in each process",
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
    /// The index of a sensor, from 0.
    fn number(&self, sensor: &Given<'_>) -> PyResult<usize> {
        sensor.count("sensor", 0..=self.n_sensors - 1)
    }
}
