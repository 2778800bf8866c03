//! What a twin must know of a sensor's taxels.

use std::collections::BTreeSet;

use digitac::Taxels;
use twintac_sensor::Sensor;

/// What a sensor's description says of its taxels.
pub fn taxels(sensor: &Sensor) -> Taxels {
    Taxels {
        ports_mm: ports_mm(sensor),
        left_out: left_out(sensor),
    }
}

/// Places of the ports in the gel's plane, mm.
pub fn ports_mm(sensor: &Sensor) -> Vec<[f64; 2]> {
    let places = sensor.taxels.iter().map(|taxel| taxel.position_mm.truncate());
    places.map(|place| place.to_array()).collect()
}

/// Taxels of a sensor whose readings are not to be trusted, by index.
pub fn left_out(sensor: &Sensor) -> BTreeSet<usize> {
    let taxels = sensor.taxels.iter().enumerate();
    taxels
        .filter(|(_, taxel)| taxel.doubtful.is_some())
        .map(|(index, _)| index)
        .collect()
}
