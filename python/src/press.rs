//! Planned presses.

use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::error::unusable;
use crate::given::Given;
use crate::pickle::{Kept, Reduced, reduced};

/// Largest depth, and largest distance from the middle, mm.
const LARGEST_MM: f64 = 1000.0;

/// Longest hold, s.
const LONGEST_S: f64 = 3600.0;

/// Slowest press, mm/s.
const SLOWEST_MM_PER_S: f64 = 1e-3;

/// A straight press: down to a depth, a hold, and back up.
///
/// - `indenter`: name of one of the sensor's indenters (`Sensor.indenters`).
/// - `at_mm`: location of the indenter's origin in the gel's frame, x and y, mm; the origin of that
///   frame unless given, which need not be the middle of the gel.
/// - `depth_mm`: depth below first touch, mm, above 0.
/// - `yaw_rad`: yaw, the rotation of the indenter about the axis of the press, radians.
/// - `speed_mm_per_s`: speed down and up, mm/s, 0.001 or more.
/// - `hold_s`: time at full depth, s, at most an hour.
///
/// Raises `Error` for a value that is not allowed; its `field` names the argument. Whether the
/// sensor has the indenter is checked when the gel is pressed.
#[pyclass(frozen, eq, get_all, from_py_object, module = "twintac")]
#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Press {
    /// Name of one of the sensor's indenters.
    indenter: String,
    /// Location of the indenter's origin in the gel's plane, x and y, mm.
    at_mm: (f64, f64),
    /// Depth below first touch, mm.
    depth_mm: f64,
    /// Yaw (rotation of the indenter about the axis of the press), radians.
    yaw_rad: f64,
    /// Speed down and up, mm/s.
    speed_mm_per_s: f64,
    /// Time at full depth, s.
    hold_s: f64,
}

#[pymethods]
impl Press {
    #[new]
    #[pyo3(
        signature = (indenter, *, at_mm=None, depth_mm=1.0, yaw_rad=0.0, speed_mm_per_s=2.0, hold_s=0.0),
        text_signature = "(indenter, *, at_mm=(0.0, 0.0), depth_mm=1.0, yaw_rad=0.0, speed_mm_per_s=2.0, hold_s=0.0)"
    )]
    fn new(
        py: Python<'_>,
        indenter: String,
        at_mm: Option<Given<'_>>,
        depth_mm: f64,
        yaw_rad: f64,
        speed_mm_per_s: f64,
        hold_s: f64,
    ) -> PyResult<Self> {
        let at_mm = at_mm.map(|at_mm| at_mm.few::<2>("at_mm", ", mm")).transpose()?;
        let at_mm = at_mm.map_or((0.0, 0.0), Into::into);
        let of_size = -LARGEST_MM..=LARGEST_MM;
        for (field, value, range, unit) in [
            ("depth_mm", depth_mm, f64::MIN_POSITIVE..=LARGEST_MM, "mm"),
            ("speed_mm_per_s", speed_mm_per_s, SLOWEST_MM_PER_S..=1e4, "mm/s"),
            ("hold_s", hold_s, 0.0..=LONGEST_S, "s"),
            ("at_mm", at_mm.0, of_size.clone(), "mm"),
            ("at_mm", at_mm.1, of_size, "mm"),
            ("yaw_rad", yaw_rad, -1e3..=1e3, "radians"),
        ] {
            if !range.contains(&value) {
                let (least, most) = (range.start(), range.end());
                let expected = match *least {
                    f64::MIN_POSITIVE => format!("above 0, and at most {most} {unit}"),
                    least => format!("from {least} to {most} {unit}"),
                };
                return Err(unusable(
                    py,
                    field,
                    &format!("is {value}, expected a number {expected}"),
                ));
            }
        }
        Ok(Self {
            indenter,
            at_mm,
            depth_mm,
            yaw_rad,
            speed_mm_per_s,
            hold_s,
        })
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!(
            "Press({:?}, at_mm={:?}, depth_mm={:?}, yaw_rad={:?}, speed_mm_per_s={:?}, hold_s={:?})",
            self.indenter, self.at_mm, self.depth_mm, self.yaw_rad, self.speed_mm_per_s, self.hold_s
        )
    }
}

impl Kept for Press {
    type State = Self;

    fn state(&self, _: Python<'_>) -> PyResult<Self> {
        Ok(self.clone())
    }

    fn restored(_: Python<'_>, state: Self) -> PyResult<Self> {
        Ok(state)
    }
}

impl From<&Press> for twintac::Press {
    fn from(press: &Press) -> Self {
        Self::with(&press.indenter)
            .at_mm(press.at_mm.0, press.at_mm.1)
            .depth_mm(press.depth_mm)
            .yaw_rad(press.yaw_rad)
            .speed_mm_per_s(press.speed_mm_per_s)
            .hold_s(press.hold_s)
    }
}
