//! A technical drawing of a sensor, and a list of facts, both made from its description.
//!
//! Input is a sensor's description. Output is a [`drawing`], which can be written as SVG or PNG,
//! with dimensions in mm; and [`facts()`]: size, material and read-out as short texts for a page.
//!
//! ```
//! # fn show(sensor: &twintac_sensor::Sensor) -> Result<(), twintac_plot::PlotError> {
//! twintac_drawing::drawing(sensor).write("phystac.svg".as_ref())
//! # }
//! ```
//!
//! # How it works
//!
//! A sensor becomes two views (module `views`): from above, and in section through the taxel
//! nearest to the gel's middle. A view consists of simple shapes, each for gel, shell, board, chip
//! or port, and of dimensions. Module `sheet` draws the views one below the other in one scale. The
//! thicknesses of shell wall and board are not part of a description, so they are drawn with fixed
//! values.
//!
//! The crate depends on no solver, device or recording.

mod facts;
mod sheet;
mod views;

use twintac_plot::Scene;
use twintac_sensor::Sensor;

pub use facts::facts;

/// The sensor from above and in section through the taxel nearest to the gel's middle, with
/// dimensions in mm.
#[must_use]
pub fn drawing(sensor: &Sensor) -> Scene {
    sheet::Sheet {
        title: format!("{}: {}", sensor.name, sensor.summary),
        views: vec![views::top(sensor), views::section(sensor)],
    }
    .scene()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn no_text_leaves_the_drawing_of_a_described_sensor() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../sensors");
        let mut n_sensors = 0;
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|extension| extension == "toml") {
                let sensor = Sensor::read(&path).unwrap();
                assert_eq!(drawing(&sensor).overflow(), Vec::<&str>::new(), "{}", sensor.name);
                n_sensors += 1;
            }
        }
        assert!(n_sensors >= 7);
    }
}
