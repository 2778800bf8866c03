//! A bench of real devices.

use std::net::{SocketAddr, ToSocketAddrs};
use std::path::Path;

use twintac_press::PressSettings;
use twintac_recording::Provenance;
use twintac_rig::xarm::{PORT, ReportPort, ReportReader};
use twintac_rig::{BenchClock, netft};
use twintac_sensor::Sensor;
use twintac_source::{Known, LineSource, TAXELS};
use twintac_work::WorkError;

use crate::OpenBench;
use crate::open::{Addresses, CONNECT_WITHIN, Tactile, connect, connect_to};

#[cfg(not(target_os = "linux"))]
use phystac::PhysTac;

impl OpenBench {
    /// Connects the devices that the settings name. The robot is enabled, and does not move.
    /// `known` is what is known about the barometers.
    ///
    /// # Errors
    /// Settings without devices; a device that does not answer or is not configured as described;
    /// taxels that do not read the pressure of free air.
    pub fn connect(sensor: &Sensor, settings: &PressSettings, known: &Known) -> Result<Self, WorkError> {
        let devices = settings.real_devices()?;
        let clock = BenchClock::start();
        let configuration = netft::Client::read_configuration(&devices.force)?;
        let addresses = Addresses {
            commands: address(&devices.robot, PORT)?,
            reports: address(&devices.robot, ReportPort::Development.number())?,
            force: (address(&devices.force, netft::PORT)?, configuration),
        };
        let rich = ReportPort::Rich;
        let mut reader = ReportReader::new(connect_to(address(&devices.robot, rich.number())?)?, rich);
        let report = reader.next_report(CONNECT_WITHIN)?;
        let tool = report
            .and_then(|report| report.status)
            .ok_or_else(|| WorkError::Input("the robot does not report its settings".to_owned()))?;
        devices.check_tool(&tool)?;
        let tactile = match &devices.line {
            Some(line) => on_line(&devices.tactile, line, sensor, clock)?,
            None => {
                let mut driver = twintac_source::driver_settings(sensor)?;
                driver.conversion_us = settings.conversion_us;
                let taxels = open_bus(Path::new(&devices.tactile), driver, clock)?;
                // The kernel's bus driver frees the bus where it can. The switch's reset line is
                // not connected to this computer.
                Tactile::on_bus(taxels, |_, _| {}, sensor, known)?
            }
        };
        let connected = connect(&addresses, tactile, clock)?;
        Ok(Self {
            devices: connected.bench,
            transfer: connected.transfer,
            provenance: Provenance::Real,
            notes: connected.notes,
            robot: addresses.commands,
            emulator: None,
            selector: None,
            _emulated: None,
        })
    }
}

/// A sensor whose frames come over a serial port, or in datagrams.
fn on_line(tactile: &str, line: &Path, sensor: &Sensor, clock: BenchClock) -> Result<Tactile, WorkError> {
    let now = Box::new(move || clock.now_us());
    let n_taxels = sensor.taxels.len();
    let source = match tactile.strip_prefix("udp:") {
        Some(address) => LineSource::udp(address, line, n_taxels, now)?,
        None => LineSource::serial(tactile, line, n_taxels, now)?,
    };
    Ok(Tactile {
        source: Box::new(source),
        transfer: None,
        notes: Vec::new(),
    })
}

/// The network address of a host and a port.
fn address(host: &str, port: u16) -> Result<SocketAddr, WorkError> {
    let mut found = (host, port)
        .to_socket_addrs()
        .map_err(|source| WorkError::Network {
            action: format!("looking up {host}"),
            source,
        })?;
    found
        .next()
        .ok_or_else(|| WorkError::Input(format!("{host} has no address")))
}

#[cfg(target_os = "linux")]
fn open_bus(
    path: &Path,
    driver: phystac::Settings<TAXELS>,
    clock: BenchClock,
) -> Result<twintac_source::LinuxPhysTac, WorkError> {
    Ok(twintac_source::open_linux(
        path,
        driver,
        Box::new(move || clock.now_us()),
    )?)
}

#[cfg(not(target_os = "linux"))]
fn open_bus(
    path: &Path,
    _: phystac::Settings<TAXELS>,
    _: BenchClock,
) -> Result<
    PhysTac<twintac_emulate::i2c::Bus, twintac_emulate::LabClock, twintac_source::BoxedClock, TAXELS>,
    WorkError,
> {
    Err(WorkError::Input(format!(
        "{}: buses are opened on Linux only",
        path.display()
    )))
}
