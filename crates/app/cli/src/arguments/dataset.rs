//! Arguments of `twintac dataset`.

use std::path::PathBuf;

use clap::{ArgGroup, Args};
use twintac_dataset::{DatasetPlan, FastSource, Shard};

/// A press depends only on the seed and on its own name, so the merged file is the same for every
/// number of shards and machines. A shard appears in the folder whole or not at all, with a
/// manifest, and a complete shard is not made again. Run one command for each shard on any number
/// of machines that share the folder, and repeat the commands that failed.
#[derive(Args, Debug)]
#[command(group = ArgGroup::new("what").required(true).args(["out", "check", "merge"]))]
pub(crate) struct Dataset {
    /// Sensor description (TOML) [default: the twin's, or PhysTac].
    #[arg(long, value_name = "FILE", conflicts_with_all = ["check", "merge"])]
    pub(crate) sensor: Option<PathBuf>,
    /// Press protocol (TOML) [default: random locations all over the ports, depths, speeds, holds
    /// and yaws].
    #[arg(long, value_name = "FILE", conflicts_with_all = ["indenter", "check", "merge"])]
    pub(crate) protocol: Option<PathBuf>,
    /// Names of the sensor's indenters for random presses [default: all].
    #[arg(long, value_name = "NAME", num_args = 1.., conflicts_with_all = ["check", "merge"])]
    pub(crate) indenter: Vec<String>,
    /// Number of presses of the whole data set; of a protocol the first ones, taken from the
    /// indenters in turn [default: 1000, or all of the protocol].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), conflicts_with_all = ["check", "merge"])]
    pub(crate) presses: Option<u64>,
    /// Seed of all random choices.
    #[arg(long, default_value_t = 1, conflicts_with_all = ["check", "merge"])]
    pub(crate) seed: u64,
    /// Use the surrogate of the gel instead of finite elements, which is much faster: the built-in
    /// one of PhysTac or its fingertip, or a file of `twintac fast train`.
    #[arg(long, value_name = "FILE", num_args = 0..=1, conflicts_with_all = ["check", "merge"])]
    pub(crate) fast: Option<Option<PathBuf>>,
    /// Folder of a trained twin that computes the readings, with relaxation [default: readings are
    /// the pressures at the ports].
    #[arg(long, value_name = "DIR", conflicts_with_all = ["check", "merge"])]
    pub(crate) twin: Option<PathBuf>,
    /// Sensor variation (TOML, see `twintac fast variation`): each press has an imperfect sensor
    /// of its own. Needs --fast.
    #[arg(long, alias = "imperfection", value_name = "FILE", requires = "fast", conflicts_with_all = ["check", "merge"])]
    pub(crate) variation: Option<PathBuf>,
    /// Settings (TOML) that differ from the defaults, in a table [simulate].
    #[arg(long, value_name = "FILE", conflicts_with_all = ["twin", "check", "merge"])]
    pub(crate) settings: Option<PathBuf>,
    /// Shard to make, and number of shards, for example 3/64 [default: 1/1, the whole data set].
    #[arg(long, value_name = "I/N", conflicts_with_all = ["check", "merge"])]
    pub(crate) shard: Option<Shard>,
    /// Folder of the data set.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Check that all shards of this folder are complete and unchanged.
    #[arg(long, value_name = "DIR")]
    pub(crate) check: Option<PathBuf>,
    /// Check all shards of this folder, and write all presses into its presses.parquet.
    #[arg(long, value_name = "DIR")]
    pub(crate) merge: Option<PathBuf>,
    /// Print the result as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

impl Dataset {
    /// The inputs of the data set.
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
            variation: self.variation.clone(),
            settings: self.settings.clone(),
        }
    }
}
