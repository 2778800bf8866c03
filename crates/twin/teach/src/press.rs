//! A press of the solved gel, as a lesson.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use twintac_fast::{Lesson, LessonFrame};
use twintac_sensor::{Sensor, Taxel};
use twintac_shape::Pose;
use twintac_simulate::{Gel, PortReadout, PressPlace, SimulateError, SimulateSettings};

use crate::draw::{Draw, Purpose, draw};

/// Frames of a press.
const N_FRAMES: u32 = 5;

/// Finer meshes than any that is asked for.
const MAX_NODES: usize = 60_000;

/// Why there is no lesson.
#[derive(Debug, thiserror::Error)]
pub enum TeachError {
    /// The gel can't be pressed so.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// The shape can't be.
    #[error(transparent)]
    Shape(#[from] twintac_shape::ShapeError),
}

/// Presses one sensor's gel at random.
#[derive(Clone, Debug)]
pub struct Teacher {
    sensor: Arc<Sensor>,
    /// Where the floor's pressure is read, as ports.
    places: Vec<Taxel>,
}

impl Teacher {
    /// A teacher who reads the floor at these places of the gel's plane, mm. `[n_places]`
    #[must_use]
    pub fn new(sensor: Arc<Sensor>, places_mm: &[DVec2]) -> Self {
        let port = &sensor.taxels[0];
        let places = places_mm.iter().map(|at| Taxel {
            position_mm: at.extend(port.position_mm.z),
            ..port.clone()
        });
        Self {
            places: places.collect(),
            sensor,
        }
    }

    /// The lesson of a number; the same number gives the same lesson. It ends where the solver does, and has no frames if that cannot begin.
    ///
    /// # Errors
    /// A sensor that cannot be meshed.
    pub fn lesson(&self, seed: u64, number: u64) -> Result<Lesson, TeachError> {
        let random = &mut twintac_random::stream(seed, &format!("lesson {number}"));
        self.press(&draw(&self.sensor, Purpose::Lesson, random))
    }

    /// The exam of a number: a press of a shape that no lesson has.
    ///
    /// # Errors
    /// A sensor that cannot be meshed.
    pub fn exam(&self, seed: u64, number: u64) -> Result<Lesson, TeachError> {
        let random = &mut twintac_random::stream(seed, &format!("exam {number}"));
        self.press(&draw(&self.sensor, Purpose::Exam, random))
    }

    fn press(&self, drawn: &Draw) -> Result<Lesson, TeachError> {
        let settings = SimulateSettings {
            edges_per_height: drawn.edges_per_height,
            contact_edge_mm: Some(drawn.edge_mm),
            max_nodes: MAX_NODES,
            ..SimulateSettings::default()
        };
        let gel = Gel::new(Arc::clone(&self.sensor), settings);
        let mut lesson = Lesson {
            shape: drawn.shape.clone(),
            edge_mm: drawn.edge_mm,
            frames: Vec::new(),
        };
        let above = Pose {
            position_mm: drawn.place_mm.extend(0.0),
            rotation: drawn.rotation,
        };
        let touch = match gel.touch(&drawn.shape, &above) {
            Err(SimulateError::NoTouch { .. }) => return Ok(lesson),
            touch => touch?,
        };
        let mesh = gel.mesh(&PressPlace {
            indenter: String::new(),
            shape: drawn.shape.clone(),
            x_mm: drawn.place_mm.x,
            y_mm: drawn.place_mm.y,
            rotation: drawn.rotation,
            depth_mm: drawn.depth_mm,
            enough_force_n: None,
        })?;
        let body = mesh.body();
        let ports = self
            .places
            .iter()
            .map(|place| PortReadout::of_taxel(body.mesh(), place));
        let ports = ports.collect::<Result<Vec<_>, _>>()?;
        let indenter = drawn.shape.signed_distance_field(&self.sensor.surfaces)?;
        let mut state = body.rest();
        for frame in 1..=N_FRAMES {
            let depth_mm = drawn.depth_mm * f64::from(frame) / f64::from(N_FRAMES);
            let pose = Pose {
                position_mm: touch.position_mm - DVec3::Z * depth_mm,
                ..touch
            };
            let Ok(solved) = body.advance(&mut state, indenter.as_ref(), &pose, 0.0) else {
                break;
            };
            let nodal_kpa = body.pressure_kpa(&state);
            let force_n = solved.indenter_force_n;
            lesson.frames.push(LessonFrame {
                gel_from_indenter: pose,
                force_n,
                torque_n_mm: solved.indenter_torque_n_mm + pose.position_mm.cross(force_n),
                floor_kpa: ports.iter().map(|port| port.read(&nodal_kpa) as f32).collect(),
            });
        }
        Ok(lesson)
    }
}
