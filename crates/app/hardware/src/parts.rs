//! The parts list of a board, with known prices.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};
use serde::Deserialize;
use twintac_board::Board;

/// Quantities for which the list has prices.
const QUANTITIES: [u32; 3] = [1, 10, 50];

/// Known data of parts, by the names that boards use for them.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Known {
    part: BTreeMap<String, Part>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Part {
    manufacturer: String,
    /// The order number.
    number: String,
    /// A replacement part.
    #[serde(default)]
    second_source: String,
    #[serde(default)]
    price: Vec<Price>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Price {
    quantity: u32,
    amount: f64,
    currency: String,
    /// Source of the price.
    source: String,
}

/// Reads the file.
pub(crate) fn read(path: &Path) -> Result<Known> {
    Ok(twintac_config::read(path)?.value)
}

const COLUMNS: [&str; 11] = [
    "reference",
    "quantity",
    "value",
    "footprint",
    "manufacturer",
    "number",
    "second_source",
    "price_at_1",
    "price_at_10",
    "price_at_50",
    "price_source",
];

/// The list as CSV. Unknown prices stay empty.
pub(crate) fn csv(board: &Board, known: &Known) -> Result<Vec<u8>> {
    let mut list = csv::Writer::from_writer(Vec::new());
    list.write_record(COLUMNS)?;
    for line in board.parts() {
        let part = known
            .part
            .get(&line.part)
            .with_context(|| format!("hardware/parts.toml has no [part.\"{}\"]; add it", line.part))?;
        let price = |quantity: u32| {
            let known = part.price.iter().find(|price| price.quantity == quantity);
            known.map_or(String::new(), |price| {
                format!("{:.2} {}", price.amount, price.currency)
            })
        };
        let [at_1, at_10, at_50] = QUANTITIES.map(price);
        let sources: Vec<&str> = part.price.iter().map(|price| price.source.as_str()).collect();
        list.write_record([
            &line.references.join(" "),
            &line.references.len().to_string(),
            &line.value,
            &line.footprint,
            &part.manufacturer,
            &part.number,
            &part.second_source,
            &at_1,
            &at_10,
            &at_50,
            &sources.join("; "),
        ])?;
    }
    Ok(list.into_inner()?)
}
