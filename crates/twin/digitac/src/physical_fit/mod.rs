//! Barometers fitted to measured presses, together with the unknowns of the test setup.

mod elastic;
mod fit;
mod layout;
mod posterior;
mod prior;
mod series;

pub(crate) use elastic::{Elastic, Known, Pressures, Slope};
pub(crate) use fit::{Solution, fit, fit_near_learned, information};
pub(crate) use layout::BarometerModel;
pub(crate) use posterior::Posterior;
pub(crate) use prior::Prior;
pub(crate) use series::{Fitted, Series};
