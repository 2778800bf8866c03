//! The emulated sensor, live: `cargo run --release -p twintac-live --example stream`; with `csv` or `jsonl` behind `--`, as rows.

use std::error::Error;
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use twintac_emulate::LabClock;
use twintac_live::{About, Format, FrameReader, FrameSource, Lab, Limits, dashboard, power_on, stream_rows};
use twintac_recording::Provenance;
use twintac_sensor::Sensor;

fn main() -> Result<(), Box<dyn Error>> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../sensors/phystac.toml");
    let sensor = Sensor::read(path)?;
    let start_unix_ns = SystemTime::now().duration_since(UNIX_EPOCH)?.as_nanos() as u64; // until the year 2554
    let mut phystac = Lab::new(&sensor, LabClock::real(), &[])?.phystac;
    let transfer = power_on(&mut phystac, &sensor, Some(8))?.transfer;
    let text = std::fs::read_to_string(path)?;
    let about = About::new(&sensor, &text, Provenance::Emulated, transfer, start_unix_ns);
    let mut source = FrameSource::start(FrameReader::new(phystac, transfer), FrameSource::USUAL_CAPACITY)?;
    let limits = Limits {
        frames: None,
        seconds: Some(10.0),
    };
    match std::env::args().nth(1).as_deref() {
        None => drop(dashboard::run(&mut source, about, Path::new("."))?),
        Some("csv") => drop(stream_rows(
            &mut source,
            &about,
            Format::Csv,
            limits,
            std::io::stdout(),
        )?),
        Some("jsonl") => drop(stream_rows(
            &mut source,
            &about,
            Format::JsonLines,
            limits,
            std::io::stdout(),
        )?),
        Some(other) => return Err(format!("{other} is no format").into()),
    }
    Ok(())
}
