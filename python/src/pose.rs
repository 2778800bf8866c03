//! Poses.

use glam::DQuat;
use pyo3::prelude::*;

use crate::error::unusable;
use crate::given::{Array, Given};
use crate::pickle::{Kept, Reduced, reduced};

/// Largest accepted difference of a quaternion's length from 1.
const LENGTH_TOLERANCE: f64 = 1e-3;

const NO_TURN: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

/// A pose: the rigid transform from an inner frame of reference to an outer one, such as from an
/// indenter's frame to the gel's.
///
/// - `position_mm`: origin of the inner frame in the outer one, mm.
/// - `quaternion`: rotation from the inner to the outer frame, `(x, y, z, w)`, of length 1; no
///   rotation unless given.
///
/// Raises `Error` for numbers that are not finite, and for a quaternion of another length.
#[pyclass(frozen, eq, from_py_object, module = "twintac")]
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Pose {
    pub(crate) pose: twintac::Pose,
}

#[pymethods]
impl Pose {
    #[new]
    #[pyo3(
        signature = (position_mm, quaternion=None),
        text_signature = "(position_mm, quaternion=(0.0, 0.0, 0.0, 1.0))"
    )]
    fn new(py: Python<'_>, position_mm: Given<'_>, quaternion: Option<Given<'_>>) -> PyResult<Self> {
        let quaternion = quaternion
            .map(|quaternion| quaternion.few("quaternion", ", x, y, z and w"))
            .transpose()?;
        Ok(Self {
            pose: checked(
                py,
                position_mm.few("position_mm", ", mm")?,
                quaternion.unwrap_or(NO_TURN),
            )?,
        })
    }

    /// Origin of the inner frame in the outer frame, mm.
    #[getter]
    fn position_mm(&self) -> (f64, f64, f64) {
        self.pose.position_mm.into()
    }

    /// Rotation from the inner to the outer frame, `(x, y, z, w)`.
    #[getter]
    fn quaternion(&self) -> (f64, f64, f64, f64) {
        self.pose.rotation.into()
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!(
            "Pose({:?}, quaternion={:?})",
            self.position_mm(),
            self.quaternion()
        )
    }
}

impl Kept for Pose {
    type State = twintac::Pose;

    fn state(&self, _: Python<'_>) -> PyResult<twintac::Pose> {
        Ok(self.pose)
    }

    fn restored(_: Python<'_>, pose: twintac::Pose) -> PyResult<Self> {
        Ok(Self { pose })
    }
}

/// Poses, `[n_poses, 7]`: position in mm and quaternion `(x, y, z, w)`; or `[n_poses, 3]`:
/// positions without rotation.
pub(crate) fn poses(py: Python<'_>, field: &str, rows: &Given<'_>) -> PyResult<Vec<twintac::Pose>> {
    let expected = "[n, 7], place in mm and quaternion (x, y, z, w), or [n, 3], the place alone";
    let rows: Array<2> = rows.numbers(field, expected)?;
    let n_columns = rows.shape[1];
    if n_columns != 7 && n_columns != 3 {
        let problem = format!("has the shape {:?}, expected {expected}", rows.shape);
        return Err(unusable(py, field, &problem));
    }
    let pose = |pose: &[f64]| {
        let quaternion = pose.get(3..7).map_or(NO_TURN, |q| [q[0], q[1], q[2], q[3]]);
        checked(py, [pose[0], pose[1], pose[2]], quaternion)
    };
    rows.rows().map(pose).collect()
}

/// A pose, if the numbers are finite and the quaternion has length 1.
pub(crate) fn checked(
    py: Python<'_>,
    position_mm: [f64; 3],
    quaternion: [f64; 4],
) -> PyResult<twintac::Pose> {
    if !position_mm
        .iter()
        .chain(&quaternion)
        .all(|number| number.is_finite())
    {
        return Err(unusable(
            py,
            "position_mm",
            "or `quaternion` has a number that is not finite",
        ));
    }
    let rotation = DQuat::from_array(quaternion);
    let length = rotation.length();
    if (length - 1.0).abs() > LENGTH_TOLERANCE {
        return Err(unusable(
            py,
            "quaternion",
            &format!("has the length {length}, expected 1"),
        ));
    }
    Ok(twintac::Pose {
        position_mm: position_mm.into(),
        rotation,
    })
}
