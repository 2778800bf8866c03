//! The demo: a run that needs neither hardware nor data.

use std::path::Path;

use digitac::TrainSettings;
use twintac_lab::EmulatorConfiguration;
use twintac_sensor::SensorFile;
use twintac_simulate::SimulateSettings;
use twintac_store::write_file;
use twintac_work::{Caller, Planned, WorkError};

use crate::built_in::{DEMO_PROTOCOL, EMULATOR};
use crate::{Run, RunSettings};

impl Run {
    /// Starts the demo and makes its recordings: PhysTac, pressed along the built-in protocol on
    /// the emulated bench. [`finish`](Self::finish) does the rest. The whole demo takes a minute.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn demo(folder: &Path, seed: u64, caller: Caller) -> Result<Self, WorkError> {
        let sensor = SensorFile::phystac()?;
        let emulator = EmulatorConfiguration::parse(EMULATOR.name, EMULATOR.text)?;
        let planned = Planned::parse(DEMO_PROTOCOL.name, DEMO_PROTOCOL.text, &sensor.sensor, seed)?;
        let source = format!("{} presses on the emulated bench", planned.presses.len());
        let run = Self::start(folder, sensor, &source, seed, settings(), caller)?;
        write_file(&folder.join("protocol.toml"), DEMO_PROTOCOL.text.as_bytes())?;
        write_file(&folder.join("emulator.toml"), EMULATOR.text.as_bytes())?;
        run.emulate(&emulator, &planned)?;
        Ok(run)
    }
}

/// Coarser and shorter than the defaults, so that the demo takes minutes.
fn settings() -> RunSettings {
    RunSettings {
        simulate: SimulateSettings {
            edges_per_height: 6.0,
            edges_per_contact_radius: 5.0,
            ..SimulateSettings::default()
        },
        train: TrainSettings {
            epochs: 120,
            ..TrainSettings::default()
        },
        ..RunSettings::default()
    }
}
