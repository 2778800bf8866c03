//! Taxels that the description of a sensor calls doubtful.

use std::collections::BTreeSet;

use twintac_sensor::Sensor;

/// Taxels of a sensor whose readings are not to be trusted, by index.
pub(crate) fn left_out(sensor: &Sensor) -> BTreeSet<usize> {
    let taxels = sensor.taxels.iter().enumerate();
    taxels
        .filter(|(_, taxel)| taxel.doubtful.is_some())
        .map(|(index, _)| index)
        .collect()
}
