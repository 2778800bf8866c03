//! Presses as they are asked for.

use numpy::ndarray::Ix1;
use pyo3::prelude::*;

use crate::array::{Numbers, few};
use crate::error::unusable;

/// A straight press: down to a depth, a hold, and back up.
///
/// - `indenter`: name of one of the sensor's indenters (`Sensor.indenters`).
/// - `at_mm`: place of the indenter's origin in the gel's plane, mm; the middle of the gel unless given.
/// - `depth_mm`: depth below first touch, mm, above 0.
/// - `spin_rad`: turn of the indenter about the axis of the press, radians.
/// - `speed_mm_per_s`: speed down and up, mm/s, above 0.
/// - `hold_s`: time at full depth, s.
///
/// Raises `Error`, whose `field` is the argument that cannot be. Whether the sensor has the indenter is seen when it presses.
#[pyclass(frozen, eq, get_all, from_py_object, module = "twintac")]
#[derive(Clone, PartialEq)]
pub(crate) struct Press {
    /// Name of one of the sensor's indenters.
    indenter: String,
    /// Place of the indenter's origin in the gel's plane, x and y, mm.
    at_mm: (f64, f64),
    /// Depth below first touch, mm.
    depth_mm: f64,
    /// Turn of the indenter about the axis of the press, radians.
    spin_rad: f64,
    /// Speed down and up, mm/s.
    speed_mm_per_s: f64,
    /// Time at full depth, s.
    hold_s: f64,
}

#[pymethods]
impl Press {
    #[new]
    #[pyo3(
        signature = (indenter, *, at_mm=None, depth_mm=1.0, spin_rad=0.0, speed_mm_per_s=2.0, hold_s=0.0),
        text_signature = "(indenter, *, at_mm=(0.0, 0.0), depth_mm=1.0, spin_rad=0.0, speed_mm_per_s=2.0, hold_s=0.0)"
    )]
    fn new(
        py: Python<'_>,
        indenter: String,
        at_mm: Option<Numbers<'_, Ix1>>,
        depth_mm: f64,
        spin_rad: f64,
        speed_mm_per_s: f64,
        hold_s: f64,
    ) -> PyResult<Self> {
        let at_mm = at_mm.map(|at_mm| few::<2>(py, "at_mm", &at_mm)).transpose()?;
        let at_mm = at_mm.map_or((0.0, 0.0), Into::into);
        for (field, value) in [("depth_mm", depth_mm), ("speed_mm_per_s", speed_mm_per_s)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(unusable(
                    py,
                    field,
                    &format!("is {value}, expected a number above 0"),
                ));
            }
        }
        if !(hold_s >= 0.0 && hold_s.is_finite()) {
            return Err(unusable(
                py,
                "hold_s",
                &format!("is {hold_s}, expected 0 or more"),
            ));
        }
        if ![at_mm.0, at_mm.1, spin_rad].iter().all(|value| value.is_finite()) {
            return Err(unusable(py, "at_mm", "or `spin_rad` is not finite"));
        }
        Ok(Self {
            indenter,
            at_mm,
            depth_mm,
            spin_rad,
            speed_mm_per_s,
            hold_s,
        })
    }

    fn __repr__(&self) -> String {
        format!(
            "Press({:?}, at_mm={:?}, depth_mm={:?}, spin_rad={:?}, speed_mm_per_s={:?}, hold_s={:?})",
            self.indenter, self.at_mm, self.depth_mm, self.spin_rad, self.speed_mm_per_s, self.hold_s
        )
    }
}

impl From<&Press> for twintac::Press {
    fn from(press: &Press) -> Self {
        Self::with(&press.indenter)
            .at_mm(press.at_mm.0, press.at_mm.1)
            .depth_mm(press.depth_mm)
            .spin_rad(press.spin_rad)
            .speed_mm_per_s(press.speed_mm_per_s)
            .hold_s(press.hold_s)
    }
}
