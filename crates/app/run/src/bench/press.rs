//! The presses of a run, carried out.

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::sync::atomic::AtomicBool;

use serde::Serialize;
use twintac_lab::{Reality, Selector};
use twintac_log::Description;
use twintac_press::{Mounting, Operator, Placement, PressSettings, RunSummary, Runner, sensor_limits};
use twintac_protocol::PressPlan;
use twintac_rig::xarm::Client;
use twintac_shape::Pose;
use twintac_store::{Keyed, MadeFrom};

use super::OpenBench;
use crate::progress::Work;
use crate::{Run, RunError, SensorFile};

/// What presses of one folder have in common, besides how they are planned.
#[derive(Serialize)]
struct LogsOf<'a> {
    sensor: &'a Keyed<SensorFile>,
    /// Of the emulated bench; nothing of a real one.
    reality: Option<&'a Reality>,
    placement: &'a Placement,
}

impl Run {
    /// Carries presses out on a bench, those that are not done yet, and makes the run's recordings of them. `mount` has a person mount an
    /// indenter, as [`Operator::mount`] says; the emulated bench asks nobody. Setting `interrupt` stops the bench.
    ///
    /// # Errors
    /// A sensor without limits; settings or plans that cannot be carried out; a folder that holds other presses; a disk that fails. A bench
    /// that was stopped is no error: the summary says why.
    pub fn press(
        &self,
        bench: &mut OpenBench,
        settings: PressSettings,
        plans: &[PressPlan],
        interrupt: &AtomicBool,
        mount: &mut dyn FnMut(&str) -> Mounting,
    ) -> Result<RunSummary, RunError> {
        let limits = sensor_limits(&self.sensor().sensor)?;
        let logs = self.logs_folder();
        let made_from = LogsOf {
            sensor: self.keyed_sensor(),
            reality: bench.reality.as_ref(),
            placement: &settings.placement,
        };
        MadeFrom::without_program(&made_from)?.claim(&logs)?;
        let runner = Runner::new(settings, limits, self.description(bench))?;
        let mut attendant = Attendant {
            work: Work::start(self.progress(), "pressing", plans.len()),
            n_begun: 0,
            selector: bench.selector.as_ref(),
            mount,
        };
        let summary = runner.run(&mut bench.devices, plans, &logs, interrupt, &mut attendant)?;
        drop(attendant);
        for remark in &summary.remarks {
            self.progress().note(remark);
        }
        if !summary.is_stop_confirmed {
            self.progress().note(&stop_anew(bench.robot));
        }
        if summary.presses_done > 0 {
            self.collect(&logs, plans)?;
        }
        Ok(summary)
    }

    /// What the logs are about.
    fn description(&self, bench: &OpenBench) -> Description {
        let sensor = &self.sensor().sensor;
        let version = env!("CARGO_PKG_VERSION").to_owned();
        Description {
            sensor: sensor.name.clone(),
            sensor_toml: self.sensor().text.clone(),
            provenance: bench.provenance,
            taxels: sensor.taxels.iter().map(|taxel| taxel.name.clone()).collect(),
            transfer: Some(twintac_live::confirmed_transfer(&bench.transfer)),
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
