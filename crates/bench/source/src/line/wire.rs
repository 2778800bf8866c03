//! Connections from which a line's bytes come.

use std::io;
use std::time::Duration;

/// A source of bytes.
pub trait Wire: Send {
    /// Waits for bytes for at most `patience`, and returns how many have arrived; 0 if none.
    ///
    /// # Errors
    /// An error of the operating system; the end of the data, as
    /// [`UnexpectedEof`](io::ErrorKind::UnexpectedEof).
    fn read(&mut self, bytes: &mut [u8], patience: Duration) -> io::Result<usize>;
}
