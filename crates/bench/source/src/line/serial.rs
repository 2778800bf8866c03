//! A serial port.

use std::io::{self, ErrorKind, Read, Write};
use std::time::Duration;

use serialport::SerialPort;
use twintac_line::Description;

use super::wire::Wire;
use crate::SourceError;

/// An open serial port.
pub struct SerialLine {
    port: Box<dyn SerialPort>,
    patience: Duration,
}

impl SerialLine {
    /// Opens a port such as `/dev/ttyACM0` or `COM3`, waits for a board that restarts, and sends
    /// the text that the description has for it.
    ///
    /// # Errors
    /// A port that cannot be opened, or does not accept the text.
    pub fn open(path: &str, description: &Description) -> Result<Self, SourceError> {
        let serial = &description.serial;
        let failed = |problem: String| SourceError::Open {
            wire: path.to_owned(),
            problem,
        };
        let patience = Duration::from_millis(20);
        let builder = serialport::new(path, serial.baud)
            .timeout(patience)
            .dtr_on_open(serial.dtr);
        let mut port = builder.open().map_err(|error| failed(error.to_string()))?;
        std::thread::sleep(Duration::from_secs_f64(serial.wait_s));
        if !serial.send.is_empty() {
            let sent = port.write_all(serial.send.as_bytes()).and_then(|()| port.flush());
            sent.map_err(|error| failed(error.to_string()))?;
        }
        Ok(Self { port, patience })
    }
}

impl Wire for SerialLine {
    fn read(&mut self, bytes: &mut [u8], patience: Duration) -> io::Result<usize> {
        let patience = patience.max(Duration::from_millis(1));
        if patience != self.patience {
            self.port.set_timeout(patience)?;
            self.patience = patience;
        }
        match self.port.read(bytes) {
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => Ok(0),
            // A port that was unplugged returns at once without bytes.
            Ok(0) => Err(io::Error::new(ErrorKind::BrokenPipe, "the port is gone")),
            read => read,
        }
    }
}

impl std::fmt::Debug for SerialLine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SerialLine")
            .field("port", &self.port.name())
            .finish()
    }
}
