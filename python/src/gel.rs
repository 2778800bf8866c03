//! Gels, pressed.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use twintac::{PressFrame, RunSettings, SimulateSettings};

use crate::array::rows;
use crate::error::{OrRaise, unusable};
use crate::long_call::{followed, long_call};
use crate::path::{Followed, PressPath};
use crate::pickle::{Kept, Reduced, reduced};
use crate::plot::plot;
use crate::pose::Pose;
use crate::press::Press;
use crate::sensor::Sensor;
use crate::settings::but;
use crate::state::GelState;

/// The gel of a sensor: a finite-element model with the material of the description.
///
/// - `sensor`: the sensor.
/// - `settings`: settings of the simulation that differ from the default ones for single presses,
///   such as `{"edges_per_height": 4.0}`. With more edges, a press takes longer and has a smaller
///   error.
///
/// Raises `Error` for a setting that is not allowed; its `field` names the setting.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Gel {
    gel: Arc<twintac::Gel>,
    sensor: Sensor,
    settings: SimulateSettings,
    taxels: Vec<String>,
}

impl Gel {
    fn of(sensor: &Sensor, settings: SimulateSettings) -> Self {
        Self {
            gel: Arc::new(twintac::Gel::with_settings(&sensor.sensor, settings.clone())),
            taxels: sensor.sensor.taxels().map(str::to_owned).collect(),
            sensor: sensor.clone(),
            settings,
        }
    }
}

#[pymethods]
impl Gel {
    #[new]
    #[pyo3(signature = (sensor, settings=None))]
    fn new(py: Python<'_>, sensor: &Sensor, settings: Option<Bound<'_, PyDict>>) -> PyResult<Self> {
        let settings = but(py, RunSettings::fine(), settings.as_ref(), "simulate")?;
        Ok(Self::of(sensor, settings.simulate))
    }

    /// Presses the gel down to the depth of the press, which takes about a second. The hold and the
    /// way back are not simulated. If the material of the gel relaxes, it does so at the speed of
    /// the press. Ctrl-C ends the wait.
    ///
    /// - `press`: the press.
    ///
    /// Raises `Error` for an indenter that the sensor does not have, for a location beside the gel,
    /// and for a depth at which the solver finds no equilibrium.
    fn press(&self, py: Python<'_>, press: &Press) -> PyResult<Pressed> {
        let (gel, press) = (Arc::clone(&self.gel), twintac::Press::from(press));
        let pressed = long_call(py, move || gel.press(&press))?.or_raise(py)?;
        Ok(Pressed { pressed })
    }

    /// The pose at which an indenter that is lowered first touches the undeformed gel.
    ///
    /// - `indenter`: name of the indenter.
    /// - `above`: pose in the gel's frame from which it is lowered; its height is ignored.
    ///
    /// Raises `Error` for an indenter that the sensor does not have, and for a location beside the
    /// gel.
    fn touch(&self, py: Python<'_>, indenter: &str, above: Pose) -> PyResult<Pose> {
        let pose = py.detach(|| self.gel.touch(indenter, &above.pose)).or_raise(py)?;
        Ok(Pose { pose })
    }

    /// Returns the gel before an indenter presses it. The indenter can then be moved from pose to
    /// pose as they come. The call takes about a second; Ctrl-C ends the wait.
    ///
    /// - `indenter`: name of the indenter.
    /// - `poses`: poses in the gel's frame between which the indenter will move, at least one. The
    ///   mesh is fine along the straight lines between them, and for the deepest of them.
    /// - `deadline_ms`: limit of the wall time of each frame, 1 to 60000 ms. A frame is then
    ///   returned at the limit as far as it is computed: `GelState.converged` says whether it
    ///   is at equilibrium, `GelState.residual` how nearly, and `GelState.behind_mm` how far it is
    ///   behind. Frames with a `force_n` ignore the limit. Readings with a limit are not
    ///   reproducible.
    ///
    /// Raises `Error` for an indenter that the sensor does not have, for a first pose beside the
    /// gel, and for a limit out of its range.
    #[pyo3(signature = (indenter, poses, *, deadline_ms=None))]
    fn state(
        &self,
        py: Python<'_>,
        indenter: String,
        poses: Vec<Pose>,
        deadline_ms: Option<f64>,
    ) -> PyResult<GelState> {
        if poses.is_empty() {
            return Err(unusable(py, "poses", "has none, expected at least one"));
        }
        let mut gel = twintac::Gel::clone(&self.gel);
        if let Some(deadline_ms) = deadline_ms {
            if !(1.0..=60_000.0).contains(&deadline_ms) {
                let problem = format!("is {deadline_ms}, expected 1 to 60000 (milliseconds)");
                return Err(unusable(py, "deadline_ms", &problem));
            }
            gel = gel.with_deadline(Duration::from_secs_f64(1e-3 * deadline_ms));
        }
        let poses: Vec<twintac::Pose> = poses.into_iter().map(|pose| pose.pose).collect();
        let state = long_call(py, move || gel.state(&indenter, &poses))?.or_raise(py)?;
        Ok(GelState::new(state, self.taxels.clone()))
    }

