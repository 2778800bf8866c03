//! Tables over depth that a fast gel makes, where nothing is solved.

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

/// File of a fast gel in its folder.
pub const FAST_GEL: &str = "fast.safetensors";

/// By how much an indenter is moved aside for the slopes of the pressure, mm.
const ASIDE_MM: f64 = 0.5;

/// A fast gel of one sensor.
#[derive(Debug)]
pub struct FastTables {
    fast: FastGel,
    /// Shapes that were asked for: sampling one takes longer than a press with it.
    bodies: Mutex<Vec<(Shape, Arc<Body>)>>,
}

/// A fast gel that reads one body.
struct Reading {
    reader: FastReader,
    body: Arc<Body>,
}

impl FastTables {
    /// The fast gel of a file, and the file's bytes.
    ///
    /// # Errors
    /// A file that cannot be read or is something else, and the fast gel of another gel.
    pub fn read(path: &Path, sensor: &Sensor) -> Result<(Keyed<Self>, Vec<u8>), WorkError> {
        let bytes = std::fs::read(path).map_err(WorkError::file("reading", path))?;
        let fast = FastGel::from_bytes(&bytes)
            .map_err(|error| WorkError::Input(format!("{}: {error}", path.display())))?;
        let tables = Self::of(fast, sensor, &path.display().to_string())?;
        Ok((Keyed::of_bytes(tables, &bytes), bytes))
    }

    /// A fast gel, which is called so in errors.
    ///
    /// # Errors
    /// The fast gel of another gel.
    pub fn of(fast: FastGel, sensor: &Sensor, name: &str) -> Result<Self, WorkError> {
        fast.check(sensor)
            .map_err(|mismatch| WorkError::Input(format!("{name}: {mismatch}")))?;
        Ok(Self {
            fast,
            bodies: Mutex::default(),
        })
    }

    /// The fast gel.
    pub fn gel(&self) -> &FastGel {
        &self.fast
    }

    /// A shape as the fast gel feels it.
    ///
    /// # Errors
    /// A shape that can't be.
    pub fn body(&self, shape: &Shape, sensor: &Sensor) -> Result<Arc<Body>, ShapeError> {
        let mut bodies = self.bodies.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, body)) = bodies.iter().find(|(known, _)| known == shape) {
            return Ok(Arc::clone(body));
        }
        let body = Arc::new(Body::new(shape, &sensor.surfaces)?);
        bodies.push((shape.clone(), Arc::clone(&body)));
        Ok(body)
    }

    /// The table at a place. Its stress features are zero: a fast gel does not know them.
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
        // A port that is farther along x feels what it would feel here of an indenter that is less far.
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
