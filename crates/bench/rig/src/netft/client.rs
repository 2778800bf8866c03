//! Streams records from a sensor.

use std::io::ErrorKind;
use std::net::{ToSocketAddrs, UdpSocket};
use std::time::{Duration, Instant};

use super::{Command, Configuration, Health, Record, Request, decode_records, page};
use crate::{Device, RigError, Wrench};

/// Requests are never acknowledged: one that shows no effect is sent again.
#[derive(Clone, Copy, Debug)]
struct Patience {
    /// Most times that a request is sent.
    most_tries: u32,
    /// Longest time from a request to start to the first record.
    start: Duration,
    /// Longest time from a request for a bias to the end of the records by which the bias is
    /// checked.
    bias: Duration,
}

const PATIENCE: Patience = Patience {
    most_tries: 10,
    start: Duration::from_millis(200),
    bias: Duration::from_secs(1),
};
const PAGE_WITHIN: Duration = Duration::from_secs(2);
/// Time until the records that arrive show the effect of a bias.
const BIAS_SETTLES: Duration = Duration::from_millis(20);
/// Number of records by which a bias is checked.
const BIAS_RECORDS: usize = 50;
/// Largest datagram that UDP can carry.
const LARGEST_DATAGRAM: usize = 65_536;

/// Largest mean of the records after a bias that is accepted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BiasTolerance {
    /// Along each axis, N.
    pub force_n: f64,
    /// About each axis, N mm.
    pub torque_n_mm: f64,
}

/// A connection to a sensor. The sensor streams to one client only. Dropping the client stops the
/// stream.
#[derive(Debug)]
pub struct Client {
    socket: UdpSocket,
    configuration: Configuration,
    datagram: Vec<u8>,
    patience: Patience,
}

impl Client {
    /// Opens a socket to a sensor whose configuration is known.
    ///
    /// # Errors
    /// An address that does not exist, a socket that cannot be opened.
    pub fn connect(address: impl ToSocketAddrs, configuration: Configuration) -> Result<Self, RigError> {
        let socket = UdpSocket::bind("0.0.0.0:0")
            .and_then(|socket| socket.connect(address).map(|()| socket))
            .map_err(|source| transport("opening a socket", source))?;
        Ok(Self {
            socket,
            configuration,
            datagram: vec![0; LARGEST_DATAGRAM],
            patience: PATIENCE,
        })
    }

    /// Sets how long the client waits before it sends a request again or gives up. Default: 0.2 s
    /// for the start, and 1 s for a bias.
    pub fn set_patience(&mut self, patience: Duration) {
        (self.patience.start, self.patience.bias) = (patience, patience);
    }

    /// Reads a sensor's configuration from its web server, `host` or `host:port`.
    ///
    /// # Errors
    /// A sensor that cannot be reached within two seconds, a page without what is needed.
    pub fn read_configuration(host: &str) -> Result<Configuration, RigError> {
        page::fetch(host, PAGE_WITHIN)
    }

    /// The sensor's configuration.
    #[must_use]
    pub fn configuration(&self) -> &Configuration {
        &self.configuration
    }

    /// Starts the stream, with several records in a datagram if `buffered`. The first datagram is
    /// taken as the answer and is not returned.
    ///
    /// # Errors
    /// Fails if no record arrives after ten requests, or if the status of the first record has an
    /// error.
    pub fn start(&mut self, buffered: bool) -> Result<(), RigError> {
        let command = if buffered {
            Command::StartBuffered
        } else {
            Command::StartRealTime
        };
        let Patience {
            most_tries, start, ..
        } = self.patience;
        for _ in 0..most_tries {
            self.send(command)?;
            if let Some(record) = self.receive(start)?.first() {
                return trusted(record);
            }
        }
        Err(RigError::Timeout {
            device: Device::ForceSensor,
            what: format!("{most_tries} requests to start"),
            after: start * most_tries,
        })
    }

