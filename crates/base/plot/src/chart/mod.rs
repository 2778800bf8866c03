//! Charts. Each is a plain struct, whose method `scene` depends on the struct alone. Values that
//! are not numbers are left out.

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

/// Distance between the tick texts of the vertical axis and the edge of the chart, for the axis
/// label, px.
pub(crate) const LABEL: f64 = 20.0;
/// Height below the box of a chart, for tick texts and the axis label, px.
pub(crate) const BELOW: f64 = 40.0;
/// Width to the right of the box of a chart, px.
pub(crate) const RIGHT: f64 = 12.0;
