//! `twintac simulate`: a protocol or a path on the simulated gel, or the locations of a run.

use std::sync::Arc;
use std::time::Duration;

use anyhow::Result;
use twintac_gel::simulate_settings;
use twintac_gel::simulated::simulate_presses;
use twintac_run::Run;
use twintac_sensor::SensorFile;
use twintac_simulate::{Gel, SimulateSettings};
use twintac_work::Planned;

use crate::Program;
use crate::arguments::Simulate;
use crate::progress::Bars;

/// Simulates, and writes one table over depth for each press.
pub(crate) fn run(arguments: &Simulate, program: &Program) -> Result<()> {
    if let Some(folder) = &arguments.run {
        let run = Run::open(folder, program.caller()?)?;
        run.mesh()?;
        return Ok(run.simulate()?);
    }
    let Some(sensor) = &arguments.sensor else {
        anyhow::bail!("give --run, or --sensor with --protocol or --path");
    };
    let sensor = SensorFile::read(sensor)?.sensor;
    let settings = simulate_settings(SimulateSettings::fine(), arguments.settings.as_deref())?;
    if let Some(path) = &arguments.path {
        let mut gel = Gel::new(Arc::clone(&sensor), settings);
        if let Some(deadline_ms) = arguments.deadline_ms {
            gel = gel.with_deadline(Duration::from_millis(deadline_ms.into()));
        }
        return super::follow::run(&gel, path, arguments);
    }
    let (Some(protocol), Some(out)) = (&arguments.protocol, &arguments.out) else {
        anyhow::bail!("give --protocol and --out, or --path");
    };
    let plans = Planned::read(protocol, &sensor, arguments.seed)?.presses;
    simulate_presses(&sensor, &settings, &plans, out, arguments.vtk, &Bars::default())?;
    Ok(())
}
