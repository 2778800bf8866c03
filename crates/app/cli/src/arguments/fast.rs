//! Arguments of `twintac fast`.

use std::path::PathBuf;

use clap::{ArgGroup, Args};

/// Random presses of the gel are solved with finite elements, and networks are trained on them. The
/// surrogate is then evaluated on presses that were not used for training. Solved presses are kept,
/// so a training that was killed continues.
#[derive(Args, Debug)]
pub(crate) struct FastTrain {
    /// Sensor description (TOML).
    #[arg(long, value_name = "FILE")]
    pub(crate) sensor: PathBuf,
    /// Folder of the solved presses, the surrogate and its evaluation.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Number of training presses [default: 2000].
    #[arg(long, alias = "lessons", value_name = "N", value_parser = clap::value_parser!(u64).range(5..))]
    pub(crate) training_presses: Option<u64>,
    /// Number of test presses of shapes that are not used for training [default: 100].
    #[arg(long, alias = "exams", value_name = "N")]
    pub(crate) test_presses: Option<u64>,
    /// Number of test presses of such shapes that slide and tilt [default: 40].
    #[arg(long, value_name = "N")]
    pub(crate) slides: Option<u64>,
    /// Press only with the sensor's own indenters, upright and near its ports, for the twin of a
    /// test setup (`fast_gel` in a run's settings); no press slides then.
    #[arg(long, conflicts_with = "slides")]
    pub(crate) own_indenters: bool,
    /// Number of training steps [default: 80000].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) steps: Option<u64>,
    /// Seed of all random choices.
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    /// Print the evaluation as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Each field has a comment: its source (real or emulated), its uncertainty, and the number of
/// values. What neither model nor recordings show is left out, with the reason. Without --out the
/// file is printed.
#[derive(Args, Debug)]
#[command(group = ArgGroup::new("source").required(true).multiple(true))]
pub(crate) struct FastVariation {
    /// Folder of a trained model: a run's `model`. It shows how taxels differ in gain and static
    /// nonlinearity, and how installations differ in contact height, position and yaw.
    #[arg(long, value_name = "DIR", group = "source")]
    pub(crate) model: Option<PathBuf>,
    /// Recordings of the sensor: presses.parquet files, MCAP logs, CSV files, or patterns. They
    /// show noise, resolution, zeros, drift with temperature, hysteresis, frame rate, jitter, and
    /// failing taxels.
    #[arg(long, value_name = "FILES", num_args = 1.., group = "source")]
    pub(crate) recordings: Vec<String>,
    /// Import description of CSV recordings (TOML) [default: the file that --sensor names].
    #[arg(long, value_name = "FILE", requires = "recordings")]
    pub(crate) import: Option<PathBuf>,
    /// The sensor's name in the recordings, if it differs.
    #[arg(long, value_name = "NAME", requires = "recordings")]
    pub(crate) recorded_as: Option<String>,
    /// Sensor description (TOML) [default: the model's].
    #[arg(long, value_name = "FILE", required_unless_present = "model")]
    pub(crate) sensor: Option<PathBuf>,
    /// File to write (TOML, a table [variation]).
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}
