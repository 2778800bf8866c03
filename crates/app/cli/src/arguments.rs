//! Command-line arguments.

#[cfg(test)]
mod conflicts;
mod dataset;
mod design;
mod fast;
mod stream;
mod view;
mod wire;

use std::path::PathBuf;

pub(crate) use dataset::Dataset;
pub(crate) use design::Design;
pub(crate) use fast::{FastTrain, FastVariation};
pub(crate) use stream::{Ports, RowFormat, Stream};
pub(crate) use view::View;
pub(crate) use wire::Wire;

use clap::{ArgGroup, Args, Parser, Subcommand};
use twintac_gel::mesh::LengthUnit;

/// Barometric touch sensors and their digital twin.
///
/// `demo` needs neither hardware nor data. `reproduce` does the same with recordings of a real
/// sensor. Both run these stages, which are also commands of their own: record or import, mesh,
/// simulate, align, train, evaluate, report.
#[derive(Debug, Parser)]
#[command(name = "twintac", version)]
pub(crate) struct Arguments {
    /// The command to run.
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Number of threads; the results do not depend on it [default: one per core].
    #[arg(long, global = true, value_name = "N")]
    pub(crate) threads: Option<usize>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run every stage on the emulated bench; needs no hardware and no data, and takes a minute.
    Demo(Demo),
    /// Run every stage on recordings of a real sensor.
    Reproduce(Reproduce),
    /// Show a sensor description.
    #[command(subcommand)]
    Sensor(SensorCommand),
    /// Mesh a sensor's gel, or check a Gmsh mesh.
    Mesh(Mesh),
    /// Press the simulated gel along a protocol.
    Simulate(Simulate),
    /// Press the simulated gel interactively on a web page, beside a sensor if one is connected.
    View(View),
    /// Simulate many presses as training data, in shards on any number of machines.
    Dataset(Dataset),
    /// Compare designs of a sensor, which differ in numbers of its description, before one is cast.
    Design(Design),
    /// Fit the gel's material to measured presses.
    Calibrate(Calibrate),
    /// Measure a sensor's properties in recorded presses: sensitivity, noise, hysteresis, and more.
    Characterize(Characterize),
    /// List the ports that a sensor may be connected to, and what arrives there.
    Ports(Ports),
    /// Show a sensor's frames live, on a dashboard or as rows of text.
    Stream(Stream),
    /// Press a sensor along a protocol and record it, on a test setup with a robot or on the
    /// emulated bench.
    Record(Record),
    /// Export logs as Parquet tables, ROS 2 bags or LeRobot data sets; recover logs that were cut.
    Export(Export),
    /// Import recordings of a real sensor.
    Import(Import),
    /// Pair recorded presses with simulated ones.
    Align(Align),
    /// Train a twin on paired frames.
    Train(Train),
    /// Evaluate a twin on recordings.
    Evaluate(Evaluate),
    /// Adapt a trained twin to another sensor of the same kind with a few presses.
    Adapt(Adapt),
    /// Cross-validate twins of a run's recordings, for several seeds and ways to hold presses out.
    CrossValidate(CrossValidate),
    /// Predict a sensor's readings along a path or a protocol by its trained twin.
    Predict(Predict),
    /// Estimate where and how deep a sensor is touched, from its readings by its trained twin.
    Locate(Locate),
    /// Train the surrogate of a gel (without finite elements), and estimate sensor variation.
    #[command(subcommand)]
    Fast(FastCommand),
    /// Write the report of a run.
    Report(Report),
}

#[derive(Debug, Subcommand)]
pub(crate) enum FastCommand {
    /// Train a surrogate of the gel from a sensor's description alone.
    Train(FastTrain),
    /// Estimate sensor variation from a trained model and recordings: a file for many simulated
    /// sensors.
    #[command(alias = "imperfection")]
    Variation(FastVariation),
}

#[derive(Args, Debug)]
pub(crate) struct Demo {
    /// Folder of the run.
    #[arg(long, value_name = "DIR", default_value = "runs/demo")]
    pub(crate) out: PathBuf,
    /// Seed of all random choices.
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
}

