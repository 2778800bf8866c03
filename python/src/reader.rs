//! Reading a sensor.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use numpy::PyArray1;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::error::{OrRaise, unusable};
use crate::given::Given;
use crate::long_call::long_call;
use crate::pickle::{Kept, Reduced, reduced, refused};
use crate::sensor::Sensor;

/// Longest delay before Ctrl-C and `close` are handled.
const PATIENCE: Duration = Duration::from_millis(50);

/// Reads a sensor frame by frame: on an I²C bus of Linux (`Reader.open`), over a serial port
/// (`Reader.serial`), from UDP datagrams (`Reader.udp`), from a log (`Reader.replay`), or an
/// emulated sensor (`Reader.emulated`).
///
/// The sensor is read on a thread of its own until `close` or the end of a `with` block. Iteration
/// returns a `Reading` for each frame as it comes. Up to 256 frames wait for a slow caller; more
/// are missed. Other Python threads run during the wait for a frame, and Ctrl-C ends it.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Reader {
    /// `None` after it was closed.
    reader: Mutex<Option<twintac::Reader>>,
    /// The process whose thread reads. A forked process has no such thread.
    process: u32,
    /// Tells threads that wait for a frame to release the reader.
    is_closed: AtomicBool,
    provenance: String,
    taxels: Vec<String>,
    notes: Vec<String>,
}

impl Reader {
    fn start(
        py: Python<'_>,
        sensor: &Sensor,
        start: impl FnOnce(&twintac::Sensor) -> Result<twintac::Reader, twintac::Error> + Send + 'static,
    ) -> PyResult<Self> {
        let sensor = sensor.sensor.clone();
        let taxels = sensor.taxels().map(str::to_owned).collect();
        let reader = long_call(py, move || start(&sensor))?.or_raise(py)?;
        Ok(Self {
            provenance: reader.provenance().to_string(),
            notes: reader.notes().to_vec(),
            taxels,
            reader: Mutex::new(Some(reader)),
            process: std::process::id(),
            is_closed: AtomicBool::new(false),
        })
    }
}

#[pymethods]
impl Reader {
    /// Reads a sensor on an I²C bus. The call takes half a second; Ctrl-C ends the wait. Nothing
    /// may touch the sensor during the call, because the first frames make the tare.
    ///
    /// - `bus`: path of the bus, such as `/dev/i2c-1`.
    /// - `sensor`: the sensor.
    /// - `counts_per_pa`: scale of the barometers, counts per Pa, confirmed by a person who knows
    ///   the parts; that of the description unless given.
    ///
    /// Raises `Error` for a bus that cannot be opened, for a sensor that does not answer or does
    /// not read the pressure of free air, and for barometers whose scale nobody has confirmed.
    #[staticmethod]
    #[pyo3(signature = (bus, sensor, *, counts_per_pa=None))]
    fn open(
        py: Python<'_>,
        bus: PathBuf,
        sensor: &Sensor,
        counts_per_pa: Option<Given<'_>>,
    ) -> PyResult<Self> {
        let range = 1..=u16::MAX as usize;
        let counts_per_pa = counts_per_pa.map(|counts| counts.count("counts_per_pa", range));
        let counts_per_pa = counts_per_pa.transpose()?.map(|counts| counts as u16);
        Self::start(py, sensor, move |sensor| {
            twintac::Reader::open(bus, sensor, counts_per_pa)
        })
    }

    /// Reads the frames that a microcontroller writes to a serial port. Nothing may touch the
    /// sensor during the call, because the first frames make the tare.
    ///
    /// - `port`: name of the port, such as `/dev/ttyACM0` or `COM3`.
    /// - `line`: path of the line description (TOML), which says how to read the frames.
    /// - `sensor`: the sensor.
    ///
    /// Raises `Error` for a port that cannot be opened, for a line description that is wrong or of
    /// another number of taxels, and for a line on which no frame comes for 3 s. The message says
    /// what came instead.
    #[staticmethod]
    fn serial(py: Python<'_>, port: String, line: PathBuf, sensor: &Sensor) -> PyResult<Self> {
        Self::start(py, sensor, move |sensor| {
            twintac::Reader::serial(&port, line, sensor)
        })
    }

    /// Reads frames from datagrams (UDP).
    ///
    /// - `address`: an address of this computer, such as `"0.0.0.0:9000"`.
    /// - `line`: path of the line description (TOML), which says how to read the frames.
    /// - `sensor`: the sensor.
    ///
    /// Raises `Error` as `serial` does.
    #[staticmethod]
    fn udp(py: Python<'_>, address: String, line: PathBuf, sensor: &Sensor) -> PyResult<Self> {
        Self::start(py, sensor, move |sensor| {
            twintac::Reader::udp(&address, line, sensor)
        })
    }

