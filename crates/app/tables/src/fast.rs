//! Tables over depth from a surrogate, where nothing is solved.

use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;
use twintac_depth_table::{DepthTable, PressFrame, SolveQuality, SourceError};
use twintac_fast::{Body, FastGel, FastReader};
use twintac_sensor::Sensor;
use twintac_shape::{Pose, Shape, ShapeError};
use twintac_simulate::{Gel, PressPlace};
use twintac_store::Keyed;
use twintac_work::WorkError;

/// Name of a surrogate's file in its folder.
pub const FAST_GEL: &str = "fast.safetensors";

/// Step of the finite differences for the slopes of the pressure: how far the indenter is moved
/// aside, mm.
const ASIDE_MM: f64 = 0.5;

/// A surrogate of one sensor's gel, as a source of tables.
#[derive(Debug)]
pub struct FastTables {
    fast: FastGel,
    /// Shapes that were used before: to sample a shape takes longer than a press with it.
    bodies: Mutex<Vec<(Shape, Arc<Body>)>>,
}

/// A surrogate, evaluated for one body.
struct Reading {
    reader: FastReader,
    body: Arc<Body>,
}

impl FastTables {
    /// Reads a surrogate's file. Returns the surrogate and the file's bytes.
    ///
    /// # Errors
    /// A file that cannot be read or is something else; a surrogate of another gel.
    pub fn read(path: &Path, sensor: &Sensor) -> Result<(Keyed<Self>, Vec<u8>), WorkError> {
        let bytes = std::fs::read(path).map_err(WorkError::file("reading", path))?;
        let fast = FastGel::from_bytes(&bytes)
            .map_err(|error| WorkError::Input(format!("{}: {error}", path.display())))?;
        let tables = Self::of(fast, sensor, &path.display().to_string())?;
        Ok((Keyed::of_bytes(tables, &bytes), bytes))
    }

    /// The tables of a surrogate. Error messages call it `name`.
    ///
    /// # Errors
    /// A surrogate of another gel.
    pub fn of(fast: FastGel, sensor: &Sensor, name: &str) -> Result<Self, WorkError> {
        fast.check(sensor)
            .map_err(|mismatch| WorkError::Input(format!("{name}: {mismatch}")))?;
        Ok(Self {
            fast,
            bodies: Mutex::default(),
        })
    }

    /// The surrogate.
    pub fn gel(&self) -> &FastGel {
        &self.fast
    }

    /// A shape, sampled for the surrogate.
    ///
    /// # Errors
    /// An impossible shape.
    pub fn body(&self, shape: &Shape, sensor: &Sensor) -> Result<Arc<Body>, ShapeError> {
        let mut bodies = self.bodies.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, body)) = bodies.iter().find(|(known, _)| known == shape) {
            return Ok(Arc::clone(body));
        }
        let body = Arc::new(Body::new(shape, &sensor.surfaces)?);
        bodies.push((shape.clone(), Arc::clone(&body)));
        Ok(body)
    }

    /// The table at a location. Its stress features are zero: the surrogate does not compute them.
    pub fn table(&self, gel: &Gel, place: &PressPlace) -> Result<DepthTable, SourceError> {
        let above = Pose {
            position_mm: DVec3::new(place.x_mm, place.y_mm, 0.0),
            rotation: place.rotation,
        };
        let touch = gel.touch(&place.shape, &above)?;
        let mut reading = Reading {
            reader: self.fast.reader(),
            body: self.body(&place.shape, gel.sensor())?,
        };
        let mut frames = Vec::new();
        for keyframe in gel.depths(place) {
            let frame = self.frame(&mut reading, gel.sensor(), &touch, keyframe.depth_mm);
            let is_enough = place
                .enough_force_n
                .is_some_and(|enough_n| frame.force_n >= enough_n);
            frames.push(frame);
            if is_enough {
                break;
            }
        }
        Ok(DepthTable {
            indenter: place.indenter.clone(),
            gel_from_indenter_at_touch: touch,
            n_nodes: 0,
            frames,
            failure: None,
        })
    }

    fn frame(&self, reading: &mut Reading, sensor: &Sensor, touch: &Pose, depth_mm: f64) -> PressFrame {
        let mut read = |aside_mm: DVec3| {
            let pose = Pose {
                position_mm: touch.position_mm - depth_mm * DVec3::Z + aside_mm,
                ..*touch
            };
            let (mut pressure_kpa, mut wrench) = (vec![0.0; sensor.taxels.len()], [0.0; 6]);
            reading
                .reader
                .read(&[(&reading.body, pose)], &mut pressure_kpa, &mut wrench);
            (
                pressure_kpa.into_iter().map(f64::from).collect::<Vec<_>>(),
                wrench,
            )
        };
        let (here_kpa, wrench) = read(DVec3::ZERO);
        // A port that is farther along x feels here what the present port would feel of an indenter
        // that is less far along x.
        let around =
            [DVec3::X, DVec3::Y].map(|way| [-ASIDE_MM, ASIDE_MM].map(|aside_mm| read(aside_mm * way).0));
        let slopes = sensor.taxels.iter().enumerate().map(|(taxel, described)| {
            let along = around.each_ref().map(|[farther, nearer]| {
                let slope = (farther[taxel] - nearer[taxel]) / (2.0 * ASIDE_MM);
                let curvature = farther[taxel] - 2.0 * here_kpa[taxel] + nearer[taxel];
                (slope, curvature / (ASIDE_MM * ASIDE_MM))
            });
            // The mean over a disc of radius r is p + r²/8 ∇²p + …
            let wider = 0.25 * described.port_radius_mm * (along[0].1 + along[1].1);
            [along[0].0, along[1].0, wider]
        });
        PressFrame {
            depth_mm,
            force_n: -f64::from(wrench[2]),
            port_slope_kpa_per_mm: slopes.collect(),
            stress_feature_kpa_per_mm: vec![0.0; here_kpa.len()],
            port_pressure_kpa: here_kpa,
            quality: SolveQuality {
                iterations: 0,
                residual: 0.0,
                penetration_mm: 0.0,
                smallest_volume_ratio: 1.0,
                wall_time_s: 0.0,
            },
        }
    }
}
