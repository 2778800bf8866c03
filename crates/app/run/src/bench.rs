//! The presses of a run, carried out on a bench.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use twintac_emulate::ScheduledFault;
use twintac_lab::EmulatorConfiguration;
use twintac_press::{Mounting, PressSettings, RunSummary};
use twintac_protocol::PressPlan;
use twintac_sensor::SensorFile;
use twintac_station::{Attended, OpenBench};
use twintac_work::WorkError;

use crate::Run;
use crate::run::{LOGS, SENSOR, keyed};

/// Checks that the logs in a run's folder, if there are any, belong to this sensor, bench and
/// placement. Nothing is written.
///
/// # Errors
/// The logs belong to something else; the error names the difference.
pub fn check_logs(
    folder: &Path,
    sensor: &SensorFile,
    emulator: Option<&EmulatorConfiguration>,
    settings: &PressSettings,
) -> Result<(), WorkError> {
    let sensor = keyed(sensor.kept_as(&folder.join(SENSOR))?);
    twintac_station::check_logs(&folder.join(LOGS), &sensor, emulator, settings)
}

impl Run {
    /// Starts the emulated bench, with faults. The response of its gel at the locations of the
    /// plans is computed first, and kept in the run's folder.
    ///
    /// # Errors
    /// A location at which the gel cannot be pressed; a sensor that is not read over a bus.
    pub fn emulated_bench(
        &self,
        emulator: &EmulatorConfiguration,
        plans: &[PressPlan],
        settings: &PressSettings,
        faults: Vec<ScheduledFault>,
    ) -> Result<OpenBench, WorkError> {
        let tables = self.live_tables(emulator, plans)?;
        OpenBench::emulate(&self.sensor().sensor, emulator, &tables, settings, faults)
    }

    /// Carries out the presses that are not done yet on a bench, and makes the run's recordings of
    /// the logs. `mount` asks a person to mount an indenter, as
    /// [`Operator::mount`](twintac_press::Operator::mount) does; the emulated bench does not call
    /// it. Setting `interrupt` stops the bench.
    ///
    /// # Errors
    /// Those of [`OpenBench::press`]; presses that cannot be collected.
    pub fn press(
        &self,
        bench: &mut OpenBench,
        settings: PressSettings,
        plans: &[PressPlan],
        interrupt: &AtomicBool,
        mount: &mut dyn FnMut(&str) -> Mounting,
    ) -> Result<RunSummary, WorkError> {
        let logs = self.logs_folder();
        let attended = Attended {
            interrupt,
            mount,
            progress: self.progress(),
        };
        let summary = bench.press(self.keyed_sensor(), settings, plans, &logs, attended)?;
        if summary.presses_done > 0 {
            self.collect(&logs, plans)?;
        }
        Ok(summary)
    }
}