/// Options of every new run.
#[derive(Args, Debug)]
pub(crate) struct Start {
    /// Settings (TOML) that differ from the defaults: any field of a run's run.json, in tables such
    /// as [simulate] and [train].
    #[arg(long, value_name = "FILE")]
    pub(crate) settings: Option<PathBuf>,
    /// Temperature coefficients of the zeros (TOML), made by `twintac characterize`: recordings
    /// with temperatures are compensated, and the model keeps the coefficients.
    #[arg(long, value_name = "FILE")]
    pub(crate) temperature: Option<PathBuf>,
    /// Seed of all random choices.
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
}

/// Recordings, and how to read them.
#[derive(Args, Debug)]
pub(crate) struct Reproduce {
    /// Repeat the experiments of the TwinTac paper on the emulated bench instead; takes hours.
    #[arg(long, conflicts_with_all = ["sensor", "recordings", "import", "settings", "temperature"])]
    pub(crate) paper: bool,
    /// With --paper: few presses on a simple emulated bench, to check that everything runs; takes
    /// minutes.
    #[arg(long, requires = "paper", conflicts_with_all = ["sensor", "recordings", "import", "settings", "temperature"])]
    pub(crate) quick: bool,
    /// Sensor description (TOML).
    #[arg(long, value_name = "FILE", required_unless_present = "paper")]
    pub(crate) sensor: Option<PathBuf>,
    /// Recordings: CSV files or patterns like 'data/*.csv'.
    #[arg(long, value_name = "FILES", num_args = 1.., required_unless_present = "paper")]
    pub(crate) recordings: Vec<String>,
    /// Import description of the recordings (TOML) [default: the file that the sensor description
    /// names].
    #[arg(long, value_name = "FILE")]
    pub(crate) import: Option<PathBuf>,
    /// Folder of the run [default: runs/<sensor>, or runs/paper].
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print the figures of --paper as JSON.
    #[arg(long, requires = "paper", conflicts_with_all = ["sensor", "recordings", "import", "settings", "temperature"])]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) start: Start,
}

#[derive(Debug, Subcommand)]
pub(crate) enum SensorCommand {
    /// Print a sensor description with units, and draw it.
    Show(SensorShow),
}

#[derive(Args, Debug)]
pub(crate) struct SensorShow {
    /// Sensor description (TOML).
    pub(crate) file: PathBuf,
    /// Draw the sensor, top view and section, into this PNG or SVG file.
    #[arg(long, value_name = "FILE")]
    pub(crate) draw: Option<PathBuf>,
}

#[derive(Args, Debug)]
pub(crate) struct Mesh {
    /// Sensor description (TOML) whose gel to mesh.
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with = "check",
        required_unless_present = "check"
    )]
    pub(crate) sensor: Option<PathBuf>,
    /// Edge length, mm [default: a sixth of the gel's height].
    #[arg(long, value_name = "MM", conflicts_with_all = ["nodes", "check"])]
    pub(crate) edge_mm: Option<f64>,
    /// Number of nodes, within 10 %.
    #[arg(long, value_name = "N", conflicts_with = "check")]
    pub(crate) nodes: Option<usize>,
    /// Read a Gmsh file instead and print its quality.
    #[arg(long, value_name = "FILE")]
    pub(crate) check: Option<PathBuf>,
    /// Unit of length in that file: mm, cm, m or inch.
    #[arg(long, value_name = "UNIT", default_value = "mm", conflicts_with = "sensor")]
    pub(crate) unit: LengthUnit,
    /// Folder to write gel.msh, gel.vtu, gel.stl and quality.json to.
    #[arg(long, value_name = "DIR", conflicts_with = "check")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Args, Debug)]
