//! Ports: where a surrogate is evaluated.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use twintac_sensor::Sensor;

use super::mismatch::Difference;
use super::same::same;

/// A disc over which pressure is averaged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Port {
    /// Its centre, mm.
    pub(crate) position_mm: DVec3,
    pub(crate) radius_mm: f64,
}

impl Port {
    /// The ports of a sensor's taxels.
    pub(crate) fn all(sensor: &Sensor) -> Vec<Self> {
        let taxels = sensor.taxels.iter();
        let port = taxels.map(|taxel| Self {
            position_mm: taxel.position_mm,
            radius_mm: taxel.port_radius_mm,
        });
        port.collect()
    }

    /// Positions of ports in the gel's plane, mm.
    pub(crate) fn places_mm(ports: &[Self]) -> Vec<DVec2> {
        ports.iter().map(|port| port.position_mm.truncate()).collect()
    }

    /// The same disc at another location of its plane.
    pub(crate) fn at(&self, place_mm: DVec2) -> Self {
        Self {
            position_mm: place_mm.extend(self.position_mm.z),
            radius_mm: self.radius_mm,
        }
    }

    /// How a sensor's ports differ from these: their number, or the first port that differs.
    pub(crate) fn difference(fast: &[Self], sensors: &[Self]) -> Option<Difference> {
        if fast.len() != sensors.len() {
            return Some(Difference {
                what: "number of ports".to_owned(),
                fast: fast.len().to_string(),
                sensor: sensors.len().to_string(),
            });
        }
        let mut pairs = fast.iter().zip(sensors).enumerate();
        let (number, (fast, sensor)) = pairs.find(|(_, (fast, sensor))| !same(fast, sensor))?;
        let text = |port: &Self| {
            let Self {
                position_mm,
                radius_mm,
            } = port;
            format!("at {position_mm} mm with a radius of {radius_mm} mm")
        };
        Some(Difference {
            what: format!("port {number}"),
            fast: text(fast),
            sensor: text(sensor),
        })
    }
}
