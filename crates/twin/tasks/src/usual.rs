//! The default sensor variation.

use twintac_sensors::SensorVariation;

/// The default sensor variation, for sensors that work. Gains, static nonlinearity of the ports,
/// noise, resolution and frame rate are those that `twintac fast variation` found on the
/// emulated PhysTac (`variations/phystac.toml`). Assumed are a zero drift of a tenth of a kPa
/// since the tare, hysteresis, installation and faults.
#[must_use]
pub fn usual_variation() -> SensorVariation {
    SensorVariation {
        gain_deviation: 0.18,
        growth_deviation_per_kpa: 0.001_12,
        offset_deviation_kpa: 0.1,
        noise_deviation_kpa: 0.0153,
        quantum_kpa: 0.01,
        hysteresis: 0.03,
        dead_chance: 0.005,
        stuck_chance: 0.005,
        late_chance: 0.02,
        rate_hz: 55.0,
        jitter: 0.0391,
        height_deviation_mm: 0.05,
        place_deviation_mm: 0.2,
        turn_deviation_rad: 0.01,
        tilt_deviation_rad: 0.01,
        ..SensorVariation::default()
    }
}
