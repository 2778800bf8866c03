//! Carries presses out and logs them.

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use serde::Serialize;
use twintac_lab::{EmulatorConfiguration, Selector};
use twintac_log::Description;
use twintac_press::{Mounting, Operator, Placement, PressSettings, RunSummary, Runner, sensor_limits};
use twintac_protocol::PressPlan;
use twintac_rig::xarm::Client;
use twintac_sensor::SensorFile;
use twintac_shape::Pose;
use twintac_store::{Keyed, MadeFrom};
use twintac_work::{Progress, Work, WorkError};

use crate::OpenBench;

/// What the logs of one folder have in common, besides the plans.
#[derive(Serialize)]
struct LogsOf<'a> {
    sensor: &'a Keyed<SensorFile>,
    /// The emulator configuration; `None` for a real bench.
    emulator: Option<&'a EmulatorConfiguration>,
    placement: &'a Placement,
}

/// Checks that the logs in a folder, if there are any, belong to this sensor, bench and placement.
///
/// # Errors
/// The logs belong to something else; the error names the difference.
pub fn check_logs(
    logs: &Path,
    sensor: &Keyed<SensorFile>,
    emulator: Option<&EmulatorConfiguration>,
    settings: &PressSettings,
) -> Result<(), WorkError> {
    Ok(made_from(sensor, emulator, settings)?.check(logs)?)
}

fn made_from(
    sensor: &Keyed<SensorFile>,
    emulator: Option<&EmulatorConfiguration>,
    settings: &PressSettings,
) -> Result<MadeFrom, WorkError> {
    Ok(MadeFrom::without_program(&LogsOf {
        sensor,
        emulator,
        placement: &settings.placement,
    })?)
}

/// The caller's side of a bench while it presses.
pub struct Attended<'a> {
    /// Setting it stops the bench.
    pub interrupt: &'a AtomicBool,
    /// Asks a person to mount an indenter, as [`Operator::mount`] does. The emulated bench does not
    /// call it.
    pub mount: &'a mut dyn FnMut(&str) -> Mounting,
    /// Receives the progress of the work.
    pub progress: &'a dyn Progress,
}

impl OpenBench {
    /// Carries out the presses whose logs are not in the folder yet.
    ///
    /// # Errors
    /// A sensor without limits; settings or plans that cannot be carried out; a folder that holds
    /// other presses; a disk that fails. A bench that was stopped is no error: the summary says
    /// why.
    pub fn press(
        &mut self,
        sensor: &Keyed<SensorFile>,
        settings: PressSettings,
        plans: &[PressPlan],
        logs: &Path,
        attended: Attended<'_>,
    ) -> Result<RunSummary, WorkError> {
        let Attended {
            interrupt,
            mount,
            progress,
        } = attended;
        let limits = sensor_limits(&sensor.sensor)?;
        made_from(sensor, self.emulator.as_ref(), &settings)?.claim(logs)?;
        let runner = Runner::new(settings, limits, self.description(sensor))?;
        let mut attendant = Attendant {
            work: Work::start(progress, "pressing", plans.len()),
            n_begun: 0,
            selector: self.selector.as_ref(),
            mount,
        };
        let summary = runner.run(&mut self.devices, plans, logs, interrupt, &mut attendant)?;
        drop(attendant);
        for remark in &summary.remarks {
            progress.note(remark);
        }
        if !summary.is_stop_confirmed {
            progress.note(&stop_anew(self.robot));
        }
        Ok(summary)
    }

    /// The description in every log.
    fn description(&self, file: &SensorFile) -> Description {
        let sensor = &file.sensor;
        let version = env!("CARGO_PKG_VERSION").to_owned();
        Description {
            sensor: sensor.name.clone(),
            sensor_toml: file.text.clone(),
            provenance: self.provenance,
            taxels: sensor.taxels.iter().map(|taxel| taxel.name.clone()).collect(),
            transfer: self.transfer.as_ref().map(twintac_source::confirmed_transfer),
            // The runner sets these.
            base_from_gel: Pose::IDENTITY,
            tool_from_indenter: Pose::IDENTITY,
            force_axis: glam::DVec3::NEG_Z,
            start_unix_ns: 0,
            versions: BTreeMap::from([("twintac".to_owned(), version)]),
        }
    }
}

/// Stops a robot that did not confirm its stop, over a new connection; returns the result in words.
fn stop_anew(robot: SocketAddr) -> String {
    match Client::connect(robot).and_then(|mut robot| robot.stop()) {
        Ok(()) => "the robot was stopped over a second connection".to_owned(),
        Err(error) => format!(
            "the robot may still be pressing and cannot be stopped ({error}): press its emergency stop"
        ),
    }
}

/// Handles the mounting of indenters: a person mounts them, or the emulator changes them itself.
struct Attendant<'a> {
    work: Work<'a>,
    /// Number of presses that have begun or were done before.
    n_begun: usize,
    selector: Option<&'a Selector>,
    mount: &'a mut dyn FnMut(&str) -> Mounting,
}

impl Operator for Attendant<'_> {
    fn mount(&mut self, indenter: &str) -> Mounting {
        match self.selector {
            Some(_) => Mounting::Mounted,
            None => (self.mount)(indenter),
        }
    }

    fn begin(&mut self, index: usize, plan: &PressPlan) {
        (self.n_begun..index).for_each(|_| self.work.step(""));
        self.n_begun = index;
        if let Some(selector) = self.selector {
            // The tables were made from the same plans.
            let _ = selector.select(&plan.name);
        }
    }
}
