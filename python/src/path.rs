//! Paths of an indenter, and the response of a gel along them.

use std::collections::BTreeMap;
use std::path::PathBuf;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use twintac::{FollowedFrame, Zero};

use crate::array::rows;
use crate::error::{OrRaise, unreadable, unusable};
use crate::fast::PROVENANCE;
use crate::given::{Array, Given};
use crate::pickle::{Kept, Reduced, reduced};
use crate::plot::plot;
use crate::pose::poses;

/// A path of an indenter over and into a gel, through poses or to forces: down, sideways, tilted,
/// and up again. Between the poses the indenter moves at constant speed.
///
/// - `indenter`: name of one of the sensor's indenters (`Sensor.indenters`).
/// - `time_s`: times of the poses, s, increasing; `[n_poses]`.
/// - `gel_from_indenter`: poses of the indenter in the gel's frame: position of its origin, mm, and
///   quaternion (x, y, z, w), `[n_poses, 7]`; or the position alone, `[n_poses, 3]`.
/// - `zero`: origin of heights: `"board"`, or `"touch"`, the height at which the indenter first
///   touches the gel at the location and rotation of the first pose.
/// - `rate_hz`: frame rate between the poses, Hz. Without it, the poses themselves are the frames.
/// - `force_n`: force straight down with which the indenter presses at each pose, N, above 0;
///   `[n_poses]`. The indenter moves down or up from the pose until it has this force. With NaN, it
///   stays at the pose.
///
/// Raises `Error` for a value that is not allowed; its `field` names the argument.
#[pyclass(frozen, from_py_object, module = "twintac")]
#[derive(Clone)]
pub(crate) struct PressPath {
    pub(crate) path: twintac::PressPath,
}

#[pymethods]
impl PressPath {
    #[new]
    #[pyo3(signature = (indenter, time_s, gel_from_indenter, *, zero="board", rate_hz=None, force_n=None))]
    fn new(
        py: Python<'_>,
        indenter: &str,
        time_s: Given<'_>,
        gel_from_indenter: Given<'_>,
        zero: &str,
        rate_hz: Option<f64>,
        force_n: Option<Given<'_>>,
    ) -> PyResult<Self> {
        let poses = poses(py, "gel_from_indenter", &gel_from_indenter)?;
        let of_each = |field: &str, given: &Given<'_>, unit: &str| {
            let expected = format!("[{}], one for each pose, {unit}", poses.len());
            let numbers: Array<1> = given.numbers(field, &expected)?;
            if numbers.values.len() == poses.len() {
                return Ok(numbers.values);
            }
            let problem = format!("has the shape {:?}, expected {expected}", numbers.shape);
            Err(unusable(py, field, &problem))
        };
        let time_s = of_each("time_s", &time_s, "s")?;
        let force_n = force_n
            .map(|force_n| of_each("force_n", &force_n, "N"))
            .transpose()?;
        let mut path = twintac::PressPath::through(indenter, time_s.into_iter().zip(poses));
        path.zero = match zero {
            "board" => Zero::Board,
            "touch" => Zero::Touch,
            _ => {
                let problem = format!("is `{zero}`, expected board or touch");
                return Err(unusable(py, "zero", &problem));
            }
        };
        path.rate_hz = rate_hz;
        for (pose, force_n) in path.poses.iter_mut().zip(force_n.unwrap_or_default()) {
            pose.force_n = Some(force_n).filter(|force_n| !force_n.is_nan());
        }
        path.validate().or_raise(py)?;
        Ok(Self { path })
    }

    /// Reads a path from a file (TOML), as `twintac simulate --path` does. A file may also have
    /// points in the gel at which the pressure is read, and another direction of forces.
    ///
    /// Raises `Error` with file, line and field if the file is wrong, and with the file if it
    /// cannot be read.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let text = std::fs::read_to_string(&path).map_err(|error| unreadable(py, &path, &error))?;
        let parsed = twintac::PressPath::parse(&path.display().to_string(), &text);
        let path = parsed.map_err(twintac::WorkError::from).or_raise(py)?;
        Ok(Self { path })
    }

    /// Name of the indenter.
    #[getter]
    fn indenter(&self) -> &str {
        &self.path.indenter
    }

    /// Time of each frame, s; `[n_frames]`.
    #[getter]
    fn time_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let frames = self.path.frames();
        PyArray1::from_iter(py, frames.iter().map(|frame| frame.time_s))
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!(
            "<PressPath of {:?} through {} poses>",
            self.path.indenter,
            self.path.poses.len()
        )
    }
}

/// The simulated gel along a path: the result of `Gel.follow`. Every array has a row for each
/// frame, up to the last one that was computed.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Followed {
    pub(crate) followed: twintac::Followed,
    pub(crate) taxels: Vec<String>,
}