pub(crate) struct Simulate {
    /// Folder of a run: simulate the locations of its presses, and calibrate its test setup.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["sensor", "protocol", "out", "path", "settings", "vtk", "seed"])]
    pub(crate) run: Option<PathBuf>,
    /// Sensor description (TOML).
    #[arg(long, value_name = "FILE")]
    pub(crate) sensor: Option<PathBuf>,
    /// Press protocol (TOML).
    #[arg(long, value_name = "FILE", requires = "sensor", requires = "out")]
    pub(crate) protocol: Option<PathBuf>,
    /// Folder to write to: one table over depth for each press.
    #[arg(long, value_name = "DIR", requires = "protocol")]
    pub(crate) out: Option<PathBuf>,
    /// Path of one indenter (TOML); prints force and pressures along it.
    #[arg(long, value_name = "FILE", requires = "sensor", conflicts_with_all = ["protocol", "out", "vtk", "seed"])]
    pub(crate) path: Option<PathBuf>,
    /// Print how the computing time of a path's frames is divided.
    #[arg(long, requires = "path", conflicts_with_all = ["run", "protocol"])]
    pub(crate) profile: bool,
    /// Print the results of a path as JSON.
    #[arg(long, requires = "path", conflicts_with_all = ["run", "protocol"])]
    pub(crate) json: bool,
    /// Limit the wall time of each frame of a path, ms, converged or not; three more columns show
    /// convergence, residual and how far the indenter is behind.
    #[arg(long, value_name = "MS", requires = "path", conflicts_with_all = ["run", "protocol"], value_parser = clap::value_parser!(u32).range(1..=60_000))]
    pub(crate) deadline_ms: Option<u32>,
    /// Settings (TOML) that differ from the defaults, in a table [simulate].
    #[arg(long, value_name = "FILE", requires = "sensor")]
    pub(crate) settings: Option<PathBuf>,
    /// Also write the deformed gel of every frame for ParaView.
    #[arg(long, requires = "protocol")]
    pub(crate) vtk: bool,
    /// Seed of the protocol's random locations.
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
}

#[derive(Args, Debug)]
pub(crate) struct Calibrate {
    /// Sensor description (TOML); the fit starts from its material.
    #[arg(long, value_name = "FILE")]
    pub(crate) sensor: PathBuf,
    /// Measured presses (CSV): columns time_s, depth_mm, and force_n or <taxel>_kpa.
    #[arg(long, value_name = "FILES", num_args = 1.., required_unless_present = "curves", requires = "indenter")]
    pub(crate) csv: Vec<String>,
    /// Name of the sensor's indenter in the CSV files.
    #[arg(long, value_name = "NAME")]
    pub(crate) indenter: Option<String>,
    /// Location of the press along the gel's x axis, mm.
    #[arg(long, value_name = "MM", default_value_t = 0.0, allow_hyphen_values = true)]
    pub(crate) x_mm: f64,
    /// Location of the press along the gel's y axis, mm.
    #[arg(long, value_name = "MM", default_value_t = 0.0, allow_hyphen_values = true)]
    pub(crate) y_mm: f64,
    /// Curves to fit (TOML): [[curves]] with file, indenter, x_mm, y_mm; [[recordings]] with file,
    /// import, presses, signals, taxels.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["csv", "indenter", "x_mm", "y_mm"])]
    pub(crate) curves: Option<PathBuf>,
    /// Free parameters: constants of the material by their names in files (shear_modulus_kpa,
    /// terms[0].alpha, prony[0].weight, bulk_modulus_kpa), poissons_ratio, friction,
    /// depth_offset_mm, force_scale, force_offset_n.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', required = true)]
    pub(crate) free: Vec<String>,
    /// Approximate number of simulated frames of each curve.
    #[arg(long, value_name = "N", default_value_t = 40)]
    pub(crate) frames: usize,
    /// Settings (TOML) that differ from the defaults, in a table [simulate].
    #[arg(long, value_name = "FILE")]
    pub(crate) settings: Option<PathBuf>,
    /// Folder to write material.toml, calibration.json and the plot to.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print everything as JSON instead of the material as TOML.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Characterize {
    /// Sensor description (TOML).
    #[arg(long, value_name = "FILE")]
    pub(crate) sensor: PathBuf,
    /// Recordings: Parquet files of presses or frames, MCAP logs, also cut ones (`.mcap.partial`),
    /// logs of other formats, or patterns.
    #[arg(long, value_name = "FILES", num_args = 1.., required = true)]
    pub(crate) recordings: Vec<String>,
    /// Import description of logs of other formats (TOML); with `presses = { split = "none" }` they
    /// have readings alone.
    #[arg(long, value_name = "FILE")]
    pub(crate) import: Option<PathBuf>,
    /// Folder to write characterization.json, report.html, datasheet.html and temperature.toml to.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print everything as JSON instead of a table.
    #[arg(long)]
    pub(crate) json: bool,
}

