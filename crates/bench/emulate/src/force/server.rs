//! The force sensor on its sockets.

use std::io::{Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use twintac_rig::netft::PAGE;

use super::{ForceSensor, ForceSettings};
use crate::robot::listen;
use crate::worker::{Over, Worker, locked};
use crate::{EmulateError, ScheduledFault, Workcell};

/// Longest time between two looks at the socket.
const GLANCE: Duration = Duration::from_millis(1);
/// Longest time that a browser may take for its request.
const ASK_WITHIN: Duration = Duration::from_millis(200);

/// A force sensor that listens on the loopback until it is dropped.
#[derive(Debug)]
pub struct ForceServer {
    sensor: Arc<Mutex<ForceSensor>>,
    requests: SocketAddr,
    page: SocketAddr,
    _workers: [Worker; 2],
}

impl ForceServer {
    /// Opens the sensor's sockets.
    ///
    /// # Errors
    /// A setting or a fault that is not valid; a port that is in use; a thread that cannot be
    /// started.
    pub fn start(
        workcell: Workcell,
        settings: ForceSettings,
        faults: &[ScheduledFault],
    ) -> Result<Self, EmulateError> {
        let [udp_port, tcp_port] = settings.ports;
        let sensor = ForceSensor::new(workcell.clone(), settings, faults)?;
        let page_text = sensor.configuration().to_xml();
        let sensor = Arc::new(Mutex::new(sensor));
        let opened = UdpSocket::bind((Ipv4Addr::LOCALHOST, udp_port)).and_then(|socket| {
            socket.set_nonblocking(true)?;
            let address = socket.local_addr()?;
            Ok((socket, address))
        });
        let (socket, requests) = opened.map_err(|source| EmulateError::System {
            what: "the force sensor's requests",
            source,
        })?;
        let (listener, page) = listen(tcp_port, "the force sensor's page")?;
        let streams = Worker::start("force records", {
            let sensor = Arc::clone(&sensor);
            move |over| stream(&socket, &workcell, &sensor, over)
        })?;
        let pages = Worker::start("force page", move |over| show(&listener, &page_text, over))?;
        Ok(Self {
            sensor,
            requests,
            page,
            _workers: [streams, pages],
        })
    }

    /// Address of its requests.
    #[must_use]
    pub fn requests(&self) -> SocketAddr {
        self.requests
    }

    /// Address of its web server.
    #[must_use]
    pub fn page(&self) -> SocketAddr {
        self.page
    }

    /// Gives access to the sensor. Its sockets wait meanwhile.
    pub fn with_sensor<T>(&self, look: impl FnOnce(&mut ForceSensor) -> T) -> T {
        look(&mut locked(&self.sensor))
    }
}

/// Receives requests, and sends due datagrams to the last client that started a stream.
fn stream(socket: &UdpSocket, workcell: &Workcell, sensor: &Mutex<ForceSensor>, over: &Over) {
    let mut client = None;
    let mut bytes = [0; 64];
    while !over.is_over() {
        let next_due_ns = {
            let mut sensor = locked(sensor);
            while let Ok((size, from)) = socket.recv_from(&mut bytes) {
                if sensor.hear(&bytes[..size]) {
                    client = Some(from);
                }
            }
            for outgoing in sensor.due() {
                if let Some(client) = client {
                    // A datagram that cannot be sent is lost like any other lost datagram.
                    let _ = socket.send_to(&outgoing.datagram, client);
                }
            }
            sensor.next_due_ns().unwrap_or(u64::MAX)
        };
        workcell.clock().rest_until_ns(next_due_ns, GLANCE);
    }
}

/// Serves the page.
fn show(listener: &TcpListener, text: &str, over: &Over) {
    while !over.is_over() {
        match listener.accept() {
            // A client that went away before the answer needs none.
            Ok((stream, _)) => drop(answer(stream, text)),
            Err(_) => std::thread::sleep(5 * GLANCE),
        }
    }
}

fn answer(mut stream: TcpStream, text: &str) -> std::io::Result<()> {
    stream.set_nonblocking(false)?;
    stream.set_read_timeout(Some(ASK_WITHIN))?;
    stream.set_write_timeout(Some(ASK_WITHIN))?;
    let mut asked = Vec::new();
    let mut bytes = [0; 1024];
    while !asked.windows(4).any(|end| end == b"\r\n\r\n") && asked.len() < 8192 {
        match stream.read(&mut bytes)? {
            0 => break,
            size => asked.extend(&bytes[..size]),
        }
    }
    let asked = String::from_utf8_lossy(&asked);
    let mut words = asked.split_whitespace();
    let is_asked = words.next() == Some("GET")
        && words
            .next()
            .is_some_and(|path| path.split('?').next() == Some(PAGE));
    let (status, text) = if is_asked {
        ("200 OK", text)
    } else {
        ("404 Not Found", "")
    };
    let size = text.len();
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: text/xml\r\nContent-Length: {size}\r\nConnection: close\r\n\r\n{text}"
    )
}
