//! Barometers fitted to measured presses, together with what is unknown about the bench.

mod elastic;
mod fit;
mod series;

pub(crate) use elastic::{Elastic, Known, Pressures, Slope};
pub(crate) use fit::{BarometerModel, Solution, fit};
pub(crate) use series::{Fitted, Series};
