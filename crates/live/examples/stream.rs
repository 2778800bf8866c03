//! The emulated sensor, live: `cargo run --release -p twintac-live --example stream`; with `csv` or `jsonl` behind `--`, ten seconds as rows.

use std::error::Error;
use std::path::Path;

use twintac_live::{Format, Limits, Live, dashboard, stream_rows};
use twintac_sensor::Sensor;

fn main() -> Result<(), Box<dyn Error>> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../sensors/phystac.toml");
    let sensor = Sensor::read(path)?;
    let Live {
        mut source, about, ..
    } = Live::in_the_lab(&sensor, &std::fs::read_to_string(path)?, Some(8))?;
    let format = match std::env::args().nth(1).as_deref() {
        None => {
            dashboard::run(&mut source, about, Path::new("."))?;
            return Ok(());
        }
        Some("csv") => Format::Csv,
        Some("jsonl") => Format::JsonLines,
        Some(other) => return Err(format!("{other} is no format").into()),
    };
    let limits = Limits {
        frames: None,
        seconds: Some(10.0),
    };
    stream_rows(&mut source, &about, format, limits, std::io::stdout().lock())?;
    Ok(())
}