/// A run that was stopped or killed continues with the first press that is not done. The robot is
/// stopped by Ctrl-C, by any limit, and when a device stops sending.
#[derive(Args, Debug)]
pub(crate) struct Record {
    /// Press protocol (TOML).
    #[arg(long, value_name = "FILE")]
    pub(crate) protocol: PathBuf,
    /// Record on the emulated bench. CONFIG is its emulator configuration, with physics and sensor
    /// variation: a TOML file, or the built-in `default`, `harder` or `thicker` [default: default].
    #[arg(long, value_name = "CONFIG", num_args = 0..=1)]
    pub(crate) lab: Option<Option<PathBuf>>,
    /// Hardware configuration (TOML): how presses are carried out and, without --lab, the addresses
    /// of the devices [default: rigs/lab.toml].
    #[arg(long, value_name = "FILE", required_unless_present_any = ["lab", "dry_run"])]
    pub(crate) bench: Option<PathBuf>,
    /// Sensor description (TOML) [default: PhysTac].
    #[arg(long, value_name = "FILE")]
    pub(crate) sensor: Option<PathBuf>,
    /// Counts per Pa of the barometers, confirmed by a person who knows the parts [default: the
    /// value of the sensor description].
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u16).range(1..), conflicts_with = "lab")]
    pub(crate) scale: Option<u16>,
    /// Altitude of the test setup, m; the scale is checked against the pressure of free air there
    /// [default: anything up to 2000].
    #[arg(long, value_name = "M", conflicts_with = "lab", allow_negative_numbers = true)]
    pub(crate) altitude_m: Option<f32>,
    /// Folder of the run [default: runs/<protocol>].
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print and draw what would be done, and how long it would take, without moving the robot.
    #[arg(long)]
    pub(crate) dry_run: bool,
    /// Faults of the emulated bench (TOML), in tables [[faults]].
    #[arg(long, value_name = "FILE", requires = "lab", conflicts_with_all = ["scale", "altitude_m", "dry_run"])]
    pub(crate) faults: Option<PathBuf>,
    /// Compute what the emulated bench would record, without devices and without waiting.
    #[arg(long, requires = "lab", conflicts_with_all = ["bench", "dry_run", "faults", "json", "scale", "altitude_m"])]
    pub(crate) at_once: bool,
    /// Print the result as one line of JSON.
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) start: Start,
}

#[derive(Args, Debug)]
pub(crate) struct Export {
    /// Logs of `stream` or `record`: MCAP files, also cut ones (`.mcap.partial`), or patterns such
    /// as 'runs/touch/*.mcap'. With --lerobot also presses.parquet files.
    #[arg(value_name = "LOGS", num_args = 1.., required = true)]
    pub(crate) logs: Vec<String>,
    /// Folder of the tables [default: beside the logs].
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Write each log into this folder as a ROS 2 bag (MCAP) with standard messages alone: all
    /// pressures in Pa as one Float32MultiArray, FluidPressure and Temperature of each taxel,
    /// WrenchStamped, PoseStamped.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["out", "lerobot"])]
    pub(crate) ros: Option<PathBuf>,
    /// Rename a topic of --ros, for example tactile=/finger/touch. Topics: tactile [default:
    /// /tactile], pressure [default: /tactile/{taxel}/pressure], temperature [default:
    /// /tactile/{taxel}/temperature], wrench [default: /wrench], pose [default: /robot/pose],
    /// events [default: /events].
    #[arg(long, value_name = "TOPIC=NAME", requires = "ros", conflicts_with_all = ["out", "lerobot"], value_parser = topic_name)]
    pub(crate) topic: Vec<(String, String)>,
    /// Write recorded presses, from presses.parquet files or logs, into this new folder as one
    /// LeRobot data set (version 3.0).
    #[arg(long, value_name = "DIR", conflicts_with = "out")]
    pub(crate) lerobot: Option<PathBuf>,
    /// Print the results as JSON, one line for each log.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Import {
    /// Print a first import description of a CSV file or a ROS 2 bag (MCAP) instead, with a comment
    /// on each guess.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["sensor", "recordings", "import", "out", "settings"])]
    pub(crate) guess: Option<PathBuf>,
    /// Sensor description (TOML).
    #[arg(long, value_name = "FILE", required_unless_present = "guess")]
    pub(crate) sensor: Option<PathBuf>,
    /// Recordings: CSV files, ROS 2 bags (MCAP), or patterns such as 'data/*.csv'.
    #[arg(long, value_name = "FILES", num_args = 1.., required_unless_present = "guess")]
    pub(crate) recordings: Vec<String>,
    /// Import description of the recordings (TOML) [default: the file that the sensor description
    /// names].
    #[arg(long, value_name = "FILE")]
    pub(crate) import: Option<PathBuf>,
    /// Folder of the run.
    #[arg(long, value_name = "DIR", required_unless_present = "guess")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) start: Start,
}

