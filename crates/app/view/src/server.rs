//! The server: it listens, checks requests, and answers each client on a thread of its own.

use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use tungstenite::handshake::derive_accept_key;

use crate::guard::Guard;
use crate::head::Head;
use crate::patient::{self, Patient};
use crate::session::Session;
use crate::socket::talk;

/// Most clients at a time.
const MOST_CLIENTS: usize = 32;
/// How long a client may take to send its request, and to receive its answer.
const PATIENCE: Duration = Duration::from_secs(10);
/// How long a connection stays open after the answer, for bytes that the client still sends.
const FAREWELL: Duration = Duration::from_secs(1);
/// Interval at which the server looks for new clients.
const NEXT_CLIENT: Duration = Duration::from_millis(20);

/// What a server serves.
pub struct View {
    /// The page: an HTML file that needs no other file.
    pub page: Vec<u8>,
    /// Makes the session of a new client.
    pub session: Box<dyn Fn() -> Box<dyn Session> + Send + Sync>,
}

/// Why a server cannot serve.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// The address cannot be listened on.
    #[error("{address} cannot be listened on: {source}")]
    Listen {
        /// The address.
        address: SocketAddr,
        /// The error of the operating system.
        source: io::Error,
    },
    /// The system has no random numbers for a token.
    #[error("the system gives no random numbers: {0}")]
    Token(getrandom::Error),
    /// Accepting connections failed.
    #[error("no more clients can be taken: {0}")]
    Accept(io::Error),
}

/// A server that listens on an address.
pub struct Server {
    listener: TcpListener,
    guard: Guard,
}

impl Server {
    /// Listens on an address. Port 0 means any free port.
    ///
    /// # Errors
    /// An address that cannot be listened on, or a system without random numbers.
    pub fn bind(address: SocketAddr) -> Result<Self, ViewError> {
        let mut secret = [0; 16];
        getrandom::fill(&mut secret).map_err(ViewError::Token)?;
        let token = secret.iter().map(|byte| format!("{byte:02x}")).collect();
        let listen = || {
            let listener = TcpListener::bind(address)?;
            listener.set_nonblocking(true)?;
            let address = listener.local_addr()?;
            Ok((listener, address))
        };
        let (listener, address) = listen().map_err(|source| ViewError::Listen { address, source })?;
        Ok(Self {
            listener,
            guard: Guard { address, token },
        })
    }

    /// The address of the page, with the token. If the server listens on all addresses, this is the
    /// address of the local machine.
    #[must_use]
    pub fn url(&self) -> String {
        let mut address = self.guard.address;
        if address.ip().is_unspecified() {
            address.set_ip(Ipv4Addr::LOCALHOST.into());
        }
        format!("http://{address}/?token={}", self.guard.token)
    }

    /// Serves until it is stopped; then all clients are disconnected.
    ///
    /// # Errors
    /// A failure to accept connections.
    pub fn serve(&self, view: &View, is_stopped: &AtomicBool) -> Result<(), ViewError> {
        let n_clients = AtomicUsize::new(0);
        thread::scope(|scope| {
            while !is_stopped.load(Ordering::Relaxed) {
                let stream = match self.listener.accept() {
                    Ok((stream, _)) => stream,
                    Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                        thread::sleep(NEXT_CLIENT);
                        continue;
                    }
                    Err(error) if is_of_the_client(&error) => continue,
                    Err(error) => {
                        is_stopped.store(true, Ordering::Relaxed);
                        return Err(ViewError::Accept(error));
                    }
                };
                let n_clients = &n_clients;
                let is_full = n_clients.fetch_add(1, Ordering::Relaxed) >= MOST_CLIENTS;
                scope.spawn(move || {
                    // A client that fails, for whatever reason, does not affect others.
                    let _ = catch_unwind(AssertUnwindSafe(|| {
                        let _ = self.welcome(stream, view, is_full, is_stopped);
                    }));
                    n_clients.fetch_sub(1, Ordering::Relaxed);
                });
            }
            Ok(())
        })
    }

    fn welcome(
        &self,
        mut stream: TcpStream,
        view: &View,
        is_full: bool,
        is_stopped: &AtomicBool,
    ) -> io::Result<()> {
        stream.set_nonblocking(false)?;
        stream.set_read_timeout(Some(patient::LOOK))?;
        stream.set_write_timeout(Some(PATIENCE))?;
        if is_full {
            return say(
                &mut stream,
                "503 Service Unavailable",
                "there are too many clients: close other pages",
            );
        }
        let mut patient = Patient {
            stream: &stream,
            until: Instant::now() + PATIENCE,
            is_stopped,
        };
        let head = match Head::read(&mut patient) {
            Ok(head) => head,
            Err(error) if error.kind() == io::ErrorKind::InvalidData => {
                return say(&mut stream, "400 Bad Request", &error.to_string());
            }
            Err(error) => return Err(error),
        };
        if let Err(refusal) = self.guard.check(&head) {
            return say(&mut stream, "403 Forbidden", &refusal.to_string());
        }
        match (head.method.as_str(), head.path.as_str(), &head.socket_key) {
            ("GET", "/", None) => send(&mut stream, "200 OK", "text/html; charset=utf-8", &view.page),
            ("GET", "/engine", Some(key)) => {
                let accepted = derive_accept_key(key.as_bytes());
                write!(
                    stream,
                    "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: {accepted}\r\n\r\n"
                )?;
                let mut session = (view.session)();
                talk(stream, session.as_mut(), is_stopped).map_err(io::Error::other)
            }
            ("GET", "/engine", None) => say(&mut stream, "426 Upgrade Required", "this is a WebSocket"),
            ("GET", ..) => say(&mut stream, "404 Not Found", "there is nothing here"),
            _ => say(&mut stream, "405 Method Not Allowed", "there is only GET"),
        }
    }
}

/// Whether a client disconnected before it was accepted.
fn is_of_the_client(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::ConnectionAborted | io::ErrorKind::ConnectionReset | io::ErrorKind::Interrupted
    )
}

fn say(stream: &mut TcpStream, status: &str, what: &str) -> io::Result<()> {
    send(
        stream,
        status,
        "text/plain; charset=utf-8",
        format!("{what}\n").as_bytes(),
    )
}

/// Sends an answer that other pages may not frame, guess or store, and then reads what the client
/// still sends: a connection that is closed with unread bytes is reset, and its answer is lost (RFC
/// 9112, section 9.6).
fn send(stream: &mut TcpStream, status: &str, kind: &str, body: &[u8]) -> io::Result<()> {
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\nCache-Control: no-store\r\n\
         Referrer-Policy: no-referrer\r\nX-Content-Type-Options: nosniff\r\nX-Frame-Options: DENY\r\n\r\n",
        body.len()
    )?;
    stream.write_all(body)?;
    stream.shutdown(Shutdown::Write)?;
    let until = Instant::now() + FAREWELL;
    let mut unread = [0; 2048];
    while Instant::now() < until {
        match stream.read(&mut unread) {
            Ok(0) => break,
            Err(error) if !patient::is_later(&error) => break,
            _ => {}
        }
    }
    Ok(())
}
