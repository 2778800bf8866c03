//! Reads a sensor.

use std::path::Path;
use std::time::Duration;

use twintac_live::{Live, Origin, Tare, Taring};
use twintac_recording::Provenance;
use twintac_source::Known;

use crate::{Error, Sensor};

/// How long one call waits for a frame.
const PATIENCE: Duration = Duration::from_secs(2);

/// Reads a sensor frame by frame: on an I²C bus of Linux, on a serial line, from datagrams, from a
/// log, or emulated.
#[derive(Debug)]
pub struct Reader {
    live: Live,
    tare: Tare,
}

/// A frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Its number, from 0, counting all frames that were requested from the sensor. Missing numbers
    /// are frames that were missed or that the bus did not deliver. The first frames were used for
    /// the tare.
    pub sequence: u64,
    /// Time at which the taxels were triggered, s since the sensor was switched on.
    pub time_s: f64,
    /// Readings above the untouched sensor, kPa; `[n_taxels]`, `None` for a taxel without a usable
    /// reading.
    pub readings_kpa: Vec<Option<f64>>,
    /// Why a taxel's reading cannot be used, in a word or two; `[n_taxels]`, `None` for a taxel
    /// that works.
    pub faults: Vec<Option<&'static str>>,
    /// Temperatures of the barometers, °C; `[n_taxels]`, `None` for one without a temperature.
    pub temperatures_c: Vec<Option<f64>>,
}

impl Reader {
    /// Reads the sensor on `/dev/i2c-N`. Nothing may touch it at the start: the first frames make
    /// the tare. `counts_per_pa` is the scale of barometers that do not state it themselves,
    /// confirmed by a person who knows the parts; the default is the scale of the description.
    ///
    /// # Errors
    /// A bus that cannot be opened; a sensor that does not answer, that does not read the pressure
    /// of free air, or whose scale nobody has confirmed.
    pub fn open(bus: impl AsRef<Path>, sensor: &Sensor, counts_per_pa: Option<u16>) -> Result<Self, Error> {
        let known = Known {
            counts_per_pa,
            altitude_m: None,
        };
        Self::from(&Origin::Bus(bus.as_ref().to_owned()), sensor, &known)
    }

    /// Reads the frames that a microcontroller writes to a serial port. The file `line` describes
    /// them (TOML). Nothing may touch the sensor at the start: the first frames make the tare.
    ///
    /// # Errors
    /// A port that cannot be opened; a description that is wrong, or of another number of taxels; a
    /// line without frames.
    pub fn serial(port: &str, line: impl AsRef<Path>, sensor: &Sensor) -> Result<Self, Error> {
        let (port, line) = (port.to_owned(), line.as_ref().to_owned());
        Self::from(&Origin::Serial { port, line }, sensor, &Known::default())
    }

    /// Reads frames from datagrams to an address of this computer, such as `0.0.0.0:9000`. The file
    /// `line` describes them (TOML).
    ///
    /// # Errors
    /// As [`serial`](Self::serial).
    pub fn udp(address: &str, line: impl AsRef<Path>, sensor: &Sensor) -> Result<Self, Error> {
        let (address, line) = (address.to_owned(), line.as_ref().to_owned());
        Self::from(&Origin::Udp { address, line }, sensor, &Known::default())
    }

    /// Replays the frames of a log (MCAP) at their own pace.
    ///
    /// # Errors
    /// A log that cannot be read, has no frames, or is of other taxels.
    pub fn replay(log: impl AsRef<Path>, sensor: &Sensor) -> Result<Self, Error> {
        Self::from(&Origin::Log(log.as_ref().to_owned()), sensor, &Known::default())
    }

    /// Reads an emulated sensor in real time: registers on an emulated bus, pressed by a ball that
    /// wanders about.
    ///
    /// # Errors
    /// A sensor that is not read over a bus.
    pub fn emulated(sensor: &Sensor) -> Result<Self, Error> {
        Self::from(&Origin::Emulated, sensor, &Known::default())
    }

    fn from(origin: &Origin, sensor: &Sensor, known: &Known) -> Result<Self, Error> {
        let file = sensor.file();
        Self::of(Live::open(origin, &file.sensor, &file.text, known)?)
    }

    fn of(mut live: Live) -> Result<Self, Error> {
        let tare = tare(&mut live)?;
        Ok(Self { live, tare })
    }

    /// Compensates readings for the drift of their zeros with temperature, by a file (TOML) that
    /// `twintac characterize` made. Nothing may touch the sensor during the call: the next frames
    /// make a new tare.
    ///
    /// # Errors
    /// A file that is wrong, or of another sensor; those of [`read`](Self::read).
    pub fn compensate(&mut self, temperature: impl AsRef<Path>) -> Result<(), Error> {
        self.live.compensate(temperature.as_ref())?;
        self.tare = tare(&mut self.live)?;
        Ok(())
    }

    /// Temperature change since the tare of the chip that changed most, K; negative if it is
    /// colder; `None` without temperatures. Zeros drift with temperature.
    #[must_use]
    pub fn warmer_k(&self) -> Option<f64> {
        self.tare.warmer_k()
    }

    /// Provenance of the readings: `real` or `emulated`.
    #[must_use]
    pub fn provenance(&self) -> Provenance {
        self.live.about.provenance
    }

    /// Remarks from when the sensor was switched on, one sentence each.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.live.notes
    }

    /// Remarks about what was received besides frames, with counts: incomplete lines, missing
    /// frames.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        self.live.source.tally().remarks
    }

    /// The next frame. Up to 256 frames wait for a slow caller; beyond that frames are missed.
    ///
    /// # Errors
    /// A sensor that has failed for 2 s without a break, or was silent for 3 s.
    pub fn read(&mut self) -> Result<Reading, Error> {
        loop {
            if let Some(reading) = self.wait(PATIENCE)? {
                return Ok(reading);
            }
        }
    }

    /// The next frame, or `None` if none comes within `patience`.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn wait(&mut self, patience: Duration) -> Result<Option<Reading>, Error> {
        let next = self
            .live
            .source
            .next(patience)
            .map_err(twintac_live::LiveError::from)?;
        let Some(reading) = next else {
            return Ok(None);
        };
        let readings_kpa = self.tare.above_kpa(&reading);
        let taxels = &reading.frame.taxels;
        Ok(Some(Reading {
            sequence: reading.sequence,
            time_s: reading.bench_s,
            readings_kpa,
            faults: taxels.iter().map(|taxel| taxel.state.fault()).collect(),
            temperatures_c: taxels.iter().map(|taxel| taxel.temperature_c).collect(),
        }))
    }
}

/// Measures the untouched readings of a sensor from its next frames.
fn tare(live: &mut Live) -> Result<Tare, Error> {
    let mut taring = Taring::new(live.about.kpa_per_k.clone());
    loop {
        let next = live
            .source
            .next(PATIENCE)
            .map_err(twintac_live::LiveError::from)?;
        if let Some(reading) = next
            && let Some(tare) = taring.push(&reading)
        {
            return Ok(tare);
        }
    }
}
