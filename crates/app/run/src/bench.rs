//! The presses of a run, carried out on a bench.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use twintac_emulate::ScheduledFault;
use twintac_lab::Reality;
use twintac_press::{Mounting, PressSettings, RunSummary};
use twintac_protocol::PressPlan;
use twintac_sensor::SensorFile;
use twintac_station::{Attended, OpenBench};
use twintac_work::WorkError;

use crate::Run;
use crate::run::{LOGS, SENSOR, keyed};

/// The logs in a run's folder, if there are any, are of this sensor, bench and placement: nothing has to be written to see that they are not.
///
/// # Errors
/// They are of others: what differs.
pub fn check_logs(
    folder: &Path,
    sensor: &SensorFile,
    reality: Option<&Reality>,
    settings: &PressSettings,
) -> Result<(), WorkError> {
    let sensor = keyed(sensor.kept_as(&folder.join(SENSOR))?);
    twintac_station::check_logs(&folder.join(LOGS), &sensor, reality, settings)
}

impl Run {
    /// The emulated bench, switched on, with faults. What its gel answers at the places of the plans is computed before, and kept in the run's folder.
    ///
    /// # Errors
    /// A place that the gel cannot be pressed at; a sensor that is not read this way.
    pub fn emulated_bench(
        &self,
        reality: &Reality,
        plans: &[PressPlan],
        settings: &PressSettings,
        faults: Vec<ScheduledFault>,
    ) -> Result<OpenBench, WorkError> {
        let tables = self.live_tables(reality, plans)?;
        OpenBench::emulate(&self.sensor().sensor, reality, &tables, settings, faults)
    }

    /// Carries presses out on a bench, those that are not done yet, and makes the run's recordings of them. `mount` has a person mount an
    /// indenter, as [`Operator::mount`](twintac_press::Operator::mount) says; the emulated bench asks nobody. Setting `interrupt` stops the bench.
    ///
    /// # Errors
    /// Those of [`OpenBench::press`], and presses that cannot be collected.
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