    /// Replays the frames of a log (MCAP) at their own pace. Their provenance is that of the log:
    /// `"real"` or `"emulated"`. After the last frame `read` raises `Error`.
    ///
    /// - `log`: path of the log.
    /// - `sensor`: the sensor.
    ///
    /// Raises `Error` for a log that cannot be read, has no frames, or is of other taxels than
    /// those of the sensor.
    #[staticmethod]
    fn replay(py: Python<'_>, log: PathBuf, sensor: &Sensor) -> PyResult<Self> {
        Self::start(py, sensor, move |sensor| twintac::Reader::replay(log, sensor))
    }

    /// Reads an emulated sensor in real time: registers on an emulated bus, while a ball that
    /// wanders about presses the gel. The call takes half a second; Ctrl-C ends the wait.
    ///
    /// - `sensor`: the sensor.
    ///
    /// Raises `Error` for a sensor whose description does not say how its taxels are wired.
    #[staticmethod]
    fn emulated(py: Python<'_>, sensor: &Sensor) -> PyResult<Self> {
        Self::start(py, sensor, twintac::Reader::emulated)
    }

    /// Provenance of the readings: `"real"` or `"emulated"`.
    #[getter]
    fn provenance(&self) -> &str {
        &self.provenance
    }

    /// Names of the taxels, in the order of every reading.
    #[getter]
    fn taxels(&self) -> Vec<String> {
        self.taxels.clone()
    }

    /// Remarks from when the sensor was switched on, one sentence each.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// Remarks about what came on the connection so far besides frames, with counts: incomplete
    /// lines, missing frames. Empty if there was nothing else, and for a reader that is closed.
    fn remarks(&self, py: Python<'_>) -> Vec<String> {
        py.detach(|| {
            let reader = self.reader.lock().unwrap_or_else(PoisonError::into_inner);
            reader.as_ref().map(twintac::Reader::remarks).unwrap_or_default()
        })
    }

    /// Compensates the readings for the drift of the zeros with temperature. Nothing may touch the
    /// sensor during the call, because the next frames make a new tare.
    ///
    /// - `temperature`: path of a file (TOML) that `twintac characterize` made.
    ///
    /// Raises `Error` for a file that is wrong or of another sensor, and for a reader that is
    /// closed.
    fn compensate(&self, py: Python<'_>, temperature: PathBuf) -> PyResult<()> {
        let compensated = py.detach(|| {
            let mut reader = self.reader.lock().unwrap_or_else(PoisonError::into_inner);
            reader.as_mut().map(|reader| reader.compensate(temperature))
        });
        match compensated {
            Some(compensated) => compensated.or_raise(py),
            None => Err(unusable(py, "reader", "is closed")),
        }
    }

    /// Temperature change since the tare of the chip that changed most, K; negative if it is
    /// colder; `None` without temperatures, and for a reader that is closed. Zeros drift with
    /// temperature.
    fn warmer_k(&self, py: Python<'_>) -> Option<f64> {
        py.detach(|| {
            let reader = self.reader.lock().unwrap_or_else(PoisonError::into_inner);
            reader.as_ref().and_then(twintac::Reader::warmer_k)
        })
    }

    /// Waits for the next frame and returns it.
    ///
    /// Raises `Error` for a sensor that has failed for 2 s without a break or was silent for 3 s,
    /// and for a reader that is closed.
    fn read(&self, py: Python<'_>) -> PyResult<Reading> {
        self.next(py)?
            .ok_or_else(|| unusable(py, "reader", "is closed, or has played its last frame"))
    }

    /// Stops reading, within a second even if the bus hangs. A closed reader cannot read again.
    /// Closing it again does nothing.
    fn close(&self, py: Python<'_>) {
        self.is_closed.store(true, Ordering::Relaxed);
        if std::process::id() != self.process {
            return; // the reading thread belongs to the other process
        }
        py.detach(|| drop(self.reader.lock().unwrap_or_else(PoisonError::into_inner).take()));
    }

