//! The FEM solution of a press.

use std::sync::Arc;

use glam::{DQuat, DVec2, DVec3};
use twintac_fast::{FemFrame, FemPress};
use twintac_sensor::{Sensor, Taxel};
use twintac_shape::{Pose, Shape};
use twintac_simulate::{Gel, PortReadout, PressPlace, SimulateError, SimulateSettings};

use crate::OodKind;
use crate::draw::{Draw, Own, Purpose, Slide, draw, edges_per_height, own, upright};
use crate::random_mesh::test_surfaces;

/// Frames of a press on its way down.
const N_FRAMES: u32 = 5;

/// Frames of a sliding press after it is down.
const N_SLIDE_FRAMES: u32 = 5;

/// Limit of a mesh's nodes, larger than any mesh of these presses.
const MAX_NODES: usize = 60_000;

/// Why a press could not be made.
#[derive(Debug, thiserror::Error)]
pub enum FemPressError {
    /// The gel could not be simulated.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// The shape cannot exist.
    #[error(transparent)]
    Shape(#[from] twintac_shape::ShapeError),
    /// The sensor has no indenters.
    #[error("the sensor describes no indenters to press with")]
    NoIndenter,
    /// The surface of a shape cannot exist.
    #[error(transparent)]
    Surface(#[from] twintac_shape::SurfaceError),
}

/// Makes random presses of one sensor's gel.
#[derive(Clone, Debug)]
pub struct FemPresses {
    sensor: Arc<Sensor>,
    /// The locations at which the pressure is evaluated, as ports.
    places: Vec<Taxel>,
}

impl FemPresses {
    /// Evaluates the pressure at these locations of the gel's plane, mm: over a disc with the
    /// radius and height of the port of the taxel at that location, or of the first taxel's port
    /// where no taxel is. `[n_places]`
    ///
    /// # Errors
    /// None that is known.
    pub fn new(sensor: &Sensor, places_mm: &[DVec2]) -> Result<Self, FemPressError> {
        // Test presses use surfaces that the sensor does not have.
        let mut sensor = sensor.clone();
        sensor.surfaces.extend(test_surfaces()?);
        let places = places_mm.iter().map(|at| {
            let mut taxels = sensor.taxels.iter();
            let own = taxels.find(|taxel| taxel.position_mm.truncate() == *at);
            let port = own.unwrap_or(&sensor.taxels[0]);
            Taxel {
                position_mm: at.extend(port.position_mm.z),
                ..port.clone()
            }
        });
        Ok(Self {
            places: places.collect(),
            sensor: Arc::new(sensor),
        })
    }

    /// The training press of a number; the same number gives the same press. It ends where the
    /// solver fails or the force decreases, and has no frames if this happens at once.
    ///
    /// # Errors
    /// A sensor that cannot be meshed.
    pub fn training_press(&self, seed: u64, number: u64) -> Result<FemPress, FemPressError> {
        let random = &mut twintac_random::stream(seed, &format!("lesson {number}"));
        self.press(&draw(&self.sensor, Purpose::Training, random))
    }

    /// A training press with one of the sensor's own indenters, upright and no farther from the
    /// ports than the gel is high; locations are evenly spread. The radii of balls are 0.6 to 1.6
    /// times the described ones.
    ///
    /// # Errors
    /// A sensor that cannot be meshed, or has no indenters.
    pub fn own_training_press(&self, seed: u64, number: u64) -> Result<FemPress, FemPressError> {
        self.own(Own::Training, seed, number)
    }

    /// The same as a test press.
    ///
    /// # Errors
    /// Those of [`Self::own_training_press`].
    pub fn own_test_press(&self, seed: u64, number: u64) -> Result<FemPress, FemPressError> {
        self.own(Own::Test, seed, number)
    }

    fn own(&self, of: Own, seed: u64, number: u64) -> Result<FemPress, FemPressError> {
        match own(&self.sensor, of, seed, number) {
            Some(drawn) => self.press(&drawn),
            None => Err(FemPressError::NoIndenter),
        }
    }

    /// The test press of a number: a press of a shape that is not trained on.
    ///
    /// # Errors
    /// A sensor that cannot be meshed.
    pub fn test_press(&self, seed: u64, number: u64) -> Result<FemPress, FemPressError> {
        let random = &mut twintac_random::stream(seed, &format!("exam {number}"));
        self.press(&draw(&self.sensor, Purpose::Test, random))
    }

    /// The sliding test press of a number: the shape of a test press goes down, then sideways, and
    /// rotates on the way. Without friction the state of the gel does not depend on the path, so
    /// each pose is reached from rest: the mesh of a gel that is pushed along instead stays caught
    /// in front of sharp edges.
    ///
    /// # Errors
    /// A sensor that cannot be meshed.
    pub fn slide(&self, seed: u64, number: u64) -> Result<FemPress, FemPressError> {
        let random = &mut twintac_random::stream(seed, &format!("slide {number}"));
        let drawn = draw(&self.sensor, Purpose::Slide, random);
        let mut press = self.press(&drawn)?;
        let Some(slide) = &drawn.slide else {
            return Ok(press);
        };
        let down = press.frames.last().map(|down| down.gel_from_indenter);
        let Some(down) = down.filter(|_| is_whole(&press)) else {
            return Ok(press);
        };
        for pose in on_the_way(down, slide) {
            let Some(touch) = self.touch(&drawn.shape, &pose)? else {
                continue;
            };
            let there = self.press(&Draw {
                place_mm: pose.position_mm.truncate(),
                rotation: pose.rotation,
                depth_mm: touch.position_mm.z - pose.position_mm.z,
                ..drawn.clone()
            })?;
            if is_whole(&there) {
                press.frames.extend(there.frames.into_iter().last());
            }
        }
        Ok(press)
    }

    /// A press of an upright shape with given parameters: location, mm, rotation about the
    /// vertical, radians, and depth below first touch, mm; on the finest mesh, like a test press.
    ///
    /// # Errors
    /// A sensor that cannot be meshed, a shape that cannot exist.
    pub fn upright(
        &self,
        shape: &Shape,
        place_mm: DVec2,
        yaw_rad: f64,
        depth_mm: f64,
    ) -> Result<FemPress, FemPressError> {
        self.press(&upright(&self.sensor, shape, place_mm, yaw_rad, depth_mm))
    }

    /// An out-of-distribution press, on the finest mesh: only the frames that are out of
    /// distribution.
    ///
    /// # Errors
    /// A sensor that cannot be meshed.
    pub fn ood_press(&self, kind: OodKind, seed: u64, number: u64) -> Result<FemPress, FemPressError> {
        let name = format!("strange {} {number}", kind.name());
        let random = &mut twintac_random::stream(seed, &name);
        let (drawn, from_mm) = kind.draw(&self.sensor, random);
        let mut press = self.press(&drawn)?;
        let n_solved = press.frames.len();
        let from_frame = (from_mm / drawn.depth_mm * f64::from(N_FRAMES)).floor() as usize;
        press.frames.drain(..from_frame.min(n_solved));
        Ok(press)
    }

    /// Presses straight down, as far as the solver converges.
    fn press(&self, drawn: &Draw) -> Result<FemPress, FemPressError> {
        let settings = SimulateSettings {
            edges_per_height: edges_per_height(&self.sensor, drawn.edge_mm),
            contact_edge_mm: Some(drawn.edge_mm),
            max_nodes: MAX_NODES,
            ..SimulateSettings::default()
        };
        let gel = Gel::new(Arc::clone(&self.sensor), settings);
        let mut press = FemPress {
            shape: drawn.shape.clone(),
            edge_mm: drawn.edge_mm,
            frames: Vec::new(),
        };
        let above = Pose {
            position_mm: drawn.place_mm.extend(0.0),
            rotation: drawn.rotation,
        };
        let Some(touch) = self.touch(&drawn.shape, &above)? else {
            return Ok(press);
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
            let depth_mm = f64::from(frame) / f64::from(N_FRAMES) * drawn.depth_mm;
            let pose = Pose {
                position_mm: touch.position_mm - depth_mm * DVec3::Z,
                ..touch
            };
            let Ok(solved) = body.advance(&mut state, indenter.as_ref(), &pose, 0.0) else {
                break;
            };
            let nodal_kpa = body.pressure_kpa(&state);
            let force_n = solved.indenter_force_n;
            // No elastic gel pushes less as a press goes deeper: a thin part has slipped between
            // the nodes of the mesh.
            let before_n = press.frames.last().map_or(0.0, |before| before.force_n.z);
            if force_n.z > before_n {
                break;
            }
            press.frames.push(FemFrame {
                gel_from_indenter: pose,
                force_n,
                torque_n_mm: solved.indenter_torque_n_mm + pose.position_mm.cross(force_n),
                floor_kpa: ports.iter().map(|port| port.read(&nodal_kpa) as f32).collect(),
            });
        }
        Ok(press)
    }

    /// The pose at which a shape first touches the gel on its way down through a pose; `None`
    /// beside the gel.
    fn touch(&self, shape: &Shape, above: &Pose) -> Result<Option<Pose>, FemPressError> {
        let gel = Gel::new(Arc::clone(&self.sensor), SimulateSettings::default());
        match gel.touch(shape, above) {
            Err(SimulateError::NoTouch { .. }) => Ok(None),
            touch => Ok(Some(touch?)),
        }
    }
}

/// Whether a press reached its full depth.
fn is_whole(press: &FemPress) -> bool {
    press.frames.len() == N_FRAMES as usize
}

/// The poses of a sliding press, from the pose in which the shape is down.
fn on_the_way(down: Pose, slide: &Slide) -> impl Iterator<Item = Pose> {
    (1..=N_SLIDE_FRAMES).map(move |frame| {
        let part = f64::from(frame) / f64::from(N_SLIDE_FRAMES);
        Pose {
            position_mm: down.position_mm + (part * slide.by_mm).extend(0.0),
            rotation: (DQuat::IDENTITY.slerp(slide.turn, part) * down.rotation).normalize(),
        }
    })
}
