//! What a twin needs to know of a sensor's taxels.

use std::collections::BTreeSet;

use digitac::Taxels;
use twintac_sensor::Sensor;

/// The taxels by a sensor's description.
pub fn taxels(sensor: &Sensor) -> Taxels {
    Taxels {
        ports_mm: ports_mm(sensor),
        left_out: left_out(sensor),
    }
}

/// Positions of the ports in the gel's plane, mm.
pub fn ports_mm(sensor: &Sensor) -> Vec<[f64; 2]> {
    let places = sensor.taxels.iter().map(|taxel| taxel.position_mm.truncate());
    places.map(|place| place.to_array()).collect()
}

/// Indices of the taxels that a sensor's description excludes (`doubtful`).
pub fn left_out(sensor: &Sensor) -> BTreeSet<usize> {
    let taxels = sensor.taxels.iter().enumerate();
    taxels
        .filter(|(_, taxel)| taxel.doubtful.is_some())
        .map(|(index, _)| index)
        .collect()
}
