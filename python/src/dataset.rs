//! Data sets of simulated presses, made in shards.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use twintac::{DatasetPlan, FastSource, Shard, check_dataset, merge_dataset};

use crate::error::{OrRaise, unusable};
use crate::given::Given;
use crate::long_call::followed;
use crate::pickle::refused;
use crate::pool::in_parallel;
use crate::settings::to_python;

/// Most presses of a data set.
const MOST_PRESSES: usize = 100_000_000;

/// Many simulated presses, made in shards by as many processes and machines as there are. A press depends on the seed and on its own name alone: however the data set
/// is divided, its shards merge to the same bytes.
///
/// Presses are those of a protocol (TOML), or `n_presses` at random with the `indenters` named (all, if none is), 1000 unless it is said. The gel is solved, or a fast one:
/// PhysTac's (`fast=True`) or that of a file. Readings are the pressures at the ports, or those of the twin in a folder. `imperfection` (TOML, with `fast`) gives each press an
/// imperfect sensor of its own. `settings` (TOML) may have a table `[simulate]`. Without a `sensor` (TOML), that of the twin is taken, or PhysTac.
///
/// Raises `Error` with file, line and field if a file is wrong, and for arguments that do not go together.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Dataset {
    dataset: Arc<twintac::Dataset>,
}

/// Which fast gel.
#[derive(FromPyObject)]
pub(crate) enum Fast {
    /// PhysTac's, or none.
    Chosen(bool),
    /// That of a file.
    File(PathBuf),
}

#[pymethods]
impl Dataset {
    #[new]
    #[pyo3(signature = (*, sensor=None, protocol=None, indenters=Vec::new(), n_presses=None, seed=None, fast=Fast::Chosen(false), twin=None, imperfection=None, settings=None), text_signature = "(*, sensor=None, protocol=None, indenters=..., n_presses=None, seed=1, fast=..., twin=None, imperfection=None, settings=None)")]
    #[expect(clippy::too_many_arguments)] // named ones
    fn new(
        py: Python<'_>,
        sensor: Option<PathBuf>,
        protocol: Option<PathBuf>,
        indenters: Vec<String>,
        n_presses: Option<Given<'_>>,
        seed: Option<Given<'_>>,
        fast: Fast,
        twin: Option<PathBuf>,
        imperfection: Option<PathBuf>,
        settings: Option<PathBuf>,
    ) -> PyResult<Self> {
        if protocol.is_some() && !indenters.is_empty() {
            return Err(unusable(
                py,
                "indenters",
                "does not go with a protocol, which names its own",
            ));
        }
        let n_presses = n_presses.map(|given| given.count("n_presses", 1..=MOST_PRESSES));
        let plan = DatasetPlan {
            sensor,
            protocol,
            indenters,
            n_presses: n_presses.transpose()?,
            seed: seed.map_or(Ok(1), |seed| seed.seed("seed"))?,
            fast: match fast {
                Fast::Chosen(false) => None,
                Fast::Chosen(true) => Some(FastSource::BuiltIn),
                Fast::File(file) => Some(FastSource::File(file)),
            },
            twin,
            imperfection,
            settings,
        };
        let dataset = py
            .detach(|| in_parallel(|| twintac::Dataset::open(&plan)))
            .or_raise(py)?;
        Ok(Self {
            dataset: Arc::new(dataset),
        })
    }

    /// How many presses it has.
    #[getter]
    fn n_presses(&self) -> usize {
        self.dataset.n_presses()
    }

    /// What it is made from: the text of `dataset.toml`. Data sets of the same text are the same.
    #[getter]
    fn identity(&self) -> &str {
        self.dataset.identity()
    }

    /// Makes shard `shard` of `of`, counted from 1, in a folder, unless it is complete there. It appears whole or not at all. Returns its manifest, and the paths `parquet` and
    /// `manifest_file`. Ctrl-C ends it before its next press.
    ///
    /// Raises `Error` for a folder that holds another data set or another division, and for a shard that is not from 1 to `of`.
    #[pyo3(signature = (folder, shard=None, of=None, *, progress=None), text_signature = "($self, folder, shard=1, of=1, *, progress=None)")]
    fn make<'py>(
        &self,
        py: Python<'py>,
        folder: PathBuf,
        shard: Option<Given<'_>>,
        of: Option<Given<'_>>,
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let dataset = Arc::clone(&self.dataset);
        let number = |field: &str, given: Option<Given<'_>>| {
            given.map_or(Ok(1), |given| given.count(field, 1..=u32::MAX as usize))
        };
        let shard = Shard::new(number("shard", shard)? as u32, number("of", of)? as u32).or_raise(py)?;
        let made = followed(py, progress.as_ref(), move |progress| {
            dataset.make(shard, &folder, progress.as_ref())
        })?;
        to_python(py, &made.or_raise(py)?)
    }

    /// Checks that all shards of a folder are there and as they were made. Returns counts of shards, presses and frames, and the presses that were left out.
    ///
    /// Raises `Error` that names the shard that is missing or differs.
    #[staticmethod]
    #[pyo3(signature = (folder, *, progress=None))]
    fn check<'py>(
        py: Python<'py>,
        folder: PathBuf,
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let whole = followed(py, progress.as_ref(), move |progress| {
            check_dataset(&folder, progress.as_ref())
        })?;
        to_python(py, &whole.or_raise(py)?)
    }

    /// Does what `check` does, and writes all presses as one recording: `presses.parquet` in the folder, or another file. Returns what `check` returns.
    ///
    /// Raises `Error` as `check` does, and for a file that cannot be written.
    #[staticmethod]
    #[pyo3(signature = (folder, file=None, *, progress=None))]
    fn merge<'py>(
        py: Python<'py>,
        folder: PathBuf,
        file: Option<PathBuf>,
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let whole = followed(py, progress.as_ref(), move |progress| {
            merge_dataset(&folder, file.as_deref(), progress.as_ref())
        })?;
        to_python(py, &whole.or_raise(py)?)
    }

    /// What is made of files is no value.
    fn __reduce__(&self) -> PyResult<()> {
        refused(
            "Dataset",
            "make it in each process, of the same files: its identity says whether it is the same",
        )
    }

    fn __repr__(&self) -> String {
        format!("<Dataset of {} presses, simulated>", self.n_presses())
    }
}
