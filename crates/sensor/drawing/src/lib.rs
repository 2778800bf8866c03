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