    fn __iter__(reader: Bound<'_, Self>) -> Bound<'_, Self> {
        reader
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Reading>> {
        self.next(py)
    }

    /// Returns the reader itself.
    fn __enter__(reader: Bound<'_, Self>) -> Bound<'_, Self> {
        reader
    }

    /// Closes the reader.
    #[pyo3(signature = (*_error))]
    fn __exit__(&self, py: Python<'_>, _error: &Bound<'_, pyo3::types::PyTuple>) {
        self.close(py);
    }

    /// Raises `TypeError`: a `Reader` cannot be pickled or copied.
    fn __reduce__(&self) -> PyResult<()> {
        refused(
            "Reader",
            "one process reads a sensor; give the others its readings, which can be pickled",
        )
    }

    fn __repr__(&self) -> String {
        format!("<Reader of {} taxels, {}>", self.taxels.len(), self.provenance)
    }
}

impl Reader {
    /// The next frame; `None` from a reader that is closed.
    fn next(&self, py: Python<'_>) -> PyResult<Option<Reading>> {
        if std::process::id() != self.process {
            let problem = "was opened by the process before this one was forked, and reads there: open one in this process";
            return Err(unusable(py, "reader", problem));
        }
        while !self.is_closed.load(Ordering::Relaxed) {
            let heard = py.detach(|| {
                let mut reader = self.reader.lock().unwrap_or_else(PoisonError::into_inner);
                Some(reader.as_mut()?.wait(PATIENCE))
            });
            match heard {
                None => return Ok(None),
                Some(Err(error)) if error.is_over() => return Ok(None),
                Some(frame) => {
                    if let Some(reading) = frame.or_raise(py)? {
                        let provenance = self.provenance.clone();
                        return Ok(Some(Reading::of(reading, provenance)));
                    }
                }
            }
            py.check_signals()?;
        }
        Ok(None)
    }
}

/// A frame of a sensor: the result of `Reader.read`.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Reading {
    frame: Frame,
    /// Provenance of the readings: `"real"` or `"emulated"`.
    #[pyo3(get)]
    provenance: String,
}

/// The content of a frame.
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Frame {
    sequence: u64,
    time_s: f64,
    /// `[n_taxels]`, like the other lists.
    readings_kpa: Vec<Option<f64>>,
    faults: Vec<Option<String>>,
    temperatures_c: Vec<Option<f64>>,
}

impl Reading {
    fn of(reading: twintac::Reading, provenance: String) -> Self {
        let faults = reading.faults.into_iter();
        let frame = Frame {
            sequence: reading.sequence,
            time_s: reading.time_s,
            readings_kpa: reading.readings_kpa,
            faults: faults.map(|fault| fault.map(str::to_owned)).collect(),
            temperatures_c: reading.temperatures_c,
        };
        Self { frame, provenance }
    }
}

impl Kept for Reading {
    type State = (Frame, String);

    fn state(&self, _: Python<'_>) -> PyResult<Self::State> {
        Ok((self.frame.clone(), self.provenance.clone()))
    }

    fn restored(_: Python<'_>, (frame, provenance): Self::State) -> PyResult<Self> {
        Ok(Self { frame, provenance })
    }
}

#[pymethods]
impl Reading {
    /// Number of the frame, from 0, among all frames that were requested from the sensor. Missing
    /// numbers are frames that were missed or that the bus did not deliver. The first frames made
    /// the tare.
    #[getter]
    fn sequence(&self) -> u64 {
        self.frame.sequence
    }

    /// Time at which the taxels were triggered, s since the sensor was switched on.
    #[getter]
    fn time_s(&self) -> f64 {
        self.frame.time_s
    }

    /// Readings above those of the untouched sensor, kPa; `[n_taxels]`. NaN for a taxel without a
    /// usable reading.
    #[getter]
    fn readings_kpa<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        or_nan(py, &self.frame.readings_kpa)
    }

    /// Whether each taxel's reading is usable; `[n_taxels]`.
    #[getter]
    fn is_valid<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        PyArray1::from_iter(py, self.frame.readings_kpa.iter().map(Option::is_some))
    }

    /// Why a taxel's reading is not usable, in a word or two; `[n_taxels]`. `None` for a taxel that
    /// works.
    #[getter]
    fn faults(&self) -> Vec<Option<String>> {
        self.frame.faults.clone()
    }

    /// Temperatures of the barometers, °C; `[n_taxels]`. NaN for one without a temperature.
    #[getter]
    fn temperatures_c<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        or_nan(py, &self.frame.temperatures_c)
    }

    /// Supports `pickle` and `copy`: returns the function that restores the object, and its state.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!(
            "<Reading {} at {:.3} s, {}>",
            self.sequence(),
            self.time_s(),
            self.provenance
        )
    }
}

fn or_nan<'py>(py: Python<'py>, numbers: &[Option<f64>]) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_iter(py, numbers.iter().map(|number| number.unwrap_or(f64::NAN)))
}
