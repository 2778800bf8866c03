//! The geometry that the mechanics around a board are made from. All lengths are in mm. z points
//! up, and z = 0 is the plane of the ports.

use serde::{Deserialize, Serialize};
use twintac_sensor::Sensor;
use twintac_shape::{Shape, Solid};

use crate::barometer::Barometer;
use crate::design::Design;
use crate::outline::SHELL_WALL_MM;
use crate::rules::{SCREW_DRILL_MM, THICKNESS_MM};

/// A board and the gel on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Geometry {
    /// The variant's name.
    pub variant: String,
    /// A description of the sensor in a sentence or two.
    pub summary: String,
    /// SHA-256 of the description's file.
    pub sensor_sha256: String,
    /// The gel.
    pub gel: GelGeometry,
    /// The shell, if the description has one.
    pub shell: Option<ShellGeometry>,
    /// The taxels' ports.
    pub taxels: Vec<TaxelGeometry>,
    /// The barometers.
    pub chip: ChipGeometry,
    /// The board.
    pub board: BoardGeometry,
    /// The indenters.
    pub indenters: Vec<IndenterGeometry>,
}

/// The gel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GelGeometry {
    /// Its shape, as described.
    pub solid: Solid,
    /// Its volume, mm³.
    pub volume_mm3: f64,
    /// Its bounding box: lowest and highest corner, mm.
    pub bounds_mm: [[f64; 3]; 2],
}

/// The shell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShellGeometry {
    /// Distance from the gel's outline to the walls, mm.
    pub gap_mm: f64,
    /// Height of the walls above the ports, mm.
    pub height_mm: f64,
    /// Thickness of the walls, mm.
    pub wall_mm: f64,
}

/// A taxel's port.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TaxelGeometry {
    /// Its name.
    pub name: String,
    /// Its centre, mm.
    pub position_mm: [f64; 3],
    /// Its radius, mm.
    pub port_radius_mm: f64,
}

/// The barometers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChipGeometry {
    /// The manufacturer's name.
    pub name: String,
    /// Size of the body along x and y, mm.
    pub body_mm: [f64; 2],
    /// Height above the board, mm.
    pub height_mm: f64,
    /// Radius of the ports as described, mm; the largest one.
    pub port_radius_mm: f64,
    /// Whether land pattern and height come from a data sheet.
    pub footprint_confirmed: bool,
}

/// The board.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoardGeometry {
    /// Corners, counter-clockwise from above, mm.
    pub outline_mm: Vec<[f64; 2]>,
    /// Thickness, mm.
    pub thickness_mm: f64,
    /// Height of the top face, mm.
    pub top_z_mm: f64,
    /// Holes for screws.
    pub holes: Vec<HoleGeometry>,
    /// The parts on the bottom face, without the connector.
    pub bottom_parts: Vec<PartGeometry>,
    /// The connector, on the bottom face.
    pub connector: ConnectorGeometry,
}

/// A hole for a screw.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HoleGeometry {
    /// Its centre, mm.
    pub position_mm: [f64; 2],
    /// Its diameter, mm.
    pub drill_mm: f64,
    /// The screw.
    pub screw: String,
}

/// The body of a part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PartGeometry {
    /// Its reference.
    pub reference: String,
    /// Centre of the body, mm.
    pub center_mm: [f64; 2],
    /// Width along x, depth along y, and height, mm.
    pub size_mm: [f64; 3],
}

/// The connector.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConnectorGeometry {
    /// Its reference.
    pub reference: String,
    /// Centre of the body, mm.
    pub center_mm: [f64; 2],
    /// Width along x, depth along y, and height, mm.
    pub size_mm: [f64; 3],
    /// Direction of the connector's opening: the cable comes from there.
    pub opens_toward: [i8; 2],
}

/// An indenter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct IndenterGeometry {
    /// Its name.
    pub name: String,
    /// Its shape, as described.
    pub shape: Shape,
}

impl Geometry {
    pub(crate) fn new(board: &Design, sensor: &Sensor, chip: &Barometer, sensor_sha256: &str) -> Self {
        let solid = &sensor.gel.solid;
        let (low, high) = solid.bounds_mm(&sensor.surfaces);
        let (connector, parts) = on_bottom(board, sensor.taxels.len());
        Self {
            variant: board.variant.clone(),
            summary: sensor.summary.clone(),
            sensor_sha256: sensor_sha256.to_owned(),
            gel: GelGeometry {
                solid: solid.clone(),
                volume_mm3: rounded([solid.volume_mm3(&sensor.surfaces)])[0],
                bounds_mm: [rounded(low.into()), rounded(high.into())],
            },
            shell: sensor.shell.as_ref().map(|shell| ShellGeometry {
                gap_mm: shell.gap_mm,
                height_mm: shell.height_mm,
                wall_mm: SHELL_WALL_MM,
            }),
            taxels: sensor
                .taxels
                .iter()
                .map(|taxel| TaxelGeometry {
                    name: taxel.name.clone(),
                    position_mm: taxel.position_mm.into(),
                    port_radius_mm: taxel.port_radius_mm,
                })
                .collect(),
            chip: ChipGeometry {
                name: chip.name.to_owned(),
                body_mm: chip.body_mm,
                height_mm: chip.height_mm,
                port_radius_mm: sensor
                    .taxels
                    .iter()
                    .map(|taxel| taxel.port_radius_mm)
                    .fold(0.0, f64::max),
                footprint_confirmed: chip.is_confirmed,
            },
            board: BoardGeometry {
                outline_mm: board
                    .outline
                    .corners
                    .iter()
                    .map(|at| rounded((*at).into()))
                    .collect(),
                thickness_mm: THICKNESS_MM,
                top_z_mm: -chip.height_mm,
                holes: board.outline.holes.iter().map(hole).collect(),
                bottom_parts: parts,
                connector: ConnectorGeometry {
                    reference: connector.reference,
                    center_mm: connector.center_mm,
                    size_mm: connector.size_mm,
                    opens_toward: [0, -1],
                },
            },
            indenters: sensor
                .indenters
                .iter()
                .map(|indenter| IndenterGeometry {
                    name: indenter.name.clone(),
                    shape: indenter.shape.clone(),
                })
                .collect(),
        }
    }
}

/// The connector, and the other parts on the bottom face. The first `n_chips` parts are the chips.
fn on_bottom(board: &Design, n_chips: usize) -> (PartGeometry, Vec<PartGeometry>) {
    let geometry = |index: usize| {
        let (part, place) = (&board.circuit.parts[index], &board.places[index]);
        let land = &part.device.land;
        let body = place.area(&land.body);
        PartGeometry {
            reference: part.reference.clone(),
            center_mm: rounded(body.center().into()),
            size_mm: rounded([body.size().x, body.size().y, land.height_mm]),
        }
    };
    let others = (n_chips..board.circuit.parts.len()).filter(|index| *index != board.circuit.connector);
    let has_body = |part: &PartGeometry| part.size_mm[2] > 0.0;
    (
        geometry(board.circuit.connector),
        others.map(geometry).filter(has_body).collect(),
    )
}

fn hole(at: &glam::DVec2) -> HoleGeometry {
    HoleGeometry {
        position_mm: rounded((*at).into()),
        drill_mm: SCREW_DRILL_MM,
        screw: "M2".to_owned(),
    }
}

/// Rounds to a millionth of a millimetre, so that sums of decimal numbers are decimal numbers
/// again.
fn rounded<const N: usize>(values: [f64; N]) -> [f64; N] {
    values.map(|value| (value * 1e6).round() / 1e6 + 0.0)
}
