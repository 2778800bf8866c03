//! The scenes: bodies that slide and tilt at every step.

use std::error::Error;

use digitac::Twin;
use glam::{DQuat, DVec3};
use twintac_fast::{Body, FastGel, Touch};
use twintac_sensors::{SensorBatch, SensorVariation};
use twintac_shape::{Pose, Shape, SurfaceFile, Surfaces};

/// Taxels of a sensor.
pub(crate) const N_TAXELS: usize = 8;

/// Bytes of the pose that a step takes, and of the readings and the wrench that it gives.
pub(crate) const N_BYTES_MOVED: usize =
    size_of::<Touch>() + N_TAXELS * size_of::<f32>() + size_of::<[f32; 6]>();

/// Time between steps, s.
const STEP_S: f64 = 0.01;

/// Height of the gel, mm.
const HEIGHT_MM: f64 = 8.5;

/// All deviations that a sensor may have.
const IMPERFECTION: &str = "
[variation]
gain_deviation = 0.05
offset_deviation_kpa = 0.2
drift_deviation_kpa_per_k = 0.05
temperature_deviation_k = 2.0
temperature_time_s = 60.0
noise_deviation_kpa = 0.05
quantum_kpa = 0.01
hysteresis = 0.03
dead_chance = 0.01
stuck_chance = 0.01
late_chance = 0.01
rate_hz = 100.0
jitter = 0.1
height_deviation_mm = 0.05
place_deviation_mm = 0.3
turn_deviation_rad = 0.01
tilt_deviation_rad = 0.01
";

/// The body that presses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    Ball,
    Box,
    RandomMesh,
}

impl Kind {
    pub(crate) const ALL: [Self; 3] = [Self::Ball, Self::Box, Self::RandomMesh];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Ball => "ball, 12 mm",
            Self::Box => "box, 12 × 8 × 10 mm",
            Self::RandomMesh => "closed surface, 20,000 triangles",
        }
    }

    fn body(self) -> Result<Body, Box<dyn Error>> {
        let shape = match self {
            Self::Ball => Shape::Sphere { radius_mm: 6.0 },
            Self::Box => Shape::Box {
                size_mm: [12.0, 8.0, 10.0],
                edge_radius_mm: 0.5,
            },
            Self::RandomMesh => {
                let surfaces = twintac_fem_presses::test_surfaces()?;
                let (path, _) = surfaces.iter().next().ok_or("no random mesh")?;
                let shape = Shape::Stl(SurfaceFile::new(path));
                return Ok(Body::new(&shape, &surfaces)?);
            }
        };
        Ok(Body::new(&shape, &Surfaces::new())?)
    }
}

/// Sensors, and the bodies that touch them.
pub(crate) struct Scene {
    sensors: SensorBatch,
    bodies: [Body; 1],
    touches: Vec<Touch>,
    ends: Vec<usize>,
    readings_kpa: Vec<f32>,
    wrench: Vec<[f32; 6]>,
    n_steps: usize,
}

impl Scene {
    /// Sensors for this number of threads; with a twin's relaxation and all deviations, or with
    /// neither.
    pub(crate) fn new(
        kind: Kind,
        twin: Option<&Twin>,
        [n_sensors, n_threads]: [usize; 2],
    ) -> Result<Self, Box<dyn Error>> {
        let variation = match twin {
            Some(_) => SensorVariation::parse("rate", IMPERFECTION)?,
            None => SensorVariation::default(),
        };
        let gel = FastGel::phystac()?;
        Ok(Self {
            sensors: SensorBatch::new(&gel, twin, variation, [n_sensors, n_threads], 1),
            bodies: [kind.body()?],
            touches: vec![
                Touch {
                    body: 0,
                    gel_from_body: Pose::IDENTITY,
                };
                n_sensors
            ],
            ends: (1..=n_sensors).collect(),
            readings_kpa: vec![0.0; n_sensors * N_TAXELS],
            wrench: vec![[0.0; 6]; n_sensors],
            n_steps: 0,
        })
    }

    /// Moves every body: 16 mm to and fro along x, 8 mm along y, 0.5 to 2.5 mm deep, tilted by up
    /// to 0.2 radians about two axes.
    pub(crate) fn move_on(&mut self) {
        for (sensor, touch) in self.touches.iter_mut().enumerate() {
            let phase = 0.02 * self.n_steps as f64 + 0.1 * sensor as f64;
            let depth_mm = 1.5 - (0.7 * phase).cos();
            touch.gel_from_body = Pose {
                position_mm: DVec3::new(8.0 * phase.sin(), 4.0 * (1.3 * phase).sin(), HEIGHT_MM - depth_mm),
                rotation: DQuat::from_rotation_x(0.2 * (1.1 * phase).sin())
                    * DQuat::from_rotation_y(0.2 * (0.9 * phase).sin()),
            };
        }
        self.n_steps += 1;
    }

    /// Steps every sensor once.
    #[inline(never)] // profilers look for this function
    pub(crate) fn step(&mut self) {
        self.sensors.step(
            STEP_S,
            &self.bodies,
            &self.touches,
            &self.ends,
            &mut self.readings_kpa,
            &mut self.wrench,
        );
    }

    /// Fraction of the sensors that feel a force.
    pub(crate) fn touched(&self) -> f64 {
        let felt = self.wrench.iter().filter(|wrench| wrench[2].abs() > 0.01);
        felt.count() as f64 / self.wrench.len() as f64
    }

    /// Sum of all readings and forces, to compare two versions of the code.
    pub(crate) fn sum(&self) -> f64 {
        let forces = self.wrench.as_flattened().iter();
        self.readings_kpa
            .iter()
            .chain(forces)
            .map(|value| f64::from(*value))
            .sum()
    }
}
