//! A sensor that is being read.

use std::path::Path;
use std::time::Duration;

use twintac_live::{Live, Origin, Tare, Taring};
use twintac_recording::Provenance;
use twintac_source::Known;

use crate::{Error, Sensor};

/// How long to wait for a frame at a time.
const PATIENCE: Duration = Duration::from_secs(2);

/// Reads a sensor frame by frame: on an I²C bus of Linux, a serial line, from datagrams, a log, or emulated.
#[derive(Debug)]
pub struct Reader {
    live: Live,
    tare: Tare,
}

/// A frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Its number, from 0, of all that were asked of the sensor: numbers that are missing were missed, or the bus gave none. The first frames made the tare.
    pub sequence: u64,
    /// When the taxels were triggered, s since the sensor was switched on.
    pub time_s: f64,
    /// Readings above what the taxels read untouched, kPa; `[n_taxels]`, `None` of a taxel that gives no usable one.
    pub readings_kpa: Vec<Option<f64>>,
    /// Why a taxel's reading cannot be used, in a word or two; `[n_taxels]`, `None` of a taxel that works.
    pub faults: Vec<Option<&'static str>>,
    /// Temperatures of the barometers, °C; `[n_taxels]`, `None` of one that gives none.
    pub temperatures_c: Vec<Option<f64>>,
}

impl Reader {
    /// Reads the sensor on `/dev/i2c-N`, which nothing may touch meanwhile: the first frames make the tare. `counts_per_pa` is the scale of
    /// barometers that do not say it themselves, confirmed by who knows the parts; without it, the description's counts.
    ///
    /// # Errors
    /// A bus that cannot be opened; a sensor that does not answer, does not read free air, or whose scale nobody has confirmed.
    pub fn open(bus: impl AsRef<Path>, sensor: &Sensor, counts_per_pa: Option<u16>) -> Result<Self, Error> {
        let known = Known {
            counts_per_pa,
            altitude_m: None,
        };
        Self::from(&Origin::Bus(bus.as_ref().to_owned()), sensor, &known)
    }

    /// Reads the frames that a microcontroller writes to a serial port, as a file describes them (TOML). Nothing may touch the sensor meanwhile: the
    /// first frames make the tare.
    ///
    /// # Errors
    /// A port that cannot be opened; a description that is wrong, or of another number of taxels; a line on which no frame comes.
    pub fn serial(port: &str, line: impl AsRef<Path>, sensor: &Sensor) -> Result<Self, Error> {
        let (port, line) = (port.to_owned(), line.as_ref().to_owned());
        Self::from(&Origin::Serial { port, line }, sensor, &Known::default())
    }

    /// Reads frames that come as datagrams to an address of this computer, such as `0.0.0.0:9000`, as a file describes them (TOML).
    ///
    /// # Errors
    /// As [`serial`](Self::serial).
    pub fn udp(address: &str, line: impl AsRef<Path>, sensor: &Sensor) -> Result<Self, Error> {
        let (address, line) = (address.to_owned(), line.as_ref().to_owned());
        Self::from(&Origin::Udp { address, line }, sensor, &Known::default())
    }

    /// Plays the frames of a log (MCAP) at their own pace.
    ///
    /// # Errors
    /// A log that cannot be read, has no frames, or is of other taxels.
    pub fn replay(log: impl AsRef<Path>, sensor: &Sensor) -> Result<Self, Error> {
        Self::from(&Origin::Log(log.as_ref().to_owned()), sensor, &Known::default())
    }

    /// Reads an emulated sensor in real time: registers on an emulated bus, pressed by a ball that wanders about.
    ///
    /// # Errors
    /// A sensor that is not read this way.
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

    /// Takes off readings what temperature does to the zeros, as a file says (TOML) that `twintac characterize` made. Nothing may touch the sensor meanwhile:
    /// the next frames make a new tare.
    ///
    /// # Errors
    /// A file that is wrong, or of another sensor; those of [`read`](Self::read).
    pub fn compensate(&mut self, temperature: impl AsRef<Path>) -> Result<(), Error> {
        self.live.compensate(temperature.as_ref())?;
        self.tare = tare(&mut self.live)?;
        Ok(())
    }

    /// How much warmer than at the tare the chip is that changed most, K; below zero if it is colder; `None` without temperatures. Zeros move with it.
    #[must_use]
    pub fn warmer_k(&self) -> Option<f64> {
        self.tare.warmer_k()
    }

    /// Where the readings come from: `real` or `emulated`.
    #[must_use]
    pub fn provenance(&self) -> Provenance {
        self.live.about.provenance
    }

    /// What was odd when the sensor was switched on, a sentence each.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.live.notes
    }

    /// What was on the wire so far besides frames, and how often: torn lines, missing frames.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        self.live.source.tally().remarks
    }

    /// The next frame. Up to 256 wait for whom is late; more are missed.
    ///
    /// # Errors
    /// A sensor that has failed for 2 s on end or was silent for 3 s.
    pub fn read(&mut self) -> Result<Reading, Error> {
        loop {
            if let Some(reading) = self.wait(PATIENCE)? {
                return Ok(reading);
            }
        }
    }

    /// The next frame, or `None` if none comes for so long.
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

/// What the taxels of a sensor read untouched: of its next frames.
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
