//! Poses.

use glam::DQuat;
use numpy::ndarray::{Ix1, Ix2};
use pyo3::prelude::*;

use crate::array::{Numbers, few, in_order};
use crate::error::unusable;

/// How far a quaternion's length may be from 1.
const LENGTH_TOLERANCE: f64 = 1e-3;

const NO_TURN: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

/// A rigid transform from an inner frame to an outer one, such as from an indenter's frame to the gel's.
///
/// - `position_mm`: origin of the inner frame in the outer one, mm.
/// - `quaternion`: rotation from the inner to the outer frame, `(x, y, z, w)`, of length 1; none unless given.
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
    fn new(
        py: Python<'_>,
        position_mm: Numbers<'_, Ix1>,
        quaternion: Option<Numbers<'_, Ix1>>,
    ) -> PyResult<Self> {
        let quaternion = quaternion
            .map(|quaternion| few(py, "quaternion", &quaternion))
            .transpose()?;
        Ok(Self {
            pose: checked(
                py,
                few(py, "position_mm", &position_mm)?,
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

    fn __repr__(&self) -> String {
        format!(
            "Pose({:?}, quaternion={:?})",
            self.position_mm(),
            self.quaternion()
        )
    }
}

/// Poses, `[n_poses, 7]`: place in mm and quaternion `(x, y, z, w)`; or `[n_poses, 3]`, places of what is not turned.
pub(crate) fn poses(py: Python<'_>, field: &str, rows: &Numbers<'_, Ix2>) -> PyResult<Vec<twintac::Pose>> {
    let n_columns = rows.as_array().ncols();
    if n_columns != 7 && n_columns != 3 {
        let problem = format!("has {n_columns} columns, expected 7 (place and quaternion) or 3 (place)");
        return Err(unusable(py, field, &problem));
    }
    let pose = |pose: &[f64]| {
        let quaternion = pose.get(3..7).map_or(NO_TURN, |q| [q[0], q[1], q[2], q[3]]);
        checked(py, [pose[0], pose[1], pose[2]], quaternion)
    };
    in_order(rows).chunks_exact(n_columns).map(pose).collect()
}

/// The pose, if it is one.
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
