//! Presses of a gel, solved by finite elements (FEM). A surrogate is trained and tested on them.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use twintac_sensor::Sensor;
use twintac_shape::{Pose, Shape};

use crate::surface::SurfaceGrid;

/// The FEM solution of one press.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FemPress {
    /// The indenter's shape.
    pub shape: Shape,
    /// Length of the mesh's edges under the shape, mm. Coarse meshes give too low pressures, so
    /// this length is an input of the network.
    pub edge_mm: f64,
    /// The gel at increasing depths, in equal steps from first touch on.
    pub frames: Vec<FemFrame>,
}

/// One frame of a press.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FemFrame {
    /// Pose of the shape in the gel's frame.
    pub gel_from_indenter: Pose,
    /// Force on the gel, N.
    pub force_n: DVec3,
    /// Torque on the gel about the origin of its frame, N mm.
    pub torque_n_mm: DVec3,
    /// Hydrostatic pressure at each location of [`training_places_mm`], averaged over a disc as
    /// large as a port, kPa. `[n_places]`
    pub floor_kpa: Vec<f32>,
}

impl FemPress {
    /// The shape's pose at first touch, extrapolated: frames follow each other straight down in
    /// equal steps. `None` for a press of fewer than two frames.
    pub(crate) fn touch(&self) -> Option<Pose> {
        let [first, second, ..] = &self.frames[..] else {
            return None;
        };
        let (first, second) = (first.gel_from_indenter, second.gel_from_indenter);
        Some(Pose {
            position_mm: 2.0 * first.position_mm - second.position_mm,
            ..first
        })
    }
}

/// Locations of the gel's base at which training presses evaluate the pressure, in the gel's plane,
/// mm: the taxels first, then a grid over the whole base if nothing is cast into the gel. With
/// chips in the gel, the pressure on top of a chip differs from that elsewhere.
#[must_use]
pub fn training_places_mm(sensor: &Sensor) -> Vec<DVec2> {
    let taxels = sensor.taxels.iter().map(|taxel| taxel.position_mm.truncate());
    let mut places_mm: Vec<DVec2> = taxels.collect();
    if sensor.inclusions.is_empty() {
        let grids = SurfaceGrid::all(sensor);
        if sensor.has_port_at_side() {
            // The response of a port at the gel's side occurs nowhere else, so all grids are used:
            // the more locations there, the better.
            let places = grids.iter().flat_map(|grid| grid.floor(sensor, 0.0));
            places_mm.extend(places);
        } else {
            places_mm.extend(grids[0].floor(sensor, sensor.taxels[0].port_radius_mm));
        }
    }
    places_mm
}
