//! A technical drawing of a sensor, and a few facts in words, both made from its description.
//!
//! ```
//! # fn show(sensor: &twintac_sensor::Sensor) -> Result<(), twintac_plot::PlotError> {
//! twintac_drawing::drawing(sensor).write("phystac.svg".as_ref())
//! # }
//! ```

mod facts;
mod sheet;
mod views;

use twintac_plot::Scene;
use twintac_sensor::Sensor;

pub use facts::facts;

/// The sensor from above, and cut through the taxel nearest to the gel's middle, with dimensions in mm.
#[must_use]
pub fn drawing(sensor: &Sensor) -> Scene {
    sheet::Sheet {
        title: format!("{}: {}", sensor.name, sensor.summary),
        views: vec![views::top(sensor), views::section(sensor)],
    }
    .scene()
}
