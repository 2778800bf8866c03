//! A bench with connected devices.

use std::fmt;
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use phystac::{Clock, PhysTac, Transfer};
use twintac_lab::{EmulatorConfiguration, Selector};
use twintac_press::{Bench, Streams};
use twintac_recording::Provenance;
use twintac_rig::xarm::{Client, ReportPort, ReportReader};
use twintac_rig::{BenchClock, NetFtSource, netft};
use twintac_sensor::Sensor;
use twintac_source::{FrameReader, Known, TAXELS, TactileSource, power_on};
use twintac_work::WorkError;

/// How long a device may take to accept a connection.
pub(crate) const CONNECT_WITHIN: Duration = Duration::from_secs(3);

/// A bench that is switched on: its robot is enabled, and does not move. When it is dropped, it
/// stops.
pub struct OpenBench {
    pub(crate) devices: Bench<Client<TcpStream>>,
    pub(crate) transfer: Option<Transfer>,
    pub(crate) provenance: Provenance,
    pub(crate) notes: Vec<String>,
    /// The address of the robot's commands.
    pub(crate) robot: SocketAddr,
    /// The emulator configuration, for an emulated bench.
    pub(crate) emulator: Option<EmulatorConfiguration>,
    /// Changes the indenter of an emulated bench, where no person has to.
    pub(crate) selector: Option<Selector>,
    /// Keeps emulated devices running.
    pub(crate) _emulated: Option<twintac_emulate::EmulatedBench>,
}

impl OpenBench {
    /// Provenance of its readings.
    #[must_use]
    pub fn provenance(&self) -> Provenance {
        self.provenance
    }

    /// Remarks from when it was switched on, one sentence each.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }
}

impl fmt::Debug for OpenBench {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OpenBench")
            .field("provenance", &self.provenance)
            .field("robot", &self.robot)
            .finish_non_exhaustive()
    }
}

/// Network addresses of robot and force sensor.
pub(crate) struct Addresses {
    pub(crate) commands: SocketAddr,
    pub(crate) reports: SocketAddr,
    /// The address of the force sensor's requests, and the configuration that its page shows.
    pub(crate) force: (SocketAddr, netft::Configuration),
}

/// Connected devices, the conversion from counts to pressure, and remarks.
pub(crate) struct Connected {
    pub(crate) bench: Bench<Client<TcpStream>>,
    pub(crate) transfer: Option<Transfer>,
    pub(crate) notes: Vec<String>,
}

pub(crate) fn connect_to(reports: SocketAddr) -> Result<TcpStream, WorkError> {
    TcpStream::connect_timeout(&reports, CONNECT_WITHIN).map_err(|source| WorkError::Network {
        action: format!("connecting to the robot's reports at {reports}"),
        source,
    })
}

/// The tactile sensor, after its check.
pub(crate) struct Tactile {
    pub(crate) source: Box<dyn TactileSource>,
    pub(crate) transfer: Option<Transfer>,
    pub(crate) notes: Vec<String>,
}

impl Tactile {
    /// A sensor on a bus, checked in free air. `free` frees a bus that hangs.
    pub(crate) fn on_bus<I, D, C>(
        mut taxels: PhysTac<I, D, C, TAXELS>,
        free: impl FnMut(&mut I, &mut D) + Send + 'static,
        sensor: &Sensor,
        known: &Known,
    ) -> Result<Self, WorkError>
    where
        I: I2c + Send + 'static,
        D: DelayNs + Send + 'static,
        C: Clock + Send + 'static,
    {
        let checked = power_on(&mut taxels, sensor, known)?;
        let reader = FrameReader::new(taxels, &checked)
            .converting_ahead()
            .freed_by(free);
        Ok(Self {
            source: Box::new(reader),
            transfer: checked.transfer,
            notes: checked.notes,
        })
    }
}

/// Connects all devices and starts their streams. The robot is enabled last.
pub(crate) fn connect(
    addresses: &Addresses,
    tactile: Tactile,
    clock: BenchClock,
) -> Result<Connected, WorkError> {
    let mut notes = tactile.notes;
    let mut streams = Streams::new(clock);
    streams.hear_taxels(tactile.source)?;
    let (requests, configuration) = addresses.force.clone();
    let mut force = netft::Client::connect(requests, configuration)?;
    force.start(false)?;
    streams.hear_force(NetFtSource::new(force, clock))?;
    let reports = connect_to(addresses.reports)?;
    streams.hear_robot(ReportReader::new(reports, ReportPort::Development))?;
    let mut arm = Client::connect(addresses.commands)?;
    if let Some(code) = arm.errors()? {
        notes.push(format!("the robot's controller had {code}; it is cleared now"));
    }
    arm.enable()?;
    arm.begin_servo()?;
    Ok(Connected {
        bench: Bench { arm, streams },
        transfer: tactile.transfer,
        notes,
    })
}
