//! Arguments of `twintac stream` and `twintac ports`.

use std::path::PathBuf;

use clap::{ArgGroup, Args, ValueEnum};

use super::Wire;

/// Start when nothing touches the sensor: the first frames are used for the tare. Without
/// `--format` and `--log` the frames are shown on a dashboard.
#[derive(Args, Debug)]
#[command(group = ArgGroup::new("source").required(true), group = ArgGroup::new("written").multiple(true))]
pub(crate) struct Stream {
    #[command(flatten)]
    pub(crate) wire: Wire,
    /// Sensor description (TOML) [default: PhysTac].
    #[arg(long, value_name = "FILE")]
    pub(crate) sensor: Option<PathBuf>,
    /// Temperature coefficients of the zeros (TOML), made by `twintac characterize`: readings are
    /// compensated.
    #[arg(long, value_name = "FILE")]
    pub(crate) temperature: Option<PathBuf>,
    /// Write rows to standard output instead of the dashboard.
    #[arg(long, value_enum, group = "written")]
    pub(crate) format: Option<RowFormat>,
    /// Record all frames as they come into this log (MCAP), with or without the rows of --format,
    /// until the program ends.
    #[arg(long, value_name = "FILE", value_parser = log_file, group = "written")]
    pub(crate) log: Option<PathBuf>,
    /// End after this many frames.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), requires = "written", conflicts_with = "out")]
    pub(crate) frames: Option<u64>,
    /// End after this time, s.
    #[arg(long, value_name = "S", value_parser = duration_s, requires = "written", conflicts_with = "out")]
    pub(crate) seconds: Option<f64>,
    /// Folder of the recordings that the dashboard makes (MCAP).
    #[arg(long, value_name = "DIR", default_value = ".", conflicts_with = "written")]
    pub(crate) out: PathBuf,
}

/// Arguments of `twintac ports`.
#[derive(Debug, Args)]
pub(crate) struct Ports {
    /// Listen to each serial port for this time, s, and describe what arrives; many boards restart
    /// when their port is opened.
    #[arg(long, value_name = "S", value_parser = duration_s)]
    pub(crate) listen: Option<f64>,
    /// Baud rate for listening.
    #[arg(long, value_name = "BAUD", default_value_t = 115_200, value_parser = clap::value_parser!(u32).range(300..))]
    pub(crate) baud: u32,
    /// Print JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Format of the rows.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum RowFormat {
    /// Comma-separated values with a header.
    Csv,
    /// One JSON object per line.
    Jsonl,
}

/// The name of a log.
fn log_file(name: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(name);
    if path.extension().is_some_and(|extension| extension == "mcap") {
        Ok(path)
    } else {
        Err("expected a name that ends in .mcap".to_owned())
    }
}

/// A positive duration, s.
fn duration_s(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if f64::is_finite(seconds) && seconds > 0.0 => Ok(seconds),
        _ => Err("expected seconds, a finite number above 0".to_owned()),
    }
}
