//! What the fast twin learns from: presses of a gel that was solved.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use twintac_sensor::Sensor;
use twintac_shape::{Pose, Shape};

use crate::surface::SurfaceGrid;

/// One press of a solved gel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lesson {
    /// What pressed.
    pub shape: Shape,
    /// Length of the mesh's edges under it, mm. Coarse meshes read too little: the network is told how coarse.
    pub edge_mm: f64,
    /// The gel at increasing depths, evenly from first touch on.
    pub frames: Vec<LessonFrame>,
}

/// A moment of a press.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LessonFrame {
    /// Where the shape was.
    pub gel_from_indenter: Pose,
    /// Force on the gel, N.
    pub force_n: DVec3,
    /// Torque on the gel about the origin of its frame, N mm.
    pub torque_n_mm: DVec3,
    /// Hydrostatic pressure over a disc as large as a port at each of the lesson plan's places, kPa. `[n_places]`
    pub floor_kpa: Vec<f32>,
}

impl Lesson {
    /// The shape's pose at first touch: frames follow each other straight down at even distances. `None` for a lesson of fewer than two.
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

/// Where lessons read the floor of a sensor's gel, in its plane, mm: at each taxel, then all over if nothing is cast into the gel: what a port feels
/// on top of a chip it would not feel elsewhere.
#[must_use]
pub fn lesson_places_mm(sensor: &Sensor) -> Vec<DVec2> {
    let taxels = sensor.taxels.iter().map(|taxel| taxel.position_mm.truncate());
    let mut places_mm: Vec<DVec2> = taxels.collect();
    if sensor.inclusions.is_empty() {
        let grids = SurfaceGrid::all(sensor);
        if sensor.has_port_at_side() {
            // What a port feels over the gel's side is felt nowhere else: the more places there, the better.
            let places = grids.iter().flat_map(|grid| grid.floor(sensor, 0.0));
            places_mm.extend(places);
        } else {
            places_mm.extend(grids[0].floor(sensor, sensor.taxels[0].port_radius_mm));
        }
    }
    places_mm
}