    /// Moves an indenter along a path, frame by frame. A frame takes from some milliseconds to
    /// seconds. Ctrl-C ends the call before the next frame. If a path cannot be followed to its
    /// end, its frames end early, and `Followed.failure` says why; this raises no error.
    ///
    /// - `path`: the path.
    /// - `progress`: display of the progress, see `Progress`.
    ///
    /// Raises `Error` for an indenter that the sensor does not have, for a first pose beside the
    /// gel, and for a point that is outside the gel or has the name of a taxel.
    #[pyo3(signature = (path, *, progress=None))]
    fn follow(
        &self,
        py: Python<'_>,
        path: PressPath,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Followed> {
        let gel = Arc::clone(&self.gel);
        let followed = followed(py, progress.as_ref(), move |progress| {
            progress.started("simulating", path.path.frames().len());
            let followed = gel.follow(&path.path, &mut || {
                progress.step("");
                if progress.is_stopped() {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            });
            progress.finished();
            followed
        })?;
        Ok(Followed {
            followed: followed.or_raise(py)?,
            taxels: self.taxels.clone(),
        })
    }

    /// Shows the gel in a notebook, to be pressed with sliders (`twintac.widget.GelWidget`).
    /// Without ipywidgets, or if the sensor has no indenter, a drawing of the sensor is shown.
    fn _ipython_display_(&self, py: Python<'_>) -> PyResult<()> {
        py.import("twintac._display")?
            .call_method1("gel", (self.sensor.clone(),))
            .map(|_| ())
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        let [high, fine] = [
            self.settings.edges_per_height,
            self.settings.edges_per_contact_radius,
        ];
        let name = self.sensor.sensor.name();
        format!("<Gel of {name:?}, {high} edges per height, {fine} per contact radius>")
    }
}

impl Kept for Gel {
    type State = (<Sensor as Kept>::State, SimulateSettings);

    fn state(&self, py: Python<'_>) -> PyResult<Self::State> {
        Ok((self.sensor.state(py)?, self.settings.clone()))
    }

    fn restored(py: Python<'_>, (sensor, settings): Self::State) -> PyResult<Self> {
        Ok(Self::of(&Sensor::restored(py, sensor)?, settings))
    }
}

/// A simulated press, from first touch to full depth: the result of `Gel.press`. Each frame is
/// deeper than the one before.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Pressed {
    pressed: twintac::Pressed,
}

impl Pressed {
    fn each<'py>(&self, py: Python<'py>, value: impl Fn(&PressFrame) -> f64) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, self.pressed.frames().iter().map(value))
    }
}

#[pymethods]
impl Pressed {
    /// Provenance of all numbers: `"simulated"`.
    #[getter]
    fn provenance(&self) -> &'static str {
        twintac::Pressed::PROVENANCE
    }

    /// Depth below first touch, mm; `[n_frames]`. The first frame is the untouched gel.
    #[getter]
    fn depth_mm<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.each(py, |frame| frame.depth_mm)
    }

    /// Force of the indenter into the gel, N; `[n_frames]`.
    #[getter]
    fn force_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.each(py, |frame| frame.force_n)
    }

    /// Port pressure of each taxel: the hydrostatic pressure in the gel over the port, kPa;
    /// `[n_frames, n_taxels]`. An ideal barometer without gain, delay and relaxation would read
    /// this. A trained `Twin` predicts what a real one reads.
    #[getter]
    fn readings_kpa<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let frames = self.pressed.frames();
        let readings: Vec<f64> = frames
            .iter()
            .flat_map(|frame| frame.port_pressure_kpa.clone())
            .collect();
        rows(py, readings, [frames.len(), self.pressed.readings_kpa().len()])
    }

    /// The picture that a notebook shows: readings and force over depth, as the text of an SVG
    /// file.
    fn _repr_svg_(&self) -> String {
        self.pressed.svg()
    }

    /// Draws readings and force over depth with Matplotlib.
    ///
    /// - `axes`: two axes to draw in; new ones unless given.
    ///
    /// Returns the axes, so that they can be restyled. Raises `ModuleNotFoundError` without
    /// Matplotlib, and `Error` for another number of axes.
    #[pyo3(signature = (axes=None))]
    fn plot<'py>(result: &Bound<'py, Self>, axes: Option<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        plot(result.py(), "pressed", (result, axes))
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!("<Pressed, {} frames, simulated>", self.pressed.frames().len())
    }
}

impl Kept for Pressed {
    type State = twintac::Pressed;

    fn state(&self, _: Python<'_>) -> PyResult<twintac::Pressed> {
        Ok(self.pressed.clone())
    }

    fn restored(_: Python<'_>, pressed: twintac::Pressed) -> PyResult<Self> {
        Ok(Self { pressed })
    }
}
