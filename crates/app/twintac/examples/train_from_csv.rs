//! Trains a twin of a sensor on presses from a CSV file. For your own sensor, write a description
//! of it and an import description of your file, like those here.
#![allow(clippy::print_stdout)] // programs print

use std::path::Path;

use twintac::{Caller, Error, Metrics, Run, RunSettings, Sensor};

fn main() -> Result<(), Error> {
    train(Path::new("runs/from-csv")).map(drop)
}

/// Starts a run in a folder, trains a twin and writes a report: takes about half a minute.
pub fn train(folder: &Path) -> Result<Metrics, Error> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/data");
    let sensor = Sensor::phystac()?; // or Sensor::read("my-sensor.toml")?

    let mut settings = RunSettings::default(); // coarse and short; use the defaults for a good twin
    settings.simulate.edges_per_height = 4.0;
    settings.simulate.edges_per_contact_radius = 4.0;
    settings.train.epochs = 40;

    let run = Run::start(folder, &sensor, "presses.csv", 1, settings, Caller::default())?;
    run.import(&data.join("import.toml"), &[data.join("presses.csv")])?;
    let metrics = run.finish()?;

    if let Some(percent) = metrics.twin.overall.nearest_in_contact_percent {
        println!(
            "{} ({} data): the twin errs by {percent:.1} % on {} presses that it never saw, see {}",
            metrics.sensor,
            metrics.provenance,
            metrics.held_out_presses,
            run.report_path().display()
        );
    }
    Ok(metrics)
}
