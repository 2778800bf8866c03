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

/// Many simulated presses, made in shards by any number of processes and machines. A press depends
/// only on the seed and on its own name. The merged file therefore has the same bytes for every
/// division into shards.
///
/// - `sensor`: path of the sensor description (TOML); unless given, the sensor of the twin, or
///   PhysTac without a twin.
/// - `protocol`: path of the press protocol (TOML); random presses unless given.
/// - `indenters`: names of the indenters of random presses; all indenters of the sensor unless
///   given. A protocol names its own.
/// - `n_presses`: number of presses; unless given, 1000 random presses, rounded up to the same
///   number for each indenter, or all presses of the protocol.
/// - `seed`: seed of all random choices.
/// - `fast`: the surrogate of the gel: `True` for the built-in one of PhysTac or of its fingertip,
///   or the path of a file. Without it, the gel is computed with finite elements.
/// - `twin`: folder of the twin that computes the readings; unless given, readings are the
///   pressures at the ports.
/// - `variation`: path of the sensor variation (TOML), from which each press gets an imperfect
///   sensor of its own. It needs `fast`.
/// - `settings`: path of a file (TOML) that may have a table `[simulate]` with settings of the
///   simulation; not together with `twin`.
///
/// Raises `Error` with file, line and field if a file is wrong, and for arguments that do not go
/// together.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Dataset {
    dataset: Arc<twintac::Dataset>,
}

/// Which surrogate (fast gel).
#[derive(FromPyObject)]
pub(crate) enum Fast {
    /// The built-in one of PhysTac, or none.
    Chosen(bool),
    /// The surrogate in a file.
    File(PathBuf),
}

#[pymethods]
impl Dataset {
    #[new]
    #[pyo3(signature = (*, sensor=None, protocol=None, indenters=Vec::new(), n_presses=None, seed=None, fast=Fast::Chosen(false), twin=None, variation=None, settings=None), text_signature = "(*, sensor=None, protocol=None, indenters=..., n_presses=None, seed=1, fast=..., twin=None, variation=None, settings=None)")]
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
        variation: Option<PathBuf>,
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
            variation,
            settings,
        };
        let dataset = py
            .detach(|| in_parallel(|| twintac::Dataset::open(&plan)))
            .or_raise(py)?;
        Ok(Self {
            dataset: Arc::new(dataset),
        })
    }

    /// Number of presses.
    #[getter]
    fn n_presses(&self) -> usize {
        self.dataset.n_presses()
    }

    /// The text of `dataset.toml`: the inputs of the data set. Data sets with the same text are the
    /// same.
    #[getter]
    fn identity(&self) -> &str {
        self.dataset.identity()
    }

    /// Makes one shard in a folder, unless it is complete there. The shard appears whole or not at
    /// all. Ctrl-C ends the call before the next press.
    ///
    /// - `folder`: path of the folder.
    /// - `shard`: number of the shard, from 1 to `of`.
    /// - `of`: number of shards.
    /// - `progress`: display of the progress, see `Progress`.
    ///
    /// Returns the manifest of the shard, with the paths `parquet` and `manifest_file`.
    ///
    /// Raises `Error` for a folder that holds another data set or another division into shards, and
    /// for a shard that is not from 1 to `of`.
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

    /// Checks that all shards in a folder are complete and unchanged.
    ///
    /// - `folder`: path of the folder.
    /// - `progress`: display of the progress, see `Progress`.
    ///
    /// Returns the numbers of shards, presses and frames, and the presses that were left out.
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

    /// Checks all shards as `check` does, and writes all presses as one recording.
    ///
    /// - `folder`: path of the folder.
    /// - `file`: path of the recording; `presses.parquet` in the folder unless given.
    /// - `progress`: display of the progress, see `Progress`.
    ///
    /// Returns what `check` returns.
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

    /// Raises `TypeError`: a `Dataset` cannot be pickled or copied.
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
