//! Poses.

use glam::DQuat;
use pyo3::prelude::*;

use crate::error::unusable;

/// How far a quaternion's length may be from 1.
const LENGTH_TOLERANCE: f64 = 1e-3;

/// A rigid transform from an inner to an outer frame.
#[pyclass(frozen, eq, from_py_object, module = "twintac")]
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Pose {
    pub(crate) pose: twintac::Pose,
}

#[pymethods]
impl Pose {
    #[new]
    #[pyo3(
        signature = (position_mm, quaternion=(0.0, 0.0, 0.0, 1.0)),
        text_signature = "(position_mm, quaternion=(0.0, 0.0, 0.0, 1.0))"
    )]
    fn new(py: Python<'_>, position_mm: (f64, f64, f64), quaternion: (f64, f64, f64, f64)) -> PyResult<Self> {
        let (x_mm, y_mm, z_mm) = position_mm;
        let (x, y, z, w) = quaternion;
        Ok(Self {
            pose: checked(py, [x_mm, y_mm, z_mm], [x, y, z, w])?,
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
