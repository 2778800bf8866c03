//! `twintac demo`: the emulated bench, from nothing.

use anyhow::Result;
use digitac::TrainSettings;
use twintac_lab::Reality;
use twintac_simulate::SimulateSettings;

use crate::arguments::Demo;
use crate::run::{Run, RunSettings, plan_text};
use crate::sensor_file::SensorFile;
use crate::stage::write_file;

pub(super) const SENSOR: &str = include_str!("../../../../sensors/phystac.toml");
const PROTOCOL: &str = include_str!("../../../../protocols/demo.toml");
pub(super) const REALITY: &str = include_str!("../../../../realities/default.toml");

/// Runs every stage on the emulated bench.
pub(crate) fn run(arguments: &Demo) -> Result<()> {
    let sensor = SensorFile::built_in("sensors/phystac.toml", SENSOR)?;
    let reality = Reality::parse("realities/default.toml", REALITY)?;
    let plans = plan_text("protocols/demo.toml", PROTOCOL, &sensor.sensor, arguments.seed)?;
    let source = format!("{} presses on the emulated bench", plans.len());
    let run = Run::start(&arguments.out, sensor, source, arguments.seed, settings())?;
    write_file(&run.folder.join("protocol.toml"), PROTOCOL.as_bytes())?;
    write_file(&run.folder.join("reality.toml"), REALITY.as_bytes())?;
    run.record(&reality, &plans, &[])?;
    super::stages::finish(&run)
}

/// Coarser and shorter than usual: the demo has minutes.
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
