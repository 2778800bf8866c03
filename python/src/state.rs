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

/// A gel that one indenter presses, frame by frame: pushed, slid and turned as poses come. What `Gel.state` returns. It keeps how it is deformed, what its material
/// remembers, and where friction holds it.
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

    /// Looks at the gel, once a step that was interrupted is made.
    fn look<T>(&self, py: Python<'_>, look: impl FnOnce(&mut Held) -> T) -> PyResult<T> {
        self.held.look(py, look)
    }

    /// A vector of the last frame; zero before the first.
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
    /// What every number is: simulated.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// One more frame, `since_previous_s` after the last: the indenter goes straight to a pose in the gel's frame (`gel_from_indenter`). With `force_n`, N, above 0, it then
    /// goes down or up, by at most the gel's height, until it presses straight down with that force. The first frame takes no notice of the time.
    ///
    /// Returns the hydrostatic pressure in the gel over each taxel's port, kPa; `[n_taxels]`. Small steps take milliseconds on a gel of few nodes
    /// (`Gel(sensor, {"max_path_nodes": 4000})`), long ones on a fine gel seconds. Ctrl-C ends the wait; the step is made all the same.
    ///
    /// Raises `Error` if the solver finds no equilibrium: the gel is then as it was before, and smaller steps may do; for a time below 0, and for a force that is not
    /// above 0, is not met, or is more than the sensor stands (`limits.force_n` of its description).
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
        self.look(py, |_| ())?; // it can be stepped in this process
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

    /// Where the indenter is, in the gel's frame; `None` before the first frame.
    #[getter]
    fn gel_from_indenter(&self, py: Python<'_>) -> PyResult<Option<Pose>> {
        let pose = self.look(py, |held| held.state.gel_from_indenter())?;
        Ok(pose.map(|pose| Pose { pose }))
    }

    /// How far the indenter is below where, at the place and turn of the first of the poses that `Gel.state` was given, it first touches the gel, mm; `None` before the
    /// first frame.
    #[getter]
    fn depth_mm(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        self.look(py, |held| held.last.as_ref().map(|frame| frame.depth_mm))
    }

    /// Whether the forces at the last frame are balanced: they are, unless `Gel.state` was given a `deadline_ms` that came first. `None` before the first frame.
    #[getter]
    fn converged(&self, py: Python<'_>) -> PyResult<Option<bool>> {
        self.look(py, |held| held.last.as_ref().map(|frame| frame.converged))
    }

    /// What part of the load is unbalanced at the last frame; `None` before the first.
    #[getter]
    fn residual(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        self.look(py, |held| held.last.as_ref().map(|frame| frame.quality.residual))
    }

    /// Force of the indenter on the gel at the last frame, in the gel's frame, N; `[3]`. A press straight down has a negative z. Zero before the first frame.
    #[getter]
    fn force_n<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.vector(py, |frame| frame.force_n)
    }

    /// Torque of the indenter on the gel about the indenter's origin at the last frame, in the gel's frame, N mm; `[3]`. Zero before the first frame.
    #[getter]
    fn torque_n_mm<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.vector(py, |frame| frame.torque_n_mm)
    }

    /// A gel that is pressed is no value.
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

    /// Takes the indenter away: the gel is as it was before the first frame, and remembers nothing.
    fn rest(&self, py: Python<'_>) -> PyResult<()> {
        self.look(py, |held| {
            held.state.rest();
            held.last = None;
        })
    }
}
