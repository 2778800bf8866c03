//! A client's WebSocket.

use std::net::TcpStream;
use std::sync::atomic::{AtomicBool, Ordering};

use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Error, Message, WebSocket};

use crate::patient::{LOOK, is_later};
use crate::session::Session;

/// Longest message, bytes; a longer one ends the connection. A file that is dropped on a page is
/// one message.
const LONGEST: usize = 64 << 20;

/// Answers a client, one answer a message, until it leaves, sends something invalid, or the program
/// is stopped.
pub(crate) fn talk(
    stream: TcpStream,
    session: &mut dyn Session,
    is_stopped: &AtomicBool,
) -> Result<(), Error> {
    stream.set_read_timeout(Some(LOOK))?;
    stream.set_nodelay(true)?;
    let config = WebSocketConfig::default()
        .max_message_size(Some(LONGEST))
        .max_frame_size(Some(LONGEST));
    let mut socket = WebSocket::from_raw_socket(stream, Role::Server, Some(config));
    while !is_stopped.load(Ordering::Relaxed) {
        match socket.read() {
            Ok(Message::Binary(request)) => socket.send(Message::binary(session.answer(&request)))?,
            Ok(Message::Text(request)) => socket.send(Message::binary(session.answer(request.as_bytes())))?,
            Ok(_) => (), // tungstenite answers pings; a close frame ends the next turn of the loop
            Err(Error::Io(error)) if is_later(&error) => (),
            Err(Error::ConnectionClosed | Error::AlreadyClosed) => return Ok(()),
            Err(error) => return Err(error),
        }
    }
    let _ = socket.close(None);
    let _ = socket.flush();
    Ok(())
}