impl Followed {
    fn each<'py>(&self, py: Python<'py>, value: impl Fn(&FollowedFrame) -> f64) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, self.followed.frames.iter().map(value))
    }

    fn vectors<'py>(
        &self,
        py: Python<'py>,
        value: impl Fn(&FollowedFrame) -> glam::DVec3,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let frames = &self.followed.frames;
        let numbers = frames.iter().flat_map(|frame| value(frame).to_array());
        rows(py, numbers.collect(), [frames.len(), 3])
    }
}

#[pymethods]
impl Followed {
    /// Provenance of all numbers: `"simulated"`.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// Why the frames end before the path does; `None` if they reach its end.
    #[getter]
    fn failure(&self) -> Option<&str> {
        self.followed.failure.as_deref()
    }

    /// Time, s; `[n_frames]`.
    #[getter]
    fn time_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.each(py, |frame| frame.time_s)
    }

    /// Position of the indenter's origin in the gel's frame, mm; `[n_frames, 3]`.
    #[getter]
    fn position_mm<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.vectors(py, |frame| frame.position_mm)
    }

    /// Depth below the height at which the indenter first touches the gel at the location and
    /// rotation of the first pose, mm; `[n_frames]`.
    #[getter]
    fn depth_mm<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.each(py, |frame| frame.depth_mm)
    }

    /// Force of the indenter on the gel, in the gel's frame, N; `[n_frames, 3]`. Its z component is
    /// negative if the indenter presses straight down.
    #[getter]
    fn force_n<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.vectors(py, |frame| frame.force_n)
    }

    /// Torque of the indenter on the gel about the indenter's origin, in the gel's frame, N mm;
    /// `[n_frames, 3]`.
    #[getter]
    fn torque_n_mm<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.vectors(py, |frame| frame.torque_n_mm)
    }

    /// Port pressure of each taxel: the hydrostatic pressure in the gel over the port, kPa;
    /// `[n_frames, n_taxels]`.
    #[getter]
    fn readings_kpa<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let frames = &self.followed.frames;
        let readings = frames.iter().flat_map(|frame| readings_kpa(frame, &self.taxels));
        rows(py, readings.collect(), [frames.len(), self.taxels.len()])
    }

    /// Hydrostatic pressure at each point of the path's file, by name, kPa; `[n_frames]` each.
    #[getter]
    fn points_kpa<'py>(&self, py: Python<'py>) -> BTreeMap<&str, Bound<'py, PyArray1<f64>>> {
        let names = self
            .followed
            .frames
            .first()
            .map(|frame| frame.pressure_kpa.keys());
        let points = names
            .into_iter()
            .flatten()
            .filter(|name| !self.taxels.contains(name));
        points
            .map(|name| (name.as_str(), self.each(py, |frame| frame.pressure_kpa[name])))
            .collect()
    }

    /// Draws readings, force and position over time with Matplotlib.
    ///
    /// - `axes`: three axes to draw in; new ones unless given.
    ///
    /// Returns the axes, so that they can be restyled. Raises `ModuleNotFoundError` without
    /// Matplotlib, and `Error` for another number of axes.
    #[pyo3(signature = (axes=None))]
    fn plot<'py>(result: &Bound<'py, Self>, axes: Option<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        plot(result.py(), "followed", (result, axes))
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __len__(&self) -> usize {
        self.followed.frames.len()
    }

    fn __repr__(&self) -> String {
        let n_frames = self.__len__();
        match self.failure() {
            None => format!("<Followed, {n_frames} frames, {PROVENANCE}>"),
            Some(failure) => format!("<Followed, {n_frames} frames, {PROVENANCE}, ends early: {failure}>"),
        }
    }
}

impl Kept for PressPath {
    type State = twintac::PressPath;

    fn state(&self, _: Python<'_>) -> PyResult<twintac::PressPath> {
        Ok(self.path.clone())
    }

    fn restored(_: Python<'_>, path: twintac::PressPath) -> PyResult<Self> {
        Ok(Self { path })
    }
}

impl Kept for Followed {
    type State = (twintac::Followed, Vec<String>);

    fn state(&self, _: Python<'_>) -> PyResult<Self::State> {
        Ok((self.followed.clone(), self.taxels.clone()))
    }

    fn restored(_: Python<'_>, (followed, taxels): Self::State) -> PyResult<Self> {
        Ok(Self { followed, taxels })
    }
}

/// Pressures at the ports of the taxels, in their order, kPa.
pub(crate) fn readings_kpa(frame: &FollowedFrame, taxels: &[String]) -> Vec<f64> {
    taxels.iter().map(|taxel| frame.pressure_kpa[taxel]).collect()
}
