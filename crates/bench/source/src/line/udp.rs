//! Datagrams of lines or packets.

use std::io::{self, ErrorKind};
use std::net::UdpSocket;
use std::time::Duration;

use super::wire::Wire;

/// A socket that receives datagrams. The end of a datagram is no boundary: an unfinished line goes
/// on in the next datagram.
impl Wire for UdpSocket {
    fn read(&mut self, bytes: &mut [u8], patience: Duration) -> io::Result<usize> {
        self.set_read_timeout(Some(patience.max(Duration::from_millis(1))))?;
        match self.recv(bytes) {
            Err(error)
                if matches!(
                    error.kind(),
                    ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted
                ) =>
            {
                Ok(0)
            }
            read => read,
        }
    }
}
