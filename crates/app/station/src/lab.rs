//! The emulated bench, on the same protocols as a real one.

use std::path::Path;
use std::sync::Arc;

use glam::DVec3;
use phystac::PhysTac;
use phystac::recovery::{free_bus, reset_switch};
use serde::Deserialize;
use twintac_emulate::{EmulatedBench, EmulatedBenchSettings, LabClock, ScheduledFault, check_faults};
use twintac_lab::{EmulatorConfiguration, Lab, LiveTable};
use twintac_live::emulated_board;
use twintac_press::PressSettings;
use twintac_recording::Provenance;
use twintac_rig::xarm::ReportPort;
use twintac_rig::{BenchClock, netft};
use twintac_sensor::Sensor;
use twintac_shape::Pose;
use twintac_source::{Known, driver_settings};
use twintac_work::{At, WorkError};

use crate::OpenBench;
use crate::open::{Addresses, Tactile, connect};

/// The content of a file of faults.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FaultsFile {
    faults: Vec<ScheduledFault>,
}

/// Reads the faults of the emulated bench from a TOML file with tables `[[faults]]`.
///
/// # Errors
/// A file that cannot be read or is wrong; an impossible fault.
pub fn read_faults(file: &Path) -> Result<Vec<ScheduledFault>, WorkError> {
    let faults = twintac_config::read::<FaultsFile>(file)?.value.faults;
    check_faults(&faults).at(|| file.display().to_string())?;
    Ok(faults)
}

impl OpenBench {
    /// Starts emulated devices, with faults. `tables` are the responses of the gel at the locations
    /// that will be pressed.
    ///
    /// # Errors
    /// A sensor that is not read over a bus.
    pub fn emulate(
        sensor: &Arc<Sensor>,
        emulator: &EmulatorConfiguration,
        tables: &[LiveTable],
        settings: &PressSettings,
        faults: Vec<ScheduledFault>,
    ) -> Result<Self, WorkError> {
        let lab = Lab::new(Arc::clone(sensor), emulator.clone())?;
        let placement = &settings.placement;
        let (gel, selector) = lab.live(tables, placement.base_from_gel, placement.tool_from_indenter);

        let board = emulated_board(sensor);
        let mut devices = EmulatedBenchSettings {
            board,
            faults,
            ..EmulatedBenchSettings::default()
        };
        let noise_pa = 1e3 * emulator.readout.noise_kpa;
        devices.board.barometer.noise_pa = noise_pa; // the value for 1024 samples
        devices.board.noise_pa = Some(noise_pa);
        devices.board.seed = emulator.seed;
        devices.force.noise_n = emulator.robot.force_noise_n;
        devices.force.seed = emulator.seed;
        devices.robot.first_pose = placement.tool(&Pose::from_position(settings.travel_height_mm * DVec3::Z));
        let lab_clock = LabClock::real();
        let devices = EmulatedBench::start(lab_clock.clone(), gel, &devices)?;

        let configuration = netft::Client::read_configuration(&devices.force.page().to_string())?;
        let addresses = Addresses {
            commands: devices.robot.commands(),
            reports: devices.robot.reports(ReportPort::Development),
            force: (devices.force.requests(), configuration),
        };
        let clock = BenchClock::start();
        let mut driver = driver_settings(sensor)?;
        driver.conversion_us = settings.conversion_us;
        let taxels = PhysTac::new(devices.board.bus(), lab_clock, move || clock.now_us(), driver);
        let ((mut scl, mut sda), mut reset) = (devices.board.lines(), devices.board.reset_line());
        let free = move |_: &mut _, delay: &mut LabClock| {
            // If this does not free the bus, the next frame fails as well.
            let _ = reset_switch(&mut reset, delay);
            let _ = free_bus(&mut scl, &mut sda, delay);
        };
        let known = Known::default().or_emulated(sensor);
        let connected = Tactile::on_bus(taxels, free, sensor, &known)
            .and_then(|tactile| connect(&addresses, tactile, clock))
            .at(|| "connecting to the emulated bench".to_owned())?;
        Ok(Self {
            devices: connected.bench,
            transfer: connected.transfer,
            provenance: Provenance::Emulated,
            notes: connected.notes,
            robot: addresses.commands,
            emulator: Some(emulator.clone()),
            selector: Some(selector),
            _emulated: Some(devices),
        })
    }
}
