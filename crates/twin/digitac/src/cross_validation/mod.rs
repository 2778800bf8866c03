//! A twin made and evaluated again for each way to hold presses out. Nothing of one division uses
//! results of another.

mod evaluate;
mod new_taxel;
mod ood;

pub use evaluate::{Bench, FoldEvaluation, evaluate_fold};
pub use ood::OodDetection;
