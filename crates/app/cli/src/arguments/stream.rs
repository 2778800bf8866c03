//! What can be typed behind `twintac stream` and `twintac ports`.

use std::path::PathBuf;

use clap::{ArgGroup, Args, ValueEnum};

use super::Wire;

/// Streams start when nothing touches the sensor: a tare is taken from the first frames. Without `--format` and `--log` they are a dashboard.
#[derive(Args, Debug)]
#[command(group = ArgGroup::new("source").required(true), group = ArgGroup::new("written").multiple(true))]
pub(crate) struct Stream {
    #[command(flatten)]
    pub(crate) wire: Wire,
    /// Sensor description (TOML) [default: PhysTac].
    #[arg(long, value_name = "FILE")]
    pub(crate) sensor: Option<PathBuf>,
    /// How zeros move with temperature (TOML), as `twintac characterize` found it: it is taken off the readings.
    #[arg(long, value_name = "FILE")]
    pub(crate) temperature: Option<PathBuf>,
    /// Rows on standard output instead of the dashboard.
    #[arg(long, value_enum, group = "written")]
    pub(crate) format: Option<RowFormat>,
    /// Record all frames as they come into this log (MCAP), beside the rows of --format or alone, until the program is ended.
    #[arg(long, value_name = "FILE", value_parser = log_file, group = "written")]
    pub(crate) log: Option<PathBuf>,
    /// End after so many frames.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), requires = "written", conflicts_with = "out")]
    pub(crate) frames: Option<u64>,
    /// End after so long, s.
    #[arg(long, value_name = "S", value_parser = duration_s, requires = "written", conflicts_with = "out")]
    pub(crate) seconds: Option<f64>,
    /// Folder of the dashboard's recordings (MCAP).
    #[arg(long, value_name = "DIR", default_value = ".", conflicts_with = "written")]
    pub(crate) out: PathBuf,
}

/// `twintac ports`.
#[derive(Debug, Args)]
pub(crate) struct Ports {
    /// Listens to each serial port for so long, s, and says what comes: many boards start anew when their port is opened.
    #[arg(long, value_name = "S", value_parser = duration_s)]
    pub(crate) listen: Option<f64>,
    /// Bits a second to listen at.
    #[arg(long, value_name = "BAUD", default_value_t = 115_200, value_parser = clap::value_parser!(u32).range(300..))]
    pub(crate) baud: u32,
    /// JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
}

/// How frames are written.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum RowFormat {
    /// Comma-separated values under a header.
    Csv,
    /// A JSON object a line.
    Jsonl,
}

/// A name of a log.
fn log_file(name: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(name);
    if path.extension().is_some_and(|extension| extension == "mcap") {
        Ok(path)
    } else {
        Err("expected a name that ends in .mcap".to_owned())
    }
}

/// A time, s, that passes.
fn duration_s(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if f64::is_finite(seconds) && seconds > 0.0 => Ok(seconds),
        _ => Err("expected seconds, a finite number above 0".to_owned()),
    }
}
