//! A twin made and judged anew for each way to hold presses out: nothing of a division knows what another one has seen.

mod judge;
mod new_taxel;

pub use judge::{Bench, Judgement, judge};
