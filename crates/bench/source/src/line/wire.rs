//! What bytes come over.

use std::io;
use std::time::Duration;

/// Bytes as they come, from whatever.
pub trait Wire: Send {
    /// Waits for bytes, for so long at most, and says how many came; 0: none did.
    ///
    /// # Errors
    /// What the operating system says; the end of what there is, as [`UnexpectedEof`](io::ErrorKind::UnexpectedEof).
    fn read(&mut self, bytes: &mut [u8], patience: Duration) -> io::Result<usize>;
}
