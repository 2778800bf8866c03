//! A twin made and judged anew for each way to hold presses out: nothing of a division knows what another one has seen.

mod judge;
mod new_taxel;
mod unlike;

pub use judge::{Bench, Judgement, judge};
pub use unlike::ToldApart;
