//! What can be typed behind `twintac dataset`.

use std::path::PathBuf;

use clap::{ArgGroup, Args};
use twintac_dataset::{DatasetPlan, FastSource, Shard};

/// A press depends on the seed and on its own name alone: however many shards there are and whoever makes them, they merge to the same bytes. A shard appears in
/// the folder whole or not at all, with a manifest, and is not made again once it is there: run a command for each shard on any number of machines that share the folder, and
/// run what failed once more.
#[derive(Args, Debug)]
#[command(group = ArgGroup::new("what").required(true).args(["out", "check", "merge"]))]
pub(crate) struct Dataset {
    /// Sensor description (TOML) [default: the twin's, or PhysTac].
    #[arg(long, value_name = "FILE", conflicts_with_all = ["check", "merge"])]
    pub(crate) sensor: Option<PathBuf>,
    /// What to press (TOML) [default: random places all over the ports, depths, speeds, holds and turns].
    #[arg(long, value_name = "FILE", conflicts_with_all = ["indenter", "check", "merge"])]
    pub(crate) protocol: Option<PathBuf>,
    /// Names of the sensor's indenters that press at random [default: all].
    #[arg(long, value_name = "NAME", num_args = 1.., conflicts_with_all = ["check", "merge"])]
    pub(crate) indenter: Vec<String>,
    /// Presses of the whole data set; of a protocol the first ones, each indenter in turn [default: 1000, or all of the protocol].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), conflicts_with_all = ["check", "merge"])]
    pub(crate) presses: Option<u64>,
    /// Seed of all random choices.
    #[arg(long, default_value_t = 1, conflicts_with_all = ["check", "merge"])]
    pub(crate) seed: u64,
    /// Press a gel without finite elements, much quicker: PhysTac's or its fingertip's, or that of a file of `twintac fast train`.
    #[arg(long, value_name = "FILE", num_args = 0..=1, conflicts_with_all = ["check", "merge"])]
    pub(crate) fast: Option<Option<PathBuf>>,
    /// Folder of a trained twin: readings are its barometers', with their memory [default: the pressures at the ports].
    #[arg(long, value_name = "DIR", conflicts_with_all = ["check", "merge"])]
    pub(crate) twin: Option<PathBuf>,
    /// How imperfect sensors are (TOML, see `twintac fast imperfection`): each press has a sensor of its own. Needs --fast.
    #[arg(long, value_name = "FILE", requires = "fast", conflicts_with_all = ["check", "merge"])]
    pub(crate) imperfection: Option<PathBuf>,
    /// Settings (TOML) that differ from the defaults, in a table [simulate].
    #[arg(long, value_name = "FILE", conflicts_with_all = ["twin", "check", "merge"])]
    pub(crate) settings: Option<PathBuf>,
    /// Which part to make, and of how many: 3/64 [default: all of it, 1/1].
    #[arg(long, value_name = "I/N", conflicts_with_all = ["check", "merge"])]
    pub(crate) shard: Option<Shard>,
    /// Folder of the data set.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Check that all shards of this folder are there and as they were made.
    #[arg(long, value_name = "DIR")]
    pub(crate) check: Option<PathBuf>,
    /// Check the same, and write all presses of this folder into its presses.parquet.
    #[arg(long, value_name = "DIR")]
    pub(crate) merge: Option<PathBuf>,
    /// Print what was made, checked or merged as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

impl Dataset {
    /// What the data set is made from.
    pub(crate) fn plan(&self) -> DatasetPlan {
        DatasetPlan {
            sensor: self.sensor.clone(),
            protocol: self.protocol.clone(),
            indenters: self.indenter.clone(),
            n_presses: self
                .presses
                .map(|n_presses| usize::try_from(n_presses).unwrap_or(usize::MAX)),
            seed: self.seed,
            fast: self.fast.as_ref().map(|file| match file {
                Some(file) => FastSource::File(file.clone()),
                None => FastSource::BuiltIn,
            }),
            twin: self.twin.clone(),
            imperfection: self.imperfection.clone(),
            settings: self.settings.clone(),
        }
    }
}
