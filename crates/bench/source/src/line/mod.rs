//! Frames from a line that a microcontroller writes.

mod device_clock;
mod serial;
mod udp;
mod wire;

use device_clock::DeviceClock;
pub use serial::SerialLine;
pub use wire::Wire;

use std::collections::VecDeque;
use std::fmt;
use std::io::ErrorKind;
use std::net::UdpSocket;
use std::path::Path;
use std::time::{Duration, Instant};

use twintac_line::{Decoder, Description, Heard, LineFrame, Tally};
use twintac_log::{TactileFrame, TaxelReading, TaxelState};

use crate::{BoxedClock, Reading, SourceError, TactileSource};

/// Reads frames as a [`Description`] describes them, from any connection.
pub struct LineSource {
    wire: Box<dyn Wire>,
    decoder: Decoder,
    clock: BoxedClock,
    device_clock: DeviceClock,
    /// The number of the next frame, for a line that has no numbers.
    next_sequence: u64,
    waiting: VecDeque<Reading>,
    is_over: bool,
    bytes: Vec<u8>,
}

impl LineSource {
    /// Reads a line of a sensor with `n_taxels` taxels. `clock` is the bench clock, µs.
    ///
    /// # Errors
    /// Fails if the description has another number of pressures.
    pub fn new(
        wire: impl Wire + 'static,
        description: &Description,
        n_taxels: usize,
        clock: BoxedClock,
    ) -> Result<Self, SourceError> {
        check(description, n_taxels)?;
        Ok(Self {
            wire: Box::new(wire),
            decoder: Decoder::new(description, n_taxels),
            clock,
            device_clock: DeviceClock::default(),
            next_sequence: 0,
            waiting: VecDeque::new(),
            is_over: false,
            bytes: vec![0; 1 << 16],
        })
    }

    /// Reads a serial port. The TOML file `line` describes what arrives there.
    ///
    /// # Errors
    /// A file that is wrong or has another number of taxels; a port that cannot be opened.
    pub fn serial(port: &str, line: &Path, n_taxels: usize, clock: BoxedClock) -> Result<Self, SourceError> {
        let description = Description::read(line)?;
        check(&description, n_taxels)?;
        Self::new(
            SerialLine::open(port, &description)?,
            &description,
            n_taxels,
            clock,
        )
    }

    /// Reads datagrams that arrive at an address of this computer. The TOML file `line` describes
    /// them.
    ///
    /// # Errors
    /// A file that is wrong or has another number of taxels; an address that cannot be bound.
    pub fn udp(address: &str, line: &Path, n_taxels: usize, clock: BoxedClock) -> Result<Self, SourceError> {
        let description = Description::read(line)?;
        let socket = UdpSocket::bind(address).map_err(|error| SourceError::Open {
            wire: address.to_owned(),
            problem: error.to_string(),
        })?;
        Self::new(socket, &description, n_taxels, clock)
    }

    /// Counts of what was on the line so far.
    #[must_use]
    pub fn tally(&self) -> Tally {
        self.decoder.tally()
    }

    /// Decodes the `n` bytes that have arrived.
    fn take(&mut self, n: usize) {
        let arrived_us = (self.clock)();
        let mut frames = Vec::new();
        let restarts = self.decoder.tally().restarts;
        self.decoder.push(&self.bytes[..n], &mut |heard| {
            if let Heard::Frame(frame) = heard {
                frames.push(frame);
            }
        });
        if self.decoder.tally().restarts != restarts {
            self.device_clock = DeviceClock::default();
        }
        for frame in frames {
            let reading = self.reading(frame, arrived_us);
            self.waiting.push_back(reading);
        }
    }

    fn reading(&mut self, frame: LineFrame, arrived_us: u64) -> Reading {
        let arrived_s = arrived_us as f64 * 1e-6;
        let bench_s = frame
            .time_s
            .map_or(arrived_s, |time_s| self.device_clock.bench_s(time_s, arrived_s));
        let sequence = self.next_sequence + frame.lost_before;
        self.next_sequence = sequence + 1;
        let numbers = frame.pressures_kpa.iter().zip(&frame.temperatures_c);
        let taxels = numbers.zip(&frame.faults);
        Reading {
            sequence,
            bench_s,
            frame: TactileFrame {
                triggered_us: (bench_s * 1e6).round().max(0.0) as u64,
                taxels: taxels
                    .map(|((pressure_kpa, temperature_c), fault)| TaxelReading {
                        state: state(*pressure_kpa, *fault),
                        read_us: arrived_us,
                        counts: None,
                        pressure_pa: pressure_kpa.map(|kpa| 1e3 * kpa),
                        temperature_c: *temperature_c,
                    })
                    .collect(),
            },
        }
    }
}

/// Why a taxel has no pressure: the fault that the line reports if it is a known one, else missing.
fn state(pressure_kpa: Option<f64>, fault: Option<u8>) -> TaxelState {
    let known = fault
        .and_then(TaxelState::from_code)
        .filter(|state| *state != TaxelState::Good);
    match pressure_kpa {
        Some(_) => TaxelState::Good,
        None => known.unwrap_or(TaxelState::Missing),
    }
}

/// Checks that frames have one pressure for each taxel.
fn check(description: &Description, n_taxels: usize) -> Result<(), SourceError> {
    let n_pressures = description.n_pressures();
    if n_pressures == n_taxels {
        return Ok(());
    }
    Err(SourceError::Taxels {
        n_taxels,
        n_pressures,
    })
}

impl TactileSource for LineSource {
    fn next_frame(&mut self, patience: Duration) -> Result<Option<Reading>, SourceError> {
        let end = Instant::now() + patience;
        loop {
            if let Some(reading) = self.waiting.pop_front() {
                return Ok(Some(reading));
            }
            let left = end.saturating_duration_since(Instant::now());
            if left.is_zero() || self.is_over {
                return Ok(None);
            }
            match self.wire.read(&mut self.bytes, left) {
                Ok(n) => self.take(n),
                Err(error) if error.kind() == ErrorKind::UnexpectedEof => self.is_over = true,
                Err(error) => {
                    return Err(SourceError::Wire {
                        problem: error.to_string(),
                    });
                }
            }
        }
    }

    fn remarks(&self) -> Vec<String> {
        self.tally().remarks()
    }

    fn is_over(&self) -> bool {
        self.is_over && self.waiting.is_empty()
    }
}

impl fmt::Debug for LineSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LineSource")
            .field("tally", &self.tally())
            .finish_non_exhaustive()
    }
}
