//! Sensors before they are cast: [`search`] takes a description, varies numbers of it ([`Variable`]), presses each of the gels that come of that, and tells
//! what such sensors would do ([`Figures`]): which of them no other beats in everything, and which is the best of those for given wishes ([`Wishes`]).
//!
//! All figures are simulated. They hold for one ball in the middle of the ports, with noise of the chips alone.

mod described;
mod design;
mod figures;
mod measure;
mod plan;
mod plot;
mod press;
mod search;
mod variable;
mod wishes;

pub use design::{Design, Designs};
pub use figures::{Figure, Figures, RangeEnd};
pub use measure::Measure;
pub use plan::Plan;
pub use search::search;
pub use variable::Variable;
pub use wishes::Wishes;
