//! Data sets of simulated presses, made in shards on any number of machines.
//!
//! A [`DatasetPlan`] names the inputs: a sensor's description, a protocol or a number of random
//! presses, a seed, and what computes the readings (FEM solution or surrogate; pressures at the
//! ports, a trained twin, or imperfect sensors). [`Dataset::open`] reads them, and
//! [`Dataset::make`] makes one [`Shard`]: presses with time in s, poses in mm, force in N and
//! readings in kPa, as a Parquet file. [`check_dataset`] and [`merge_dataset`] check all shards and
//! write them as one file. Every number is `simulated`.
//!
//! ```text
//! dataset.toml                        what the data set is made from; its SHA-256 is in every
//!                                     manifest
//! sensor.toml                         the sensor's description
//! shard-000003-of-000064.parquet      a recording: the presses of one shard
//! shard-000003-of-000064.json         its manifest; a shard that has one is complete
//! presses.parquet                     all presses, after merging
//! ```
//!
//! # How it works
//!
//! ```text
//! plan, identity   what is asked for; all inputs, read, and the text that identifies the data set:
//!                  `dataset.toml`
//! shard            i of n: a range of the presses; presses are taken from the indenters in turn,
//!                  so that a shard has all indenters
//! press            one press, from the data set's inputs and its own plan: its own table over
//!                  depth, never a lattice that other presses share
//! folder, merge    files that appear whole or not at all; the check of all shards, and one file of
//!                  them
//! ```
//!
//! - A press depends on the data set and on its own name, and never on its shard or on the machine:
//!   all divisions into shards merge to the same bytes.
//! - The shard is the unit of work, and any scheduler can distribute shards. A shard is made in a
//!   temporary folder whose name no reader looks for. The Parquet file is renamed first and the
//!   manifest last, so a shard with a manifest is complete. Two programs that make the same shard
//!   at once write the same bytes.
//! - Files are identified by their content, wherever they are on each machine.
//! - A row group of the Parquet file ends with the press that fills it (`RecordingWriter` in
//!   `crates/sensor/recording`), so the bytes of a file depend on its presses alone. The checksum
//!   before the footer is computed while the file is written.
//! - A press that cannot be simulated is left out, and the manifest says why.
//! - The Python module `twintac.ray` makes shards with plain tasks of Ray, because the writers of
//!   Ray Data can lose or double rows when a task is repeated.
//!
//! The crate reads no environment variable and no argument, prints nothing, and does not depend on
//! `crates/app/run`.

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
