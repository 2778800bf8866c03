//! Reads reports from a report socket.

use std::net::TcpStream;
use std::time::{Duration, Instant};

use super::client::connect;
use super::frame_reader::FrameReader;
use super::{Report, ReportPort, Wire, report_splitter};
use crate::RigError;

/// A connection to a report socket. The robot sends without being asked. Reports that are not read
/// in time wait in the connection and are old when they are read, so read them in a separate
/// thread.
#[derive(Debug)]
pub struct ReportReader<W> {
    reader: FrameReader<W>,
    port: ReportPort,
}

impl ReportReader<TcpStream> {
    /// Connects to a host's report socket.
    ///
    /// # Errors
    /// A host that does not answer within two seconds.
    pub fn connect(host: &str, port: ReportPort) -> Result<Self, RigError> {
        Ok(Self::new(connect((host, port.number()))?, port))
    }
}

impl<W: Wire> ReportReader<W> {
    /// Reads the reports of a port from an open connection.
    #[must_use]
    pub fn new(wire: W, port: ReportPort) -> Self {
        Self {
            reader: FrameReader::new(wire, report_splitter()),
            port,
        }
    }

    /// Waits for the next report. `None` if it is not complete in time.
    ///
    /// # Errors
    /// A connection that fails or ends, bytes that are no report.
    pub fn next_report(&mut self, within: Duration) -> Result<Option<Report>, RigError> {
        let frame = self.reader.next(Some(Instant::now() + within))?;
        frame.map(|frame| Report::decode(self.port, &frame)).transpose()
    }
}