#[derive(Args, Debug)]
pub(crate) struct Align {
    /// Folder of a run with its recordings and simulations.
    #[arg(long, value_name = "DIR")]
    pub(crate) run: PathBuf,
}

#[derive(Args, Debug)]
pub(crate) struct Train {
    /// Folder of a run with its paired frames.
    #[arg(long, value_name = "DIR")]
    pub(crate) run: PathBuf,
}

#[derive(Args, Debug)]
pub(crate) struct Evaluate {
    /// Folder of a run: evaluate its twin on the held-out presses.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["model", "recordings", "import"], required_unless_present = "model")]
    pub(crate) run: Option<PathBuf>,
    /// Folder of a model to evaluate on other recordings of its sensor.
    #[arg(long, value_name = "DIR", requires = "recordings")]
    pub(crate) model: Option<PathBuf>,
    /// Recordings: CSV files, presses.parquet files, or patterns.
    #[arg(long, value_name = "FILES", num_args = 1..)]
    pub(crate) recordings: Vec<String>,
    /// Import description of CSV recordings (TOML).
    #[arg(long, value_name = "FILE")]
    pub(crate) import: Option<PathBuf>,
    /// Name of the model's sensor in the recordings, if it differs.
    #[arg(long, value_name = "NAME", requires = "model")]
    pub(crate) recorded_as: Option<String>,
    /// Print the figures as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Gains, static nonlinearity, relaxation, contact heights and stiffness are fitted together, with
/// regularization towards the values of the original twin: what a few presses do not determine
/// stays as it was. Presses are chosen by their poses, not their readings: those that leave the
/// least uncertainty in the predictions of all presses (I-optimal design), where a fifth of the
/// presses is left aside at random at each choice. The other presses are for testing.
#[derive(Args, Debug)]
pub(crate) struct Adapt {
    /// Folder of the model to start from: a run's `model`.
    #[arg(long, value_name = "DIR")]
    pub(crate) model: PathBuf,
    /// Presses of the new sensor: CSV files, presses.parquet files, or patterns.
    #[arg(long, value_name = "FILES", num_args = 1.., required_unless_present = "run")]
    pub(crate) recordings: Vec<String>,
    /// Description of the new sensor (TOML) [default: the model's].
    #[arg(long, value_name = "FILE", conflicts_with = "run")]
    pub(crate) sensor: Option<PathBuf>,
    /// Import description of CSV recordings (TOML) [default: the file that --sensor names].
    #[arg(long, value_name = "FILE", conflicts_with = "run")]
    pub(crate) import: Option<PathBuf>,
    /// Name of the new sensor in the recordings, if it differs.
    #[arg(long, value_name = "NAME", conflicts_with = "run")]
    pub(crate) recorded_as: Option<String>,
    /// Number of presses to adapt with.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..), conflicts_with = "curve")]
    pub(crate) presses: u64,
    /// Seed of the random part of the choice of presses.
    #[arg(long, value_name = "S", default_value_t = 1, conflicts_with = "curve")]
    pub(crate) seed: u64,
    /// Folder to write to; the adapted model is `model` in it.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// With --run: numbers of presses at which errors are measured.
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',', requires = "run", conflicts_with_all = ["recordings", "sensor", "import"], value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) curve: Vec<u64>,
    /// Folder of an evaluated run of the new sensor: its training presses are used to adapt, and
    /// its test presses to evaluate, beside its own twin.
    #[arg(long, value_name = "DIR", requires = "curve", conflicts_with = "recordings")]
    pub(crate) run: Option<PathBuf>,
    /// With --curve: number of seeds, from 1 on; each chooses other presses.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..), requires = "curve", conflicts_with_all = ["recordings", "presses", "seed"])]
    pub(crate) seeds: u64,
    /// Print everything as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Setup calibration, twin and baselines are computed anew each time, from the presses that are not
/// held out. Table and plot show mean and standard deviation over the seeds.
#[derive(Args, Debug)]
pub(crate) struct CrossValidate {
    /// Folder of a simulated run, for example of `reproduce`.
    #[arg(long, value_name = "DIR")]
    pub(crate) run: PathBuf,
    /// What is held out together: press, place (location), file, indenter, depth (the deepest
    /// fifth), region (an outermost third), taxel.
    #[arg(long, value_name = "KINDS", value_delimiter = ',', default_value = "place")]
    pub(crate) held_out: Vec<twintac_run::HeldOut>,
    /// Number of seeds, from 1 on.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) seeds: u64,
    /// Also run an ablation: leave out each step of the twin in turn.
    #[arg(long)]
    pub(crate) ablation: bool,
    /// Also evaluate the prediction intervals; each twin is then refitted six times.
    #[arg(long)]
    pub(crate) intervals: bool,
    /// Print the figures as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

/// The gel is solved with finite elements, and the twin is stepped frame by frame with the
/// pressures at its ports. All numbers are simulated.
#[derive(Args, Debug)]
#[command(group = ArgGroup::new("motion").required(true))]
pub(crate) struct Predict {
    /// Folder of a model: a run's `model`.
    #[arg(long, value_name = "DIR")]
    pub(crate) model: PathBuf,
    /// Path of one indenter (TOML): down, sideways, tilted, and up again.
    #[arg(long, value_name = "FILE", group = "motion")]
    pub(crate) path: Option<PathBuf>,
    /// Press protocol (TOML).
    #[arg(long, value_name = "FILE", group = "motion")]
    pub(crate) protocol: Option<PathBuf>,
    /// Indenter (TOML) to add to the sensor's description, or to replace one of its name: name,
    /// shape, and optionally friction.
    #[arg(long, value_name = "FILE")]
    pub(crate) indenter: Option<PathBuf>,
    /// Seed of the protocol's random locations.
    #[arg(long, default_value_t = 1, conflicts_with = "path")]
    pub(crate) seed: u64,
    /// Temperature of the chips above that of their zero, K, for a model with temperature
    /// coefficients [default: 0].
    #[arg(long, value_name = "K", allow_negative_numbers = true, value_parser = warmer_k)]
    pub(crate) warmer_k: Option<f64>,
    /// Draw depth, force and readings over time into this PNG or SVG file.
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) plot: Option<PathBuf>,
    /// Print everything as JSON instead of comma-separated values.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Frames are processed in their recorded order. The recorded poses are not used for the estimate,
/// only for its errors. The estimate knows the indenters, the contact heights of the files that the
/// twin was trained on, and that a press begins untouched.
#[derive(Args, Debug)]
pub(crate) struct Locate {
    /// Folder of a model: a run's `model`.
    #[arg(long, value_name = "DIR")]
    pub(crate) model: PathBuf,
    /// Recordings: CSV files, presses.parquet files, or patterns.
    #[arg(long, value_name = "FILES", num_args = 1.., required = true)]
    pub(crate) recordings: Vec<String>,
    /// Import description of CSV recordings (TOML).
    #[arg(long, value_name = "FILE")]
    pub(crate) import: Option<PathBuf>,
    /// Name of the model's sensor in the recordings, if it differs.
    #[arg(long, value_name = "NAME")]
    pub(crate) recorded_as: Option<String>,
    /// Names of the sensor's indenters that can touch it [default: all].
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) indenter: Vec<String>,
    /// Settings of the estimator (TOML) that differ from the defaults: noise_kpa, model_part,
    /// deepest_mm, and others.
    #[arg(long, value_name = "FILE")]
    pub(crate) settings: Option<PathBuf>,
    /// Print everything as JSON instead of comma-separated values.
    #[arg(long)]
    pub(crate) json: bool,
    /// Print the errors of locations and depths as JSON, without the frames.
    #[arg(long, conflicts_with = "json")]
    pub(crate) errors: bool,
}

/// The content of a topic and its new name.
fn topic_name(text: &str) -> Result<(String, String), String> {
    let pair = text
        .split_once('=')
        .map(|(topic, name)| (topic.to_owned(), name.to_owned()));
    pair.ok_or_else(|| "expected what it holds and its name, such as tactile=/finger/touch".to_owned())
}

/// A temperature difference, K.
fn warmer_k(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(warmer_k) if f64::abs(warmer_k) <= 200.0 => Ok(warmer_k),
        _ => Err("expected kelvins, a number from -200 to 200".to_owned()),
    }
}

/// The file of a picture.
fn picture(name: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(name);
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("png" | "svg") => Ok(path),
        _ => Err("expected a name that ends in .png or .svg".to_owned()),
    }
}

#[derive(Args, Debug)]
pub(crate) struct Report {
    /// Folder of an evaluated run.
    #[arg(long, value_name = "DIR")]
    pub(crate) run: PathBuf,
}
