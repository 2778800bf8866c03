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

/// Provenance of numbers: `"real"`, `"emulated"` or `"simulated"`.
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

/// Recorded presses of one sensor: a real or an emulated one, or simulated presses. `len()` is the
/// number of presses.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Recording {
    pub(crate) recording: twintac::Recording,
    /// What was found in CSV files and left out of them; empty for other sources.
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
    /// Reads a Parquet file that a run or `save` wrote. Ctrl-C ends the wait.
    ///
    /// Raises `Error` with the file if it is not a recording, is damaged, or cannot be read.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let recording = long_call(py, move || twintac::Recording::read_parquet(&path))?.or_raise(py)?;
        Ok(recording.into())
    }

    /// Reads CSV files of any laboratory. Ctrl-C ends the wait.
    ///
    /// - `description`: path of the import description (TOML, see the folder `imports`), which says
    ///   what each column means, and its unit.
    /// - `paths`: paths of the CSV files.
    ///
    /// Raises `Error` with file, line and field: of the import description, or of the cell that
    /// cannot be read.
    #[staticmethod]
    #[pyo3(signature = (description, *paths))]
    fn import_csv(py: Python<'_>, description: PathBuf, paths: Vec<PathBuf>) -> PyResult<Self> {
        let (recording, imported) =
            long_call(py, move || import_files(&description, &paths))?.or_raise(py)?;
        Ok(Self { recording, imported })
    }

    /// Guesses an import description of a CSV file, for `import_csv`.
    ///
    /// - `path`: path of the CSV file.
    ///
    /// Returns the text of a TOML file, with a comment on each guess.
    ///
    /// Raises `Error` with the file if it cannot be read or has no rows of numbers.
    #[staticmethod]
    fn guess_import(path: PathBuf, py: Python<'_>) -> PyResult<String> {
        guess_import(&path).or_raise(py)
    }

    /// What `import_csv` found in each file and left out of it: for each file a dict with `file`,
    /// `rows_read`, `rows_dropped`, `rows_incomplete`, `missing_readings`, `clipped_readings`,
    /// `outliers`, `presses`, `presses_dropped`, `shared_frames`, `unread_columns`, `warnings`.
    /// Empty for other recordings.
    #[getter]
    fn imported<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.imported.files)
    }

    /// Name of the sensor in its description.
    #[getter]
    fn sensor(&self) -> &str {
        &self.recording.sensor
    }

    /// Provenance of the numbers: `"real"`, `"emulated"` or `"simulated"`.
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

    /// The columns of the Parquet file as NumPy arrays, by name, with a value for each frame:
    ///
    /// - `press_index`, `press`, `mounting`, `indenter`, `control`, `provenance`: properties of the
    ///   press, the same in all its frames. `mounting` is the installation of the indenter.
    /// - `time_s`: time, s.
    /// - `x_mm`, `y_mm`, `z_mm`, `qx`, `qy`, `qz`, `qw`: pose of the indenter in the gel's frame:
    ///   position, mm, and quaternion.
    /// - `force_n`: force into the gel, N; NaN if it is not known.
    /// - `<taxel>_kpa`, `<taxel>_raw`, `<taxel>_valid`: reading of the taxel, kPa; the reading as
    ///   it was recorded; whether it is usable. A missing reading is NaN.
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

    /// The columns as a `polars.DataFrame`, through Arrow. `polars.DataFrame(recording)` does the
    /// same.
    fn to_polars<'py>(recording: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let polars = recording.py().import("polars")?;
        polars.call_method1("DataFrame", (recording,))
    }

    /// The columns for any library that reads Arrow through its PyCapsule interface:
    /// `polars.DataFrame(recording)`, `pyarrow.table(recording)`,
    /// `pandas.DataFrame.from_arrow(recording)`, or DuckDB. Types are those of `columns`. Texts are
    /// strings. An unknown force and a missing reading are null. The schema is always this one;
    /// `requested_schema` is ignored.
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

    /// Writes a Parquet file. The file appears whole or not at all.
    ///
    /// Raises `Error` with the file if it cannot be written.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.recording.write_parquet(&path)).or_raise(py)
    }

    /// Writes a LeRobot data set, version 3.0: presses are episodes, indenters are tasks.
    ///
    /// - `folder`: path of a folder that does not exist yet.
    /// - `how_made`: text for the data card that says how the data were made.
    ///
    /// Returns the numbers of episodes, frames and tasks (`episodes`, `frames`, `tasks`), the
    /// frames per second (`fps`), and the rate from which frames were resampled, Hz
    /// (`resampled_from_hz`; `None` if they were evenly spaced).
    ///
    /// Raises `Error` for a folder that exists or cannot be written.
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

    /// Characterizes the sensor from the presses: sensitivity, noise, hysteresis and other figures.
    /// Ctrl-C ends the wait.
    ///
    /// - `sensor`: the sensor.
    /// - `folder`: folder for the report and the data sheet; without it, they are not written.
    ///
    /// Returns the figures as `twintac characterize --json` prints them. A figure that the presses
    /// do not show is replaced by the reason.
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

    /// Draws one press over time with Matplotlib: usable readings, force and height of the
    /// indenter.
    ///
    /// - `press`: index of the press, from 0.
    /// - `axes`: three axes to draw in; new ones unless given.
    ///
    /// Returns the axes, so that they can be restyled. Raises `ModuleNotFoundError` without
    /// Matplotlib, and `Error` for a press that does not exist or another number of axes.
    #[pyo3(signature = (press=None, axes=None), text_signature = "($self, press=0, axes=None)")]
    fn plot<'py>(
        result: &Bound<'py, Self>,
        press: Option<Bound<'py, PyAny>>,
        axes: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        plot(result.py(), "recording", (result, press, axes))
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
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
