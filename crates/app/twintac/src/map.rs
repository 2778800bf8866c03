//! The pressure between the taxels.

use std::path::Path;

use twintac_map::{MapSettings, Rectangle, pressure_map};
use twintac_plot::{HeatMap, HeatMaps, Scene};

use crate::{Error, Sensor};

/// A continuous map over the gel, interpolated from the readings of a few taxels.
#[derive(Clone, Debug, PartialEq)]
pub struct PressureMap {
    map: twintac_map::PressureMap,
    /// Positions of the taxels that have a reading, mm.
    taxels_mm: Vec<[f64; 2]>,
    missing: Vec<String>,
    title: String,
}

impl PressureMap {
    /// The map through readings above the unloaded baseline, kPa; `[n_taxels]`. It has 96 columns
    /// and 64 rows. A taxel without a reading (NaN) is left out: the map is interpolated from the
    /// other taxels, and is NaN everywhere if there is none.
    ///
    /// # Errors
    /// Another number of readings than the sensor has taxels; a reading that is infinite.
    pub fn of(sensor: &Sensor, readings_kpa: &[f64]) -> Result<Self, Error> {
        let described = &*sensor.file().sensor;
        let place = |taxel: &twintac_sensor::Taxel| [taxel.position_mm.x, taxel.position_mm.y];
        let taxels_mm: Vec<[f64; 2]> = described.taxels.iter().map(place).collect();
        let (answering, missing): (Vec<_>, Vec<_>) = described
            .taxels
            .iter()
            .zip(readings_kpa)
            .partition(|(_, reading)| !reading.is_nan());
        let missing: Vec<String> = missing.into_iter().map(|(taxel, _)| taxel.name.clone()).collect();
        let without = match missing.as_slice() {
            [] => String::new(),
            names => format!(", without {}", names.join(", ")),
        };
        let (low, high) = described.gel.solid.bounds_mm(&described.surfaces);
        let gel = Rectangle {
            min_mm: [low.x, low.y],
            max_mm: [high.x, high.y],
        };
        let baseline_kpa = vec![0.0; readings_kpa.len()];
        let settings = MapSettings::default();
        Ok(Self {
            map: pressure_map(&taxels_mm, readings_kpa, &baseline_kpa, gel, &settings)?,
            taxels_mm: answering.into_iter().map(|(taxel, _)| place(taxel)).collect(),
            title: format!("Pressure on {}{without}", sensor.name()),
            missing,
        })
    }

    /// Pressure above the baseline, kPa, `[rows][columns]` flattened, the row of smallest y first.
    #[must_use]
    pub fn pressure_kpa(&self) -> &[f64] {
        &self.map.pressure_kpa
    }

    /// Names of the taxels without a reading. The map does not use them.
    #[must_use]
    pub fn missing(&self) -> &[String] {
        &self.missing
    }

    /// Numbers of columns and rows.
    #[must_use]
    pub fn grid(&self) -> [usize; 2] {
        self.map.grid
    }

    /// Draws the map into a file, `.svg` or `.png`, with marks at the taxels that have a reading.
    ///
    /// # Errors
    /// A name with another ending; a file that cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        Ok(self.scene().write(path.as_ref())?)
    }

    /// The map as the text of an SVG file, with marks at the taxels that have a reading.
    #[must_use]
    pub fn svg(&self) -> String {
        twintac_plot::svg(&self.scene())
    }

    fn scene(&self) -> Scene {
        let map = HeatMap {
            name: String::new(),
            min_mm: self.map.rectangle.min_mm,
            max_mm: self.map.rectangle.max_mm,
            grid: self.map.grid,
            values: self.map.pressure_kpa.clone(),
        };
        let maps = HeatMaps {
            title: self.title.clone(),
            maps: vec![map],
            unit: "kPa".to_owned(),
            marks_mm: self.taxels_mm.clone(),
            circle_mm: None,
        };
        maps.scene()
    }
}
