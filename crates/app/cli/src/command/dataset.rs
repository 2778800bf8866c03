//! `twintac dataset`: simulates many presses, shard by shard.

use std::path::Path;

use anyhow::Result;
use twintac_dataset::{Dataset, LeftOut, MadeShard, Shard, WholeDataset, check_dataset, merge_dataset};

use crate::arguments::Dataset as Arguments;
use crate::output::print;
use crate::progress::{Bars, say};

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let bars = Bars::default();
    if let Some(folder) = &arguments.check {
        return tell(&check_dataset(folder, &bars)?, arguments.json);
    }
    if let Some(folder) = &arguments.merge {
        return tell(&merge_dataset(folder, None, &bars)?, arguments.json);
    }
    let shard = match arguments.shard {
        Some(shard) => shard,
        None => Shard::new(1, 1)?,
    };
    let out = arguments.out.as_deref().unwrap_or(Path::new("."));
    let made = Dataset::open(&arguments.plan())?.make(shard, out, &bars)?;
    say_left_out(&made.manifest.left_out);
    print(&if arguments.json {
        serde_json::to_string_pretty(&made)?
    } else {
        in_words(&made)
    })
}

fn in_words(made: &MadeShard) -> String {
    let manifest = &made.manifest;
    format!(
        "{}: {} presses, {} frames, {}{}",
        made.parquet.display(),
        manifest.presses.len(),
        manifest.rows,
        manifest.provenance,
        if made.was_kept { ", was there" } else { "" }
    )
}

/// Prints the summary of a complete data set.
fn tell(whole: &WholeDataset, as_json: bool) -> Result<()> {
    say_left_out(&whole.left_out);
    print(&if as_json {
        serde_json::to_string_pretty(whole)?
    } else {
        let merged = whole.merged.as_ref();
        format!(
            "{}{} shards, {} presses, {} frames, {}: all unchanged",
            merged.map_or(String::new(), |file| format!("{}: ", file.display())),
            whole.n_shards,
            whole.n_presses,
            whole.rows,
            whole.provenance
        )
    })
}

fn say_left_out(left_out: &[LeftOut]) {
    if let Some(first) = left_out.first() {
        say(&format!(
            "{} presses could not be simulated and are left out; the first, {}: {}",
            left_out.len(),
            first.press,
            first.why
        ));
    }
}
