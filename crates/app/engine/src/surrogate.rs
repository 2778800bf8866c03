//! A gel that several shapes press at once, by its surrogate.

use std::sync::Arc;

use glam::DVec3;
use twintac_fast::{Body, FastGel, FastReader};
use twintac_sensor::Sensor;
use twintac_shape::{Pose, Shape, SignedDistance};

use crate::arrays::{Array, Arrays};
use crate::error::EngineError;
use crate::map::Map;
use crate::press::{PROVENANCE, Press};
use crate::request::{Frame, Placed, Quality};

/// A node of the drawn gel is this near to a shape after it was moved out, mm.
const DRAWN_MM: f64 = 0.01;

/// Steps in which a node is moved out of a shape.
const STEPS: usize = 60;

/// The surrogate of a sensor's gel, and the shapes that pressed it so far.
pub(crate) struct Surrogate {
    /// The stored file that it was read from.
    file: String,
    sensor: Arc<Sensor>,
    reader: FastReader,
    known: Vec<(Shape, Indenter)>,
    map: Option<Map>,
    /// The top of the gel's middle, mm: torques of the surrogate are about it.
    top_mm: DVec3,
}

/// A shape, as the surrogate needs it, and for drawing.
struct Indenter {
    body: Body,
    distance: Box<dyn SignedDistance>,
}

impl Surrogate {
    /// Reads a surrogate, and checks that it is that of the sensor's gel.
    pub(crate) fn new(file: &str, bytes: &[u8], sensor: &Arc<Sensor>) -> Result<Self, EngineError> {
        let gel = FastGel::from_bytes(bytes).map_err(|error| EngineError::Surrogate {
            file: file.to_owned(),
            problem: error.to_string(),
        })?;
        gel.check(sensor)?;
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        Ok(Self {
            file: file.to_owned(),
            sensor: Arc::clone(sensor),
            reader: gel.reader(),
            known: Vec::new(),
            map: Map::of(sensor, Array::MapKpa),
            top_mm: (0.5 * (low + high)).with_z(high.z),
        })
    }

    /// The file that it was read from.
    pub(crate) fn file(&self) -> &str {
        &self.file
    }

    /// Presses shapes, and draws the gel of `press` as they indent it.
    pub(crate) fn touch(
        &mut self,
        placed: &[Placed],
        press: &Press,
        arrays: &mut Arrays,
    ) -> Result<Frame, EngineError> {
        for Placed {
            shape,
            gel_from_indenter,
        } in placed
        {
            if !gel_from_indenter.rotation.is_normalized() {
                return Err(EngineError::Setting {
                    field: "rotation",
                    found: gel_from_indenter.rotation.length(),
                    expected: "a quaternion of length 1",
                });
            }
            if !self.known.iter().any(|(known, _)| known == shape) {
                let indenter = Indenter {
                    body: Body::new(shape, &self.sensor.surfaces)?,
                    distance: shape.signed_distance_field(&self.sensor.surfaces)?,
                };
                self.known.push((shape.clone(), indenter));
            }
        }
        let known = |shape: &Shape| self.known.iter().find(|(known, _)| known == shape);
        let shapes: Vec<(&Indenter, Pose)> = placed
            .iter()
            .filter_map(|placed| Some((&known(&placed.shape)?.1, placed.gel_from_indenter)))
            .collect();
        let bodies: Vec<(&Body, Pose)> = shapes.iter().map(|(shape, pose)| (&shape.body, *pose)).collect();
        let mut pressures = vec![0.0; self.reader.n_taxels()];
        let mut wrench = [0.0; 6];
        self.reader.read(&bodies, &mut pressures, &mut wrench);
        let ood_score = self.reader.ood_score(&bodies);
        let pressure_kpa: Vec<f64> = pressures.into_iter().map(f64::from).collect();
        if let Some(map) = &mut self.map {
            map.show(&pressure_kpa, arrays);
        }
        press.draw_moved(|at_mm| pushed_out(&shapes, at_mm), arrays);
        let [fx, fy, fz, tx, ty, tz] = wrench.map(f64::from);
        let (force_n, torque_n_mm) = (DVec3::new(fx, fy, fz), DVec3::new(tx, ty, tz));
        let origin_mm = placed.first().map(|first| first.gel_from_indenter.position_mm);
        let lever_mm = origin_mm.map_or(DVec3::ZERO, |origin_mm| self.top_mm - origin_mm);
        Ok(Frame {
            depth_mm: origin_mm.map_or(0.0, |origin_mm| press.touch_mm() - origin_mm.z),
            force_n: force_n.to_array(),
            torque_n_mm: (torque_n_mm + lever_mm.cross(force_n)).to_array(),
            pressure_kpa,
            quality: Quality::Surrogate { ood_score },
            provenance: PROVENANCE,
        })
    }
}

/// A point moved down out of all shapes, mm.
fn pushed_out(shapes: &[(&Indenter, Pose)], mut at_mm: DVec3) -> DVec3 {
    for (shape, pose) in shapes {
        let distance_mm = |at_mm| {
            let local_mm = pose.inverse_transform_point(at_mm);
            shape.distance.signed_distance(local_mm).distance_mm
        };
        for _ in 0..STEPS {
            let inside_mm = -distance_mm(at_mm);
            if inside_mm < DRAWN_MM {
                break;
            }
            // No surface is nearer.
            at_mm.z -= inside_mm;
        }
    }
    at_mm
}
