//! Restores pickled values.

use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use crate::contact::Contact;
use crate::error::unusable;
use crate::fast::FastGel;
use crate::gel::{Gel, Pressed};
use crate::map::PressureMap;
use crate::path::{Followed, PressPath};
use crate::pickle::{Kept, restored};
use crate::pose::Pose;
use crate::press::Press;
use crate::reader::Reading;
use crate::recording::Recording;
use crate::run::Run;
use crate::sensor::Sensor;
use crate::sensors::{Coupling, SensorVariation};
use crate::shape::{Body, Shape};
use crate::table::ReadingTable;
use crate::twin::{Prediction, Twin};

/// Restores a pickled object from its class name and its state.
#[pyfunction]
pub(crate) fn _restored(py: Python<'_>, class: &str, state: &[u8]) -> PyResult<Py<PyAny>> {
    match class {
        "Body" => of::<Body>(py, class, state),
        "Contact" => of::<Contact>(py, class, state),
        "Coupling" => of::<Coupling>(py, class, state),
        "FastGel" => of::<FastGel>(py, class, state),
        "Followed" => of::<Followed>(py, class, state),
        "Gel" => of::<Gel>(py, class, state),
        "Pose" => of::<Pose>(py, class, state),
        "Prediction" => of::<Prediction>(py, class, state),
        "Press" => of::<Press>(py, class, state),
        "PressPath" => of::<PressPath>(py, class, state),
        "Pressed" => of::<Pressed>(py, class, state),
        "PressureMap" => of::<PressureMap>(py, class, state),
        "Reading" => of::<Reading>(py, class, state),
        "ReadingTable" => of::<ReadingTable>(py, class, state),
        "Recording" => of::<Recording>(py, class, state),
        "Run" => of::<Run>(py, class, state),
        "Sensor" => of::<Sensor>(py, class, state),
        "SensorVariation" | "Imperfection" => of::<SensorVariation>(py, class, state),
        "Shape" => of::<Shape>(py, class, state),
        "Twin" => of::<Twin>(py, class, state),
        _ => Err(unusable(
            py,
            class,
            "is no class of this version of twintac that was pickled",
        )),
    }
}

fn of<'py, T: Kept + IntoPyObject<'py>>(py: Python<'py>, class: &str, state: &[u8]) -> PyResult<Py<PyAny>> {
    let value: T = restored(py, class, state)?;
    value.into_py_any(py)
}
