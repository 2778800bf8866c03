//! Recorded presses.

use std::path::PathBuf;

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict, PyList};
use serde::{Deserialize, Serialize};
use twintac::{Column, ImportSummary, Recorded, guess_import, import_files};

use crate::arrow::{STREAM, stream};
use crate::error::{OrRaise, unusable};
use crate::long_call::long_call;
use crate::pickle::{Kept, Reduced, reduced};
use crate::plot::plot;
use crate::sensor::Sensor;
use crate::settings::to_python;

/// Where numbers come from: `"real"`, `"emulated"` or `"simulated"`.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct Provenance(twintac::Provenance);

impl std::fmt::Display for Provenance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl<'py> FromPyObject<'_, 'py> for Provenance {
    type Error = PyErr;

    fn extract(word: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let text: String = word.extract()?;
        serde_json::from_value(text.clone().into())
            .map(Self)
            .map_err(|_| {
                let problem = format!("is {text:?}, expected \"real\", \"emulated\" or \"simulated\"");
                unusable(word.py(), "provenance", &problem)
            })
    }
}

/// Recorded presses of one sensor: of a real one, of an emulated one, or simulated. `len()` is the number of presses.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Recording {
    pub(crate) recording: twintac::Recording,
    /// What was found in CSV files and left out of them; nothing where it comes from elsewhere.
    imported: ImportSummary,
}

impl From<twintac::Recording> for Recording {
    fn from(recording: twintac::Recording) -> Self {
        let imported = ImportSummary::default();
        Self { recording, imported }
    }
}

