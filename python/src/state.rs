//! A gel that is pressed frame by frame.

use std::sync::Arc;

use numpy::PyArray1;
use pyo3::prelude::*;
use twintac::FollowedFrame;

use crate::error::{OrRaise, unusable};
use crate::fast::PROVENANCE;
use crate::given::since;
use crate::long_call::long_call_on;
use crate::path::readings_kpa;
use crate::pickle::refused;
use crate::pose::Pose;
use crate::shared::Shared;

/// A gel that one indenter presses, frame by frame: it is pushed, slides and rotates to poses as
/// they come. `Gel.state` returns it. It keeps the deformation of the gel, the history of its
/// material, and the locations where friction holds it.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct GelState {
    held: Arc<Shared<Held>>,
    taxels: Vec<String>,
}

/// The gel, and its last frame.
struct Held {
    state: twintac::GelState,
    last: Option<FollowedFrame>,
}

impl GelState {
    pub(crate) fn new(state: twintac::GelState, taxels: Vec<String>) -> Self {
        let held = Held { state, last: None };
        Self {
            held: Arc::new(Shared::new(held)),
            taxels,
        }
    }

    /// Reads the gel. If a step was interrupted, this waits until the step is done.
    fn look<T>(&self, py: Python<'_>, look: impl FnOnce(&mut Held) -> T) -> PyResult<T> {
        self.held.look(py, look)
    }

    /// A vector of the last frame; zero before the first frame.
    fn vector<'py>(
        &self,
        py: Python<'py>,
        vector: impl Fn(&FollowedFrame) -> glam::DVec3,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let vector = self.look(py, |held| held.last.as_ref().map(vector))?;
        Ok(PyArray1::from_slice(py, &vector.unwrap_or_default().to_array()))
    }
}

#[pymethods]
impl GelState {
    /// Provenance of all numbers: `"simulated"`.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// Computes one more frame: the indenter moves to a pose on a straight line. Small steps take
    /// milliseconds on a gel of few nodes (`Gel(sensor, {"max_path_nodes": 4000})`), long steps on
    /// a fine gel take seconds. Ctrl-C ends the wait; the step is finished nevertheless.
    ///
    /// - `since_previous_s`: time since the last frame, s. The first frame ignores it.
    /// - `gel_from_indenter`: pose of the indenter in the gel's frame.
    /// - `force_n`: force straight down, N, above 0. The indenter then moves down or up from the
    ///   pose, by at most the gel's height, until it presses with this force.
    ///
    /// Returns the port pressures: the hydrostatic pressure in the gel over each taxel's port, kPa;
    /// `[n_taxels]`.
    ///
    /// Raises `Error` if the solver finds no equilibrium. The gel is then as it was before, and
    /// smaller steps may succeed. It also raises `Error` for a time below 0, and for a force that
    /// is not above 0, is not reached, or is above the limit of the sensor (`limits.force_n` of its
    /// description).
    #[pyo3(signature = (since_previous_s, gel_from_indenter, *, force_n=None))]
    fn step<'py>(
        &self,
        py: Python<'py>,
        since_previous_s: f64,
        gel_from_indenter: Pose,
        force_n: Option<f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        since(py, since_previous_s)?;
        if let Some(force_n) = force_n.filter(|force_n| !(*force_n > 0.0 && force_n.is_finite())) {
            let problem = format!("is {force_n}, expected a number above 0");
            return Err(unusable(py, "force_n", &problem));
        }
        self.look(py, |_| ())?; // checks that this process can step it
        let taxels = self.taxels.clone();
        let readings_kpa = long_call_on(py, Arc::clone(&self.held), move |held| {
            let pose = &gel_from_indenter.pose;
            let frame = match force_n {
                Some(force_n) => held.state.step_to_force(since_previous_s, pose, force_n),
                None => held.state.step(since_previous_s, pose),
            }?;
            let readings_kpa = readings_kpa(&frame, &taxels);
            held.last = Some(frame);
            Ok::<_, twintac::Error>(readings_kpa)
        })?;
        Ok(PyArray1::from_vec(py, readings_kpa.or_raise(py)?))
    }

    /// Pose of the indenter in the gel's frame; `None` before the first frame.
    #[getter]
    fn gel_from_indenter(&self, py: Python<'_>) -> PyResult<Option<Pose>> {
        let pose = self.look(py, |held| held.state.gel_from_indenter())?;
        Ok(pose.map(|pose| Pose { pose }))
    }

    /// Depth below the height at which the indenter first touches the gel at the location and
    /// rotation of the first pose that `Gel.state` was given, mm; `None` before the first frame.
    #[getter]
    fn depth_mm(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        self.look(py, |held| held.last.as_ref().map(|frame| frame.depth_mm))
    }

    /// Whether the last frame is the equilibrium at the pose that was asked for. It always is,
    /// unless the `deadline_ms` of `Gel.state` came first. `None` before the first frame.
    #[getter]
    fn converged(&self, py: Python<'_>) -> PyResult<Option<bool>> {
        self.look(py, |held| held.last.as_ref().map(|frame| frame.converged))
    }

    /// Fraction of the load that is unbalanced at the last frame; `None` before the first frame.
    #[getter]
    fn residual(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        self.look(py, |held| held.last.as_ref().map(|frame| frame.quality.residual))
    }

    /// How far the indenter at the last frame is behind the pose that was asked for, mm; 0 without
    /// a `deadline_ms`. The next step goes on from there. `None` before the first frame.
    #[getter]
    fn behind_mm(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        self.look(py, |held| held.last.as_ref().map(|frame| frame.behind_mm))
    }

    /// Force of the indenter on the gel at the last frame, in the gel's frame, N; `[3]`. Its z
    /// component is negative if the indenter presses straight down. Zero before the first frame.
    #[getter]
    fn force_n<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.vector(py, |frame| frame.force_n)
    }

    /// Torque of the indenter on the gel about the indenter's origin at the last frame, in the
    /// gel's frame, N mm; `[3]`. Zero before the first frame.
    #[getter]
    fn torque_n_mm<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.vector(py, |frame| frame.torque_n_mm)
    }

    /// Raises `TypeError`: a `GelState` cannot be pickled or copied.
    fn __reduce__(&self) -> PyResult<()> {
        refused(
            "GelState",
            "pickle the Gel, and take a state of it in each process, with Gel.state",
        )
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(match self.depth_mm(py)? {
            Some(depth_mm) => format!("<GelState pressed {depth_mm:.2} mm deep, {PROVENANCE}>"),
            None => format!("<GelState untouched, {PROVENANCE}>"),
        })
    }

    /// Removes the indenter, and resets the gel to the state before the first frame, without any
    /// history.
    fn rest(&self, py: Python<'_>) -> PyResult<()> {
        self.look(py, |held| {
            held.state.rest();
            held.last = None;
        })
    }
}
