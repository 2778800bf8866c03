//! The Python extension module `twintac._twintac`: the library `twintac`, with NumPy arrays in and
//! out.
//!
//! The Python package `twintac` (folder `python/twintac`) re-exports its classes. Units are those
//! of the library: mm, N, kPa, s, radians.
//!
//! # How it works
//!
//! - Each file of `python/src` binds the types of one file of the library. Nothing is computed
//!   here; what is missing is added to the library.
//! - What makes the library panic, such as arrays of a wrong length or numbers that are not finite,
//!   is checked before the call, so that it becomes an exception (`error`).
//! - A call that takes long works on a thread of its own ([`long_call`]). The calling thread
//!   handles signals and reports progress, because Python handles signals in no other thread. A
//!   press that Ctrl-C interrupts runs on without its result being used. A run is waited for, so
//!   that no second one works in its folder.
//! - The command is the library of `crates/app/cli`, called in Python's process. The SHA-256 of the
//!   package's own file identifies the build.
//! - Arguments that are arrays, counts or seeds arrive as `Given`, which gives a value only for a
//!   named argument and a range or shape (`given`). An unusable argument is therefore refused by
//!   name before anything is allocated.
//! - Parallel work runs in `in_parallel` (`pool`), on threads that each process makes for itself.
//!   The global threads of rayon do not exist in a forked process, which would wait for them
//!   forever.
//! - What steps change is `Shared` (`shared`): threads take turns. Work inside the pool never locks
//!   it, because a waiting pool thread may take up another caller's work.
//! - Values are `Kept` (`pickle`): a pickle has the class's name and its state as CBOR; `restore`
//!   makes the value again.
//! - Type stubs are written by hand, because those that PyO3 makes have no array types.
//!   `mypy.stubtest` compares them with the library. Their docstrings are the doc comments of the
//!   exported classes and methods here: `python/tests/stubs.py` copies them.
//! - A recording is handed to other libraries as one Arrow batch, by the PyCapsule interface
//!   (`arrow`). The crate `arrow-array` contains the unsafe code for that; it brings three more
//!   crates, all of the same project as `parquet`.

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
    use crate::sensors::{Coupling, SensorBatch, SensorState, SensorVariation};
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