#[pymethods]
impl Recording {
    /// Reads a Parquet file, as runs and `save` write it. Ctrl-C ends the wait.
    ///
    /// Raises `Error` with the file if it is no recording, is damaged, or cannot be read.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let recording = long_call(py, move || twintac::Recording::read_parquet(&path))?.or_raise(py)?;
        Ok(recording.into())
    }

    /// Reads CSV files of any laboratory. The description (TOML, see the folder `imports`) says which column is what, in which unit. Ctrl-C ends the wait.
    ///
    /// Raises `Error` with file, line and field: of the description, or of the cell that cannot be read.
    #[staticmethod]
    #[pyo3(signature = (description, *paths))]
    fn import_csv(py: Python<'_>, description: PathBuf, paths: Vec<PathBuf>) -> PyResult<Self> {
        let (recording, imported) =
            long_call(py, move || import_files(&description, &paths))?.or_raise(py)?;
        Ok(Self { recording, imported })
    }

    /// A first description of a CSV file's columns, for `import_csv`: the text of a TOML file with a comment on each guess.
    ///
    /// Raises `Error` with the file if it cannot be read or has no rows of numbers.
    #[staticmethod]
    fn guess_import(path: PathBuf, py: Python<'_>) -> PyResult<String> {
        guess_import(&path).or_raise(py)
    }

    /// What `import_csv` found in each file and left out of it, a dict for each: `file`, `rows_read`, `rows_dropped`, `rows_incomplete`, `missing_readings`,
    /// `clipped_readings`, `outliers`, `presses`, `presses_dropped`, `shared_frames`, `unread_columns`, `warnings`. Empty for recordings from elsewhere.
    #[getter]
    fn imported<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.imported.files)
    }

    /// Name of the sensor, as its description has it.
    #[getter]
    fn sensor(&self) -> &str {
        &self.recording.sensor
    }

    /// Where the numbers come from: `"real"`, `"emulated"` or `"simulated"`.
    #[getter]
    fn provenance(&self) -> String {
        self.recording.provenance.to_string()
    }

    /// Names of the taxels, in the order of every row of readings.
    #[getter]
    fn taxels(&self) -> Vec<String> {
        self.recording.taxels.clone()
    }

    /// Names of the presses, in the order in which they were made.
    #[getter]
    fn presses(&self) -> Vec<&str> {
        self.recording.presses.iter().map(|press| &*press.name).collect()
    }

    /// A NumPy array for each column of the Parquet file, with a value for each frame:
    ///
    /// - `press_index`, `press`, `mounting`, `indenter`, `control`, `provenance`: of the press, the same in all its frames;
    /// - `time_s`: time, s;
    /// - `x_mm`, `y_mm`, `z_mm`, `qx`, `qy`, `qz`, `qw`: pose of the indenter in the gel's frame, mm, and a quaternion;
    /// - `force_n`: force into the gel, N; NaN where it is not known;
    /// - `<taxel>_kpa`, `<taxel>_raw`, `<taxel>_valid`: what the taxel reads, kPa; the same as it was recorded; whether it is usable. A reading that did not come is NaN.
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        for (name, column) in self.recording.columns() {
            columns.set_item(name, self.column(py, column)?)?;
        }
        Ok(columns)
    }

    /// The columns as a `pandas.DataFrame`.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("pandas")?
            .call_method1("DataFrame", (self.columns(py)?,))
    }

    /// The columns as a `polars.DataFrame`, through Arrow: what `polars.DataFrame(recording)` does.
    fn to_polars<'py>(recording: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let polars = recording.py().import("polars")?;
        polars.call_method1("DataFrame", (recording,))
    }

    /// The columns for whatever reads Arrow by its PyCapsule interface: `polars.DataFrame(recording)`, `pyarrow.table(recording)`, `pandas.DataFrame.from_arrow(recording)`, or DuckDB.
    /// Types are those of `columns`, texts are strings, and a force that is not known and a reading that did not come are null. No other schema is given, whatever `requested_schema` is.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        drop(requested_schema);
        let stream = py.detach(|| stream(&self.recording));
        let stream = stream.map_err(|error| unusable(py, "recording", &error.to_string()))?;
        PyCapsule::new_with_value(py, stream, STREAM)
    }

    /// Writes a Parquet file, whole or not at all.
    ///
    /// Raises `Error` with the file if it cannot be written.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.recording.write_parquet(&path)).or_raise(py)
    }

    /// Writes a LeRobot data set, version 3.0, into a folder that is not there yet: presses are episodes, indenters are tasks. `how_made` is put into its data card.
    /// Returns the numbers of episodes, frames and tasks, frames a second (`fps`), and the rate that they were resampled from, Hz (`resampled_from_hz`; `None` if they came evenly).
    ///
    /// Raises `Error` for a folder that is there, or cannot be written.
    #[pyo3(signature = (folder, *, how_made=""))]
    fn save_lerobot<'py>(
        &self,
        py: Python<'py>,
        folder: PathBuf,
        how_made: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let written = py.detach(|| self.recording.write_lerobot(&folder, how_made));
        to_python(py, &written.or_raise(py)?)
    }

    /// What the sensor does, as far as the presses tell: sensitivity, noise, hysteresis and more, as `twintac characterize --json` says it.
    /// With a folder, the report and the data sheet are written into it. Figures that the presses do not show have the reason in their place. Ctrl-C ends the wait.
    ///
    /// Raises `Error` for a sensor whose taxels are not those of the recording.
    #[pyo3(signature = (sensor, folder=None))]
    fn characterize<'py>(
        &self,
        py: Python<'py>,
        sensor: &Sensor,
        folder: Option<PathBuf>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let sensor = sensor.sensor.clone();
        let recorded = Recorded::from(self.recording.clone());
        let found = long_call(py, move || {
            let sensor = &sensor.file().sensor;
            let found = recorded.characterize(sensor)?;
            if let Some(folder) = folder {
                recorded.write(&found, sensor, &folder)?;
            }
            Ok::<_, twintac::WorkError>(found)
        })?;
        to_python(py, &found.or_raise(py)?)
    }

    /// Draws one press, counted from 0, over time: readings that are usable, force and height of the indenter.
    ///
    /// With Matplotlib; its three axes are returned, to be restyled: new ones, or those given. Raises `ModuleNotFoundError` without it, and `Error` for a press that is not there or another number of axes.
    #[pyo3(signature = (press=None, axes=None), text_signature = "($self, press=0, axes=None)")]
    fn plot<'py>(
        result: &Bound<'py, Self>,
        press: Option<Bound<'py, PyAny>>,
        axes: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        plot(result.py(), "recording", (result, press, axes))
    }

    /// What a pickle keeps.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __len__(&self) -> usize {
        self.recording.presses.len()
    }

    fn __repr__(&self) -> String {
        let (sensor, provenance) = (self.sensor(), &self.recording.provenance);
        format!(
            "<Recording of {} presses of {sensor:?}, {provenance}>",
            self.__len__()
        )
    }
}

impl Kept for Recording {
    type State = (twintac::Recording, ImportSummary);

    fn state(&self, _: Python<'_>) -> PyResult<Self::State> {
        Ok((self.recording.clone(), self.imported.clone()))
    }

    fn restored(_: Python<'_>, (recording, imported): Self::State) -> PyResult<Self> {
        Ok(Self { recording, imported })
    }
}

impl Recording {
    fn column<'py>(&self, py: Python<'py>, column: Column) -> PyResult<Bound<'py, PyAny>> {
        Ok(match column {
            Column::Index(numbers) => PyArray1::from_vec(py, numbers).into_any(),
            Column::Number(numbers) => PyArray1::from_vec(py, numbers).into_any(),
            Column::Flag(flags) => PyArray1::from_vec(py, flags).into_any(),
            Column::Known(numbers) => {
                let numbers = numbers.into_iter().map(|number| number.unwrap_or(f64::NAN));
                PyArray1::from_iter(py, numbers).into_any()
            }
            Column::Text(texts) => {
                let n_frames = self.recording.presses.iter().map(|press| press.time_s.len());
                let numpy = py.import("numpy")?;
                let texts = numpy.call_method1("array", (PyList::new(py, texts)?, "object"))?;
                numpy.call_method1("repeat", (texts, n_frames.collect::<Vec<_>>()))?
            }
        })
    }
}