    /// Counts the present load as zero and checks on the following records that the sensor does so.
    /// The sensor must be streaming. Returns the mean wrench of those records.
    ///
    /// # Errors
    /// Fails if the mean is beyond the tolerance after ten requests, if the sensor is silent, or if
    /// the status of a record has an error.
    pub fn bias(&mut self, tolerance: &BiasTolerance) -> Result<Wrench, RigError> {
        let mut mean = Wrench::ZERO;
        let most_tries = self.patience.most_tries;
        for _ in 0..most_tries {
            self.send(Command::Bias)?;
            mean = self.mean_after(BIAS_SETTLES)?;
            let force_n = mean.force_n.abs().max_element();
            let torque_n_mm = mean.torque_n_mm.abs().max_element();
            if force_n <= tolerance.force_n && torque_n_mm <= tolerance.torque_n_mm {
                return Ok(mean);
            }
        }
        Err(RigError::ForceSensor {
            problem: format!(
                "after {most_tries} requests for a bias it reads {:.3} N and {:.3} N mm",
                mean.force_n, mean.torque_n_mm
            ),
            hint: "let the load rest, or allow a larger tolerance",
        })
    }

    /// Stops the stream and discards datagrams that are still under way.
    ///
    /// # Errors
    /// Fails if the sensor still streams after ten requests.
    pub fn stop(&mut self) -> Result<(), RigError> {
        let most_tries = self.patience.most_tries;
        for _ in 0..most_tries {
            self.send(Command::Stop)?;
            let asked = Instant::now();
            while asked.elapsed() < BIAS_SETTLES {
                if self.receive(BIAS_SETTLES)?.is_empty() {
                    return Ok(());
                }
            }
        }
        Err(RigError::ForceSensor {
            problem: format!("it still streams after {most_tries} requests to stop"),
            hint: "another client may have started it: the sensor serves one client only",
        })
    }

    /// The records of the next datagram. Empty if nothing arrives in time.
    ///
    /// # Errors
    /// A datagram that holds no records, a socket that cannot be read from.
    pub fn receive(&mut self, within: Duration) -> Result<Vec<Record>, RigError> {
        self.socket
            .set_read_timeout(Some(within.max(Duration::from_micros(1))))
            .map_err(|source| transport("setting a time-out", source))?;
        match self.socket.recv(&mut self.datagram) {
            Ok(size) => Ok(decode_records(&self.datagram[..size])?.collect()),
            Err(found) => match found.kind() {
                ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted => Ok(Vec::new()),
                _ => Err(transport("receiving", found)),
            },
        }
    }

    fn send(&self, command: Command) -> Result<(), RigError> {
        let request = Request { command, samples: 0 };
        let sent = self.socket.send(&request.encode());
        sent.map(|_| ())
            .map_err(|source| transport("sending a request", source))
    }

    /// Mean of the records that arrive after the time `settles`.
    fn mean_after(&mut self, settles: Duration) -> Result<Wrench, RigError> {
        let asked = Instant::now();
        let (mut sum, mut n_records) = (Wrench::ZERO, 0);
        while n_records < BIAS_RECORDS {
            let Some(left) = self.patience.bias.checked_sub(asked.elapsed()) else {
                return Err(RigError::Timeout {
                    device: Device::ForceSensor,
                    what: format!("a bias, with {BIAS_RECORDS} records"),
                    after: self.patience.bias,
                });
            };
            let records = self.receive(left)?;
            if asked.elapsed() < settles {
                continue;
            }
            for record in &records {
                trusted(record)?;
                let wrench = self.configuration.wrench(record.counts);
                sum.force_n += wrench.force_n;
                sum.torque_n_mm += wrench.torque_n_mm;
            }
            n_records += records.len();
        }
        Ok(Wrench {
            force_n: sum.force_n / n_records as f64,
            torque_n_mm: sum.torque_n_mm / n_records as f64,
        })
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        // If the sensor cannot be reached any more, nothing can be done.
        let _ = self.send(Command::Stop);
    }
}

/// An error if the readings of the record cannot be trusted.
fn trusted(record: &Record) -> Result<(), RigError> {
    match record.status.health() {
        Health::Healthy | Health::Warning => Ok(()),
        Health::Error => Err(RigError::ForceSensorStatus {
            status: record.status,
        }),
    }
}

fn transport(what: &str, source: std::io::Error) -> RigError {
    RigError::Transport {
        device: Device::ForceSensor,
        what: what.to_owned(),
        source,
    }
}

#[cfg(test)]
#[path = "client_tests.rs"]
mod tests;
