//! The pressure map, the same that the dashboard of a real sensor shows: interpolated from the
//! readings of the taxels.

use twintac_map::{MapSettings, PreparedMap, Rectangle};
use twintac_sensor::Sensor;

use crate::arrays::{Array, Arrays};

/// Columns and rows.
const GRID: [usize; 2] = [64, 64];

/// A map of the taxels over the gel.
pub(crate) struct Map {
    prepared: PreparedMap,
    array: Array,
    kpa: Vec<f64>,
}

impl Map {
    /// A map that is written into this array; `None` if the positions of the taxels allow no map.
    pub(crate) fn of(sensor: &Sensor, array: Array) -> Option<Self> {
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let [min_mm, max_mm] = [low, high].map(|corner| corner.truncate().to_array());
        let taxels = sensor.taxels.iter();
        let places_mm: Vec<[f64; 2]> = taxels
            .map(|taxel| taxel.position_mm.truncate().to_array())
            .collect();
        let settings = MapSettings {
            grid: GRID,
            ..MapSettings::default()
        };
        let prepared = PreparedMap::new(&places_mm, Rectangle { min_mm, max_mm }, &settings, &[]).ok()?;
        Some(Self {
            prepared,
            array,
            kpa: Vec::new(),
        })
    }

    pub(crate) fn show(&mut self, pressure_kpa: &[f64], arrays: &mut Arrays) {
        if self.prepared.fill(pressure_kpa, &mut self.kpa).is_ok() {
            arrays.set_numbers(self.array, &self.kpa);
        }
    }
}
