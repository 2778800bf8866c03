//! A stream with a deadline that also ends when the program is stopped.

use std::io::{self, Read};
use std::net::TcpStream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How long a read waits for bytes before it checks the deadline.
pub(crate) const LOOK: Duration = Duration::from_millis(100);

/// A stream with a deadline that also ends when the program is stopped.
pub(crate) struct Patient<'a> {
    pub(crate) stream: &'a TcpStream,
    pub(crate) until: Instant,
    pub(crate) is_stopped: &'a AtomicBool,
}

impl Read for Patient<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        loop {
            match self.stream.read(bytes) {
                Err(error) if is_later(&error) => {
                    if self.is_stopped.load(Ordering::Relaxed) || Instant::now() >= self.until {
                        return Err(io::ErrorKind::TimedOut.into());
                    }
                }
                read => return read,
            }
        }
    }
}

/// Whether a read ended without bytes, and bytes may come later.
pub(crate) fn is_later(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut)
}
