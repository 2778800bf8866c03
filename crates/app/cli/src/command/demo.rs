//! `twintac demo`: the emulated bench, from nothing.

use anyhow::Result;
use digitac::TrainSettings;
use twintac_lab::Reality;
use twintac_simulate::SimulateSettings;

use crate::arguments::Demo;
use twintac_run::built_in::{DEMO_PROTOCOL, REALITY};
use twintac_run::cache::write_file;
use twintac_run::run::Run;
use twintac_run::sensor_file::SensorFile;
use twintac_run::settings::RunSettings;
use twintac_run::stages::recordings::plan_text;

/// Runs every stage on the emulated bench.
pub(crate) fn run(arguments: &Demo) -> Result<()> {
    let sensor = SensorFile::or_phystac(None)?;
    let reality = Reality::parse(REALITY.name, REALITY.text)?;
    let plans = plan_text(
        DEMO_PROTOCOL.name,
        DEMO_PROTOCOL.text,
        &sensor.sensor,
        arguments.seed,
    )?;
    let source = format!("{} presses on the emulated bench", plans.len());
    let run = Run::start(&arguments.out, sensor, source, arguments.seed, settings())?;
    write_file(&run.folder.join("protocol.toml"), DEMO_PROTOCOL.text.as_bytes())?;
    write_file(&run.folder.join("reality.toml"), REALITY.text.as_bytes())?;
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
