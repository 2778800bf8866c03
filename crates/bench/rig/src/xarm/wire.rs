//! Connections for commands and responses.

use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

/// A connection in both directions.
pub trait Wire: Read + Write {
    /// Limits how long the next reads wait. Zero: they do not wait. A read without bytes then fails
    /// with [`io::ErrorKind::TimedOut`] or [`io::ErrorKind::WouldBlock`].
    ///
    /// # Errors
    /// The error of the operating system.
    fn limit_reads(&mut self, to: Duration) -> io::Result<()>;
}

impl Wire for TcpStream {
    fn limit_reads(&mut self, to: Duration) -> io::Result<()> {
        self.set_nonblocking(to.is_zero())?;
        if to.is_zero() {
            return Ok(());
        }
        self.set_read_timeout(Some(to))
    }
}

/// A connection of two halves, such as pipes or buffers. Reads wait as long as the reader does.
#[derive(Clone, Debug)]
pub struct Pair<R, W> {
    /// From the robot.
    pub reader: R,
    /// To the robot.
    pub writer: W,
}

impl<R: Read, W> Read for Pair<R, W> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.reader.read(bytes)
    }
}

impl<R, W: Write> Write for Pair<R, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

impl<R: Read, W: Write> Wire for Pair<R, W> {
    fn limit_reads(&mut self, _: Duration) -> io::Result<()> {
        Ok(())
    }
}
