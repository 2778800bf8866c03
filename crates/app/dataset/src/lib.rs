//! Data sets of simulated presses, made in shards by as many programs and machines as there are.
//!
//! ```text
//! dataset.toml                        what the data set is made from; its SHA-256 is in every manifest
//! sensor.toml                         the sensor's description
//! shard-000003-of-000064.parquet      a recording: the presses of one shard
//! shard-000003-of-000064.json         its manifest; a shard that has one is complete
//! presses.parquet                     all of them, once they are merged
//! ```
//!
//! A press depends on the data set and on its own name, never on which shard it is in or who makes it: all divisions merge to the same bytes.

mod dataset;
mod folder;
mod identity;
mod merge;
mod plan;
mod press;
mod shard;

pub use dataset::Dataset;
pub use folder::{LeftOut, MadeShard, Manifest};
pub use merge::{WholeDataset, check_dataset, merge_dataset};
pub use plan::{DatasetPlan, FastSource};
pub use shard::Shard;
