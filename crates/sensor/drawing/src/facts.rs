//! Facts about a sensor.

use twintac_plot::page::Fact;
use twintac_sensor::Sensor;

/// Size, material and read-out as short texts, with inferred values marked.
#[must_use]
pub fn facts(sensor: &Sensor) -> Vec<Fact> {
    let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
    let size = high - low;
    let material = &sensor.gel.material;
    let readout = &sensor.readout;
    vec![
        Fact::new("gel", format!("{:.1} × {:.1} × {:.1} mm", size.x, size.y, size.z)),
        Fact::new(
            "material",
            format!(
                "{}, E = {:.0} kPa, ν = {:.4} ({})",
                material.model.name(),
                material.youngs_modulus_kpa(),
                material.poissons_ratio(),
                material.source
            ),
        ),
        Fact::new("taxels", sensor.taxels.len().to_string()),
        Fact::new(
            "read-out",
            format!(
                "{} to {} kPa, {} kPa steps, {} Hz",
                readout.min_kpa, readout.max_kpa, readout.resolution_kpa, readout.rate_hz
            ),
        ),
        Fact::new("source", &sensor.source),
        Fact::new("inferred, not stated by the source", sensor.inferred.join(", ")),
    ]
}
