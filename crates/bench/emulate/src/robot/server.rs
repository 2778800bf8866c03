//! The robot on its sockets.

use std::io::{ErrorKind, Read, Write};
use std::net::{Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use twintac_rig::xarm::{ReportPort, splitter};

use super::{Controller, RobotSettings};
use crate::clock::nanoseconds;
use crate::worker::{Over, Worker, locked};
use crate::{EmulateError, ScheduledFault, Workcell};

/// Longest time between two checks whether a thread must end.
const GLANCE: Duration = Duration::from_millis(10);
/// How long a client that does not read its reports is tolerated.
const SEND_WITHIN: Duration = Duration::from_millis(200);

/// A robot that listens on the loopback until it is dropped.
#[derive(Debug)]
pub struct RobotServer {
    controller: Arc<Mutex<Controller>>,
    addresses: [SocketAddr; 4],
    _workers: [Worker; 4],
}

impl RobotServer {
    /// Opens the robot's sockets.
    ///
    /// # Errors
    /// A setting or a fault that is not valid; a port that is in use; a thread that cannot be
    /// started.
    pub fn start(
        workcell: Workcell,
        settings: RobotSettings,
        faults: &[ScheduledFault],
    ) -> Result<Self, EmulateError> {
        let (ports, rates) = (settings.ports, settings.rates);
        let controller = Arc::new(Mutex::new(Controller::new(workcell, settings, faults)?));
        let [commands, normal, rich, development] = [
            listen(ports[0], "the robot's commands")?,
            listen(ports[1], "the robot's normal reports")?,
            listen(ports[2], "the robot's rich reports")?,
            listen(ports[3], "the robot's development reports")?,
        ];
        let addresses = [commands.1, normal.1, rich.1, development.1];
        let shared = || Arc::clone(&controller);
        let reports = |listener: TcpListener, port: ReportPort, rate_hz: f64| {
            let controller = shared();
            Worker::start("robot reports", move |over| {
                report(&listener, &controller, port, rate_hz, over);
            })
        };
        let workers = [
            Worker::start("robot commands", {
                let controller = shared();
                move |over| accept(&commands.0, &controller, over)
            })?,
            reports(normal.0, ReportPort::Normal, rates.normal_hz)?,
            reports(rich.0, ReportPort::Rich, rates.rich_hz)?,
            reports(development.0, ReportPort::Development, rates.development_hz)?,
        ];
        Ok(Self {
            controller,
            addresses,
            _workers: workers,
        })
    }

    /// Address of its command socket.
    #[must_use]
    pub fn commands(&self) -> SocketAddr {
        self.addresses[0]
    }

    /// Address of a report socket.
    #[must_use]
    pub fn reports(&self, port: ReportPort) -> SocketAddr {
        match port {
            ReportPort::Normal => self.addresses[1],
            ReportPort::Rich => self.addresses[2],
            ReportPort::Development => self.addresses[3],
        }
    }

    /// Gives access to the controller. Its sockets wait meanwhile.
    pub(crate) fn with_controller<T>(&self, look: impl FnOnce(&mut Controller) -> T) -> T {
        look(&mut locked(&self.controller))
    }
}

/// A listener on the loopback that does not block.
pub(crate) fn listen(port: u16, what: &'static str) -> Result<(TcpListener, SocketAddr), EmulateError> {
    let opened = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).and_then(|listener| {
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        Ok((listener, address))
    });
    opened.map_err(|source| EmulateError::System { what, source })
}

/// Accepts connections for commands. Each gets its own thread.
fn accept(listener: &TcpListener, controller: &Arc<Mutex<Controller>>, over: &Over) {
    let mut connections: Vec<Worker> = Vec::new();
    while !over.is_over() {
        if let Ok((stream, _)) = listener.accept() {
            let controller = Arc::clone(controller);
            // If no thread can be started, the connection ends and the client sees it.
            connections.extend(Worker::start("robot connection", move |over| {
                // A connection that fails has ended. Nobody can be told.
                let _ = serve(stream, &controller, over);
            }));
        } else {
            std::thread::sleep(GLANCE);
        }
        connections.retain(|connection| !connection.has_ended());
    }
}

/// Answers the requests of a connection.
fn serve(mut stream: TcpStream, controller: &Mutex<Controller>, over: &Over) -> std::io::Result<()> {
    stream.set_nonblocking(false)?;
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(GLANCE))?;
    stream.set_write_timeout(Some(SEND_WITHIN))?;
    let n_resets = locked(controller).n_resets();
    let mut splitter = splitter();
    let mut bytes = [0; 1024];
    while !over.is_over() {
        let size = match stream.read(&mut bytes) {
            Ok(0) => return Ok(()),
            Ok(size) => size,
            Err(found) if is_time_out(&found) => 0,
            Err(found) => return Err(found),
        };
        let mut chunk = &bytes[..size];
        loop {
            let response = match splitter.take(&mut chunk) {
                Ok(Some(frame)) => locked(controller).respond(&frame),
                Ok(None) => break,
                Err(_) => return stream.shutdown(Shutdown::Both), // its framing cannot be recovered
            };
            if locked(controller).n_resets() != n_resets {
                return stream.shutdown(Shutdown::Both);
            }
            if let Some(response) = response {
                stream.write_all(&response)?;
            }
        }
        if locked(controller).n_resets() != n_resets {
            return stream.shutdown(Shutdown::Both);
        }
    }
    Ok(())
}

/// Sends reports to all connected clients.
fn report(
    listener: &TcpListener,
    controller: &Mutex<Controller>,
    port: ReportPort,
    rate_hz: f64,
    over: &Over,
) {
    let clock = locked(controller).workcell().clock().clone();
    let period_ns = nanoseconds(1.0 / rate_hz).max(1);
    let mut due_ns = clock.now_ns() + period_ns;
    let mut streams: Vec<TcpStream> = Vec::new();
    let mut n_resets = 0;
    while !over.is_over() {
        while let Ok((stream, _)) = listener.accept() {
            let is_ready = stream
                .set_nonblocking(false)
                .and_then(|()| stream.set_nodelay(true))
                .and_then(|()| stream.set_write_timeout(Some(SEND_WITHIN)));
            streams.extend(is_ready.is_ok().then_some(stream));
        }
        let frame = {
            let mut controller = locked(controller);
            controller.look();
            if std::mem::replace(&mut n_resets, controller.n_resets()) != n_resets {
                streams.clear();
            }
            let is_due = clock.now_ns() >= due_ns;
            is_due.then(|| controller.report_frame(port))
        };
        if let Some(frame) = frame {
            streams.retain_mut(|stream| stream.write_all(&frame).is_ok());
            // Reports that could not be sent in time are left out.
            due_ns += period_ns * (clock.now_ns() - due_ns).div_ceil(period_ns).max(1);
        }
        clock.rest_until_ns(due_ns, GLANCE);
    }
}

fn is_time_out(found: &std::io::Error) -> bool {
    matches!(
        found.kind(),
        ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
    )
}
