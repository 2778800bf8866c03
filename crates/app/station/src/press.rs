//! Presses, carried out and logged.

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use serde::Serialize;
use twintac_lab::{Reality, Selector};
use twintac_log::Description;
use twintac_press::{Mounting, Operator, Placement, PressSettings, RunSummary, Runner, sensor_limits};
use twintac_protocol::PressPlan;
use twintac_rig::xarm::Client;
use twintac_sensor::SensorFile;
use twintac_shape::Pose;
use twintac_store::{Keyed, MadeFrom};
use twintac_work::{Progress, Work, WorkError};

use crate::OpenBench;

/// What presses of one folder have in common, besides how they are planned.
#[derive(Serialize)]
struct LogsOf<'a> {
    sensor: &'a Keyed<SensorFile>,
    /// Of the emulated bench; nothing of a real one.
    reality: Option<&'a Reality>,
    placement: &'a Placement,
}

/// Logs in a folder, if there are any, are of this sensor, bench and placement.
///
/// # Errors
/// They are of others: what differs.
pub fn check_logs(
    logs: &Path,
    sensor: &Keyed<SensorFile>,
    reality: Option<&Reality>,
    settings: &PressSettings,
) -> Result<(), WorkError> {
    Ok(made_from(sensor, reality, settings)?.check(logs)?)
}

fn made_from(
    sensor: &Keyed<SensorFile>,
    reality: Option<&Reality>,
    settings: &PressSettings,
) -> Result<MadeFrom, WorkError> {
    Ok(MadeFrom::without_program(&LogsOf {
        sensor,
        reality,
        placement: &settings.placement,
    })?)
}

/// Who is at the bench while it presses.
pub struct Attended<'a> {
    /// Setting it stops the bench.
    pub interrupt: &'a AtomicBool,
    /// Has a person mount an indenter, as [`Operator::mount`] says; the emulated bench asks nobody.
    pub mount: &'a mut dyn FnMut(&str) -> Mounting,
    /// Hears how the work goes.
    pub progress: &'a dyn Progress,
}

impl OpenBench {
    /// Carries presses out, those whose logs are not in the folder yet.
    ///
    /// # Errors
    /// A sensor without limits; settings or plans that cannot be carried out; a folder that holds other presses; a disk that fails. A bench
    /// that was stopped is no error: the summary says why.
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
        made_from(sensor, self.reality.as_ref(), &settings)?.claim(logs)?;
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

    /// What the logs are about.
    fn description(&self, file: &SensorFile) -> Description {
        let sensor = &file.sensor;
        let version = env!("CARGO_PKG_VERSION").to_owned();
        Description {
            sensor: sensor.name.clone(),
            sensor_toml: file.text.clone(),
            provenance: self.provenance,
            taxels: sensor.taxels.iter().map(|taxel| taxel.name.clone()).collect(),
            transfer: self.transfer.as_ref().map(twintac_source::confirmed_transfer),
            // Set by the runner.
            base_from_gel: Pose::IDENTITY,
            tool_from_indenter: Pose::IDENTITY,
            force_axis: glam::DVec3::NEG_Z,
            start_unix_ns: 0,
            versions: BTreeMap::from([("twintac".to_owned(), version)]),
        }
    }
}

/// Stops a robot that did not confirm its stop over a connection of its own; how that went.
fn stop_anew(robot: SocketAddr) -> String {
    match Client::connect(robot).and_then(|mut robot| robot.stop()) {
        Ok(()) => "the robot was stopped over a second connection".to_owned(),
        Err(error) => format!(
            "the robot may still be pressing and cannot be told to stop ({error}): press its emergency stop"
        ),
    }
}

/// Has indenters mounted: by a person, or in the lab by itself.
struct Attendant<'a> {
    work: Work<'a>,
    /// Presses that have begun or were done before.
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
            // The tables are those of the same plans.
            let _ = selector.select(&plan.name);
        }
    }
}
