//! A twin made and evaluated again for each way to hold presses out. Nothing of one division uses
//! results of another.

mod judge;
mod new_taxel;
mod unlike;

pub use judge::{Bench, Judgement, judge};
pub use unlike::ToldApart;
