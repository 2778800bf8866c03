//! Opens a sensor: switches it on, checks it and reads it.

use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use phystac::PhysTac;
use twintac_emulate::LabClock;
use twintac_recording::Provenance;
use twintac_sensor::Sensor;
use twintac_source::{
    BoxedClock, FrameReader, FrameSource, Known, LineSource, ReplaySource, SourceError, TAXELS, power_on,
};
use twintac_temperature::Compensation;

use crate::{About, LiveError, emulated_phystac};

/// The origin of a sensor's frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The emulated sensor of the description, in real time.
    Emulated,
    /// An I²C bus of Linux, `/dev/i2c-N`.
    Bus(PathBuf),
    /// A serial port, and the file that describes its frames.
    Serial {
        /// `/dev/ttyACM0`, `COM3`.
        port: String,
        /// The TOML file that describes frames on the line.
        line: PathBuf,
    },
    /// Datagrams that arrive at a port of this computer, and the file that describes them.
    Udp {
        /// Where to listen, such as `0.0.0.0:9000`.
        address: String,
        /// The TOML file that describes frames in them.
        line: PathBuf,
    },
    /// A log, played at the pace of its recording.
    Log(PathBuf),
}

/// A sensor that is being read.
#[derive(Debug)]
pub struct Live {
    /// Its frames.
    pub source: FrameSource,
    /// Its description.
    pub about: About,
    /// Observations when it was switched on, one sentence each.
    pub notes: Vec<String>,
}

impl Live {
    /// Opens a sensor from any origin. `sensor_toml` is the text of its description. Emulated
    /// barometers have the scale of [`emulated_board`](crate::emulated_board), which nobody needs
    /// to confirm.
    ///
    /// # Errors
    /// A port or bus that cannot be opened; a sensor that cannot be read by this driver, does not
    /// answer, or does not read free air.
    pub fn open(
        origin: &Origin,
        sensor: &Sensor,
        sensor_toml: &str,
        known: &Known,
    ) -> Result<Self, LiveError> {
        let start_unix_ns = unix_ns();
        let about = |provenance| About::new(sensor, sensor_toml, provenance, None, start_unix_ns);
        match origin {
            Origin::Emulated => {
                let phystac = emulated_phystac(sensor, LabClock::real(), &[])?;
                let known = known.or_emulated(sensor);
                Self::on_bus(phystac, sensor, &known, about(Provenance::Emulated))
            }
            #[cfg(target_os = "linux")]
            Origin::Bus(path) => {
                let settings = twintac_source::driver_settings(sensor)?;
                let phystac = twintac_source::open_linux(path, settings, clock())?;
                Self::on_bus(phystac, sensor, known, about(Provenance::Real))
            }
            #[cfg(not(target_os = "linux"))]
            Origin::Bus(path) => Err(not_opened(
                &path.display().to_string(),
                "buses are opened on Linux only",
            )),
            Origin::Serial { port, line } => {
                let source = LineSource::serial(port, line, sensor.taxels.len(), clock())?;
                Self::of(source, about(Provenance::Real), Vec::new())
            }
            Origin::Udp { address, line } => {
                let source = LineSource::udp(address, line, sensor.taxels.len(), clock())?;
                Self::of(source, about(Provenance::Real), Vec::new())
            }
            Origin::Log(path) => {
                let source = ReplaySource::open(path, true)?;
                let log = source.description();
                if log.taxels != about(log.provenance).taxels {
                    let problem = format!(
                        "its taxels {} are not those of sensor {}",
                        log.taxels.join(", "),
                        sensor.name
                    );
                    return Err(not_opened(&path.display().to_string(), &problem));
                }
                let about = about(log.provenance);
                Self::of(source, about, Vec::new())
            }
        }
    }

    /// Subtracts the change of the zeros with temperature from readings, for tares that are taken
    /// from now on. `file` has the coefficients (TOML).
    ///
    /// # Errors
    /// A file that cannot be read, is wrong, is of another sensor or lacks a taxel. Then nothing is
    /// changed.
    pub fn compensate(&mut self, file: &Path) -> Result<(), LiveError> {
        let about = &mut self.about;
        let coefficients = Compensation::read(file)?.coefficients(&about.sensor, &about.taxels);
        about.kpa_per_k = coefficients.map_err(|problem| LiveError::OtherCompensation {
            file: file.display().to_string(),
            problem,
        })?;
        Ok(())
    }

    fn on_bus<I2C: I2c + Send + 'static, D: DelayNs + Send + 'static>(
        mut phystac: PhysTac<I2C, D, BoxedClock, TAXELS>,
        sensor: &Sensor,
        known: &Known,
        about: About,
    ) -> Result<Self, LiveError> {
        let checked = power_on(&mut phystac, sensor, known)?;
        let about = About {
            transfer: checked.transfer,
            ..about
        };
        Self::of(FrameReader::new(phystac, &checked), about, checked.notes)
    }

    fn of(
        source: impl twintac_source::TactileSource + 'static,
        about: About,
        notes: Vec<String>,
    ) -> Result<Self, LiveError> {
        Ok(Self {
            source: FrameSource::start(source, FrameSource::USUAL_CAPACITY)?,
            about,
            notes,
        })
    }
}

fn not_opened(wire: &str, problem: &str) -> LiveError {
    let (wire, problem) = (wire.to_owned(), problem.to_owned());
    SourceError::Open { wire, problem }.into()
}

/// A clock that begins now.
fn clock() -> BoxedClock {
    let start = Instant::now();
    Box::new(move || start.elapsed().as_micros() as u64) // 584 thousand years
}

/// Wall-clock time, ns since 1970-01-01 UTC. 0 on a computer whose clock is before that.
fn unix_ns() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    since.as_nanos() as u64 // overflows after the year 2554
}
