//! Charts. Each is a plain struct whose `scene` is a pure function of it; what is not a number is left out.

mod bars;
mod density;
mod heat;
mod lines;
mod places;
mod scatter;

pub use bars::{Bar, Bars};
pub use density::Density;
pub use heat::{HeatMap, HeatMaps};
pub use lines::{Panel, Panels, Series};
pub use places::Places;
pub use scatter::{Scatter, ScatterPoint};

/// Width of a chart that stands alone or beside others, px.
const WIDTH_PX: f64 = 380.0;

/// Pixels left of the tick texts of a chart's vertical axis, for its label.
pub(crate) const LABEL: f64 = 20.0;
/// Pixels below a chart's box, for tick texts and the axis label.
pub(crate) const BELOW: f64 = 40.0;
/// Pixels right of a chart's box.
pub(crate) const RIGHT: f64 = 12.0;
