//! The devices of a bench, connected.

pub mod lab;

use std::net::{SocketAddr, TcpStream, ToSocketAddrs};
use std::path::Path;
use std::time::Duration;

use anyhow::{Context, Result};
use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use phystac::{Clock, PhysTac, Transfer};
use twintac_lab::Selector;
use twintac_live::{Known, TAXELS, power_on};
use twintac_press::{Bench, PressSettings, Streams};
use twintac_recording::Provenance;
use twintac_rig::xarm::{Client, PORT, ReportPort, ReportReader};
use twintac_rig::{BenchClock, NetFtSource, netft};
use twintac_sensor::Sensor;

/// How long a device may take to accept a connection.
const CONNECT_WITHIN: Duration = Duration::from_secs(3);

/// A bench that is switched on.
pub struct OpenBench {
    pub devices: Bench<Client<TcpStream>>,
    pub transfer: Transfer,
    pub provenance: Provenance,
    /// What was odd when it was switched on, a sentence each.
    pub notes: Vec<String>,
    /// Where the robot listens.
    pub robot: SocketAddr,
    /// Puts indenters on, where nobody has to.
    pub selector: Option<Selector>,
    /// What keeps emulated devices running.
    pub _emulated: Option<twintac_emulate::EmulatedBench>,
}

/// Where robot and force sensor listen.
pub struct Addresses {
    pub commands: SocketAddr,
    pub reports: SocketAddr,
    /// Of the force sensor's requests; what its page says.
    pub force: (SocketAddr, netft::Configuration),
}

/// Connects the devices of the settings. The robot is enabled, and stands.
pub fn open_real(sensor: &Sensor, settings: &PressSettings, known: &Known) -> Result<OpenBench> {
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
        .context("the robot does not report its settings")?;
    devices.check_tool(&tool)?;
    let mut driver = twintac_live::driver_settings(sensor)?;
    driver.conversion_us = settings.conversion_us;
    let taxels = open_bus(Path::new(&devices.tactile), driver, clock)?;
    // Where the kernel's driver of the bus can free it, it does; the switch's reset line is not wired to this computer.
    let (bench, transfer, notes) = connect(&addresses, taxels, |_, _| {}, sensor, known, clock)?;
    Ok(OpenBench {
        devices: bench,
        transfer,
        provenance: Provenance::Real,
        notes,
        robot: addresses.commands,
        selector: None,
        _emulated: None,
    })
}

/// Where something listens.
fn address(host: &str, port: u16) -> Result<SocketAddr> {
    (host, port)
        .to_socket_addrs()
        .with_context(|| format!("looking up {host}"))?
        .next()
        .with_context(|| format!("{host} has no address"))
}

fn connect_to(reports: SocketAddr) -> Result<TcpStream> {
    TcpStream::connect_timeout(&reports, CONNECT_WITHIN)
        .with_context(|| format!("connecting to the robot's reports at {reports}"))
}

#[cfg(target_os = "linux")]
fn open_bus(
    path: &Path,
    driver: phystac::Settings<TAXELS>,
    clock: BenchClock,
) -> Result<twintac_live::LinuxPhysTac> {
    Ok(twintac_live::open_linux(
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
) -> Result<PhysTac<twintac_emulate::i2c::Bus, twintac_emulate::LabClock, twintac_live::BoxedClock, TAXELS>> {
    anyhow::bail!("{}: buses are opened on Linux only", path.display())
}

/// Connects, checks the taxels in free air, and has everything heard. The robot is enabled last.
pub fn connect<I, D, C>(
    addresses: &Addresses,
    mut taxels: PhysTac<I, D, C, TAXELS>,
    free: impl FnMut(&mut I, &mut D) + Send + 'static,
    sensor: &Sensor,
    known: &Known,
    clock: BenchClock,
) -> Result<(Bench<Client<TcpStream>>, Transfer, Vec<String>)>
where
    I: I2c + Send + 'static,
    D: DelayNs + Send + 'static,
    C: Clock + Send + 'static,
{
    let checked = power_on(&mut taxels, sensor, known)?;
    let mut notes = checked.notes.clone();
    let mut streams = Streams::new(clock);
    let mut screening = checked.screening();
    streams.hear_taxels(taxels, move |frame| screening.frame(frame), free)?;
    let (requests, configuration) = addresses.force.clone();
    let mut force = netft::Client::connect(requests, configuration)?;
    force.start(false)?;
    streams.hear_force(NetFtSource::new(force, clock))?;
    let reports = connect_to(addresses.reports)?;
    streams.hear_robot(ReportReader::new(reports, ReportPort::Development))?;
    let mut arm = Client::connect(addresses.commands)?;
    if let Some(code) = arm.errors()? {
        notes.push(format!("the robot's controller had {code}; it is cleaned now"));
    }
    arm.enable()?;
    arm.begin_servo()?;
    Ok((Bench { arm, streams }, checked.transfer, notes))
}
