//! Description of the sensor that is shown.

use phystac::Transfer;
use twintac_log::Description;
use twintac_map::{Rectangle, pitch_mm};
use twintac_recording::Provenance;
use twintac_sensor::Sensor;
use twintac_shape::Pose;
use twintac_source::confirmed_transfer;

/// A sensor and the provenance of its readings.
#[derive(Clone, Debug)]
pub struct About {
    /// Name of the sensor description.
    pub sensor: String,
    /// Its full text.
    pub sensor_toml: String,
    /// Names of the taxels, in the order of every frame.
    pub taxels: Vec<String>,
    /// Positions of the taxels in the gel's plane, mm.
    pub places_mm: Vec<[f64; 2]>,
    /// Whether the readings are from hardware or emulated.
    pub provenance: Provenance,
    /// The confirmed conversion from counts to pressure, if the chips do not know their own scale.
    pub transfer: Option<Transfer>,
    /// Change of each taxel's zero with temperature, kPa/K. Empty if unknown.
    pub kpa_per_k: Vec<f64>,
    /// Wall-clock time of the start of the bench clock, ns since 1970-01-01 UTC.
    pub start_unix_ns: u64,
}

impl About {
    /// Describes a sensor from its description and the text of it.
    #[must_use]
    pub fn new(
        sensor: &Sensor,
        sensor_toml: &str,
        provenance: Provenance,
        transfer: Option<Transfer>,
        start_unix_ns: u64,
    ) -> Self {
        let place = |taxel: &twintac_sensor::Taxel| [taxel.position_mm.x, taxel.position_mm.y];
        Self {
            sensor: sensor.name.clone(),
            sensor_toml: sensor_toml.to_owned(),
            taxels: sensor.taxels.iter().map(|taxel| taxel.name.clone()).collect(),
            places_mm: sensor.taxels.iter().map(place).collect(),
            provenance,
            transfer,
            kpa_per_k: Vec::new(),
            start_unix_ns,
        }
    }

    /// The area of a map of the sensor: the taxels with a margin of three quarters of a pitch, mm.
    #[must_use]
    pub fn window(&self) -> Rectangle {
        let margin_mm = 0.75 * pitch_mm(&self.places_mm);
        let along = |axis: usize| self.places_mm.iter().map(move |place| place[axis]);
        Rectangle {
            min_mm: [0, 1].map(|axis| along(axis).fold(f64::INFINITY, f64::min) - margin_mm),
            max_mm: [0, 1].map(|axis| along(axis).fold(f64::NEG_INFINITY, f64::max) + margin_mm),
        }
    }

    /// The description for a log. Nothing is known of a robot or a force sensor, and none is
    /// recorded.
    #[must_use]
    pub fn description(&self) -> Description {
        Description {
            sensor: self.sensor.clone(),
            sensor_toml: self.sensor_toml.clone(),
            provenance: self.provenance,
            taxels: self.taxels.clone(),
            transfer: self.transfer.as_ref().map(confirmed_transfer),
            base_from_gel: Pose::IDENTITY,
            tool_from_indenter: Pose::IDENTITY,
            force_axis: glam::DVec3::NEG_Z,
            start_unix_ns: self.start_unix_ns,
            versions: [("twintac".to_owned(), env!("CARGO_PKG_VERSION").to_owned())].into(),
        }
    }
}
