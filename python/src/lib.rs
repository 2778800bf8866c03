//! TwinTac for Python: the library `twintac`, with NumPy in and out.
//!
//! Each file binds the types of one of the library's files; nothing is computed here. Long calls work on a thread of their own ([`long_call`]).

mod array;
mod arrow;
mod contact;
mod dataset;
mod error;
mod fast;
mod floor;
mod friction;
mod gel;
mod given;
mod inverse;
mod long_call;
mod map;
mod path;
mod pickle;
mod plot;
mod pool;
mod pose;
mod press;
mod program;
mod reader;
mod recording;
mod restore;
mod run;
mod sensor;
mod sensors;
mod settings;
mod shape;
mod shared;
mod state;
mod table;
mod tasks;
mod touches;
mod twin;

use pyo3::prelude::*;

/// Barometric touch sensors and their digital twin.
#[pymodule]
mod _twintac {
    #[pymodule_export]
    use crate::contact::Contact;
    #[pymodule_export]
    use crate::dataset::Dataset;
    #[pymodule_export]
    use crate::fast::{FastBatch, FastGel, FastReader};
    #[pymodule_export]
    use crate::floor::FloorMap;
    #[pymodule_export]
    use crate::friction::Friction;
    #[pymodule_export]
    use crate::gel::{Gel, Pressed};
    #[pymodule_export]
    use crate::inverse::{Inverse, Tracker};
    #[pymodule_export]
    use crate::map::PressureMap;
    #[pymodule_export]
    use crate::path::{Followed, PressPath};
    #[pymodule_export]
    use crate::pose::Pose;
    #[pymodule_export]
    use crate::press::Press;
    #[pymodule_export]
    use crate::program::command;
    #[pymodule_export]
    use crate::reader::{Reader, Reading};
    #[pymodule_export]
    use crate::recording::Recording;
    #[pymodule_export]
    use crate::restore::_restored;
    #[pymodule_export]
    use crate::run::Run;
    #[pymodule_export]
    use crate::sensor::Sensor;
    #[pymodule_export]
    use crate::sensors::{Coupling, Imperfection, SensorBatch, SensorState};
    #[pymodule_export]
    use crate::shape::{Body, Shape};
    #[pymodule_export]
    use crate::state::GelState;
    #[pymodule_export]
    use crate::table::ReadingTable;
    #[pymodule_export]
    use crate::tasks::Tasks;
    #[pymodule_export]
    use crate::twin::{Prediction, Twin, TwinAtPlace, TwinState};

    /// The version of this package.
    #[pymodule_export]
    #[allow(non_upper_case_globals)] // Python's name
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
