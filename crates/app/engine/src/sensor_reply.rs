//! The data of a sensor that a page needs.

use glam::DVec3;
use serde::Serialize;
use twintac_sensor::{Indenter, Sensor};

/// A sensor, as a page shows it.
#[derive(Debug, Serialize)]
pub(crate) struct SensorReply {
    name: String,
    summary: String,
    source: String,
    /// Its description in words.
    description: String,
    /// Corners of the gel's bounding box, mm.
    gel_mm: [DVec3; 2],
    /// Constants of the gel, in words.
    material: &'static str,
    /// Whether the gel relaxes in time.
    relaxes: bool,
    taxels: Vec<TaxelReply>,
    indenters: Vec<Indenter>,
    shell: Option<ShellReply>,
    limits: Option<LimitsReply>,
}

#[derive(Debug, Serialize)]
struct TaxelReply {
    name: String,
    position_mm: DVec3,
    port_radius_mm: f64,
}

#[derive(Debug, Serialize)]
struct ShellReply {
    gap_mm: f64,
    height_mm: f64,
}

#[derive(Debug, Serialize)]
struct LimitsReply {
    force_n: f64,
    depth_mm: f64,
}

impl SensorReply {
    pub(crate) fn of(sensor: &Sensor) -> Self {
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let taxels = sensor.taxels.iter().map(|taxel| TaxelReply {
            name: taxel.name.clone(),
            position_mm: taxel.position_mm,
            port_radius_mm: taxel.port_radius_mm,
        });
        Self {
            name: sensor.name.clone(),
            summary: sensor.summary.clone(),
            source: sensor.source.clone(),
            description: sensor.describe(),
            gel_mm: [low, high],
            material: sensor.gel.material.model.name(),
            relaxes: !sensor.gel.material.prony.is_empty(),
            taxels: taxels.collect(),
            indenters: sensor.indenters.clone(),
            shell: sensor.shell.as_ref().map(|shell| ShellReply {
                gap_mm: shell.gap_mm,
                height_mm: shell.height_mm,
            }),
            limits: sensor.limits.as_ref().map(|limits| LimitsReply {
                force_n: limits.force_n,
                depth_mm: limits.depth_mm,
            }),
        }
    }
}
