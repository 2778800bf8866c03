//! The presses of the benchmarks.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Context, Result, ensure};
use glam::DVec3;
use twintac_protocol::{PressPath, Waypoint, Zero};
use twintac_sensor::Sensor;
use twintac_shape::Shape;
use twintac_simulate::{Followed, Gel, SimulateSettings};
use twintac_softbody::LinearSolver;

/// Frame rate of the paper's sensor, Hz.
const RATE_HZ: f64 = 55.0;

/// The indenter: a ball of 25 mm diameter.
const BALL: Shape = Shape::Sphere { radius_mm: 12.5 };

/// A press with its mesh.
pub(crate) struct Case {
    /// Its name in tables.
    pub(crate) name: &'static str,
    /// Poisson's ratio.
    pub(crate) poissons_ratio: f64,
    /// Smallest and largest accepted number of nodes.
    pub(crate) n_nodes: [usize; 2],
    sensor: Arc<Sensor>,
    path: PressPath,
    /// Edges over the gel's height and over the contact's radius, if these determine the mesh.
    edges: Option<f64>,
}

const BLOCK: &str = r#"
name = "block"
summary = "a bonded block"
source = "a case of its own"
inferred = []

[gel.solid]
kind = "block"
size_mm = [30.0, 20.0, 8.0]

[gel.material]
youngs_modulus_kpa = 70.0
poissons_ratio = POISSON
source = "chosen"

[readout]
min_kpa = 0.0
max_kpa = 1500.0
resolution_kpa = 0.01
rate_hz = 55.0

[[taxels]]
name = "middle"
position_mm = [0.0, 0.0, 0.0]
port_radius_mm = 1.0
channel = 0
"#;

/// A ball pressed into a bonded block.
pub(crate) fn block(poissons_ratio: f64) -> Result<Case> {
    let text = BLOCK.replace("POISSON", &poissons_ratio.to_string());
    let sensor = Sensor::parse("block", &text, &no_files)?;
    let poses = [(0.0, [0.0, 0.0, 0.0], 0.0), (1.0, [0.0, 0.0, -2.0], 0.0)];
    Ok(Case {
        name: "block, ball 2 mm deep in 1 s",
        poissons_ratio,
        n_nodes: [4000, 7000],
        sensor: Arc::new(sensor),
        path: path(&poses),
        edges: None,
    })
}

/// A ball pressed 1 mm into a block whose mesh has this many edges over its height.
pub(crate) fn block_of(edges_per_height: f64) -> Result<Case> {
    Ok(Case {
        n_nodes: [0, usize::MAX],
        path: path(&[(0.0, [0.0, 0.0, 0.0], 0.0), (0.5, [0.0, 0.0, -1.0], 0.0)]),
        edges: Some(edges_per_height),
        ..block(0.49)?
    })
}

/// All cases.
pub(crate) fn all() -> Result<Vec<Case>> {
    let mut cases = Vec::new();
    for poissons_ratio in [0.45, 0.49] {
        cases.push(block(poissons_ratio)?);
    }
    let down_and_up = [
        (0.0, [0.0, 0.0, 0.0], 0.0),
        (1.0, [0.0, 0.0, -4.0], 0.0),
        (2.0, [0.0, 0.0, 0.0], 0.0),
    ];
    let slide = [
        (0.0, [-2.0, 1.0, 0.0], 0.0),
        (0.5, [-2.0, 1.0, -2.0], 0.0),
        (1.5, [2.0, 1.0, -2.0], 0.2),
        (2.0, [2.0, 1.0, 0.0], 0.2),
    ];
    for (name, file, poses) in [
        (
            "phystac, ball 4 mm deep at 4 mm/s and back",
            "phystac",
            &down_and_up[..],
        ),
        (
            "phystac-tip, ball 4 mm deep at 4 mm/s and back",
            "phystac-tip",
            &down_and_up[..],
        ),
        ("phystac, slide and tilt 2 mm deep", "phystac", &slide[..]),
    ] {
        let mut sensor = Sensor::read(format!("sensors/{file}.toml"))
            .with_context(|| "run this where the folder `sensors` is")?;
        // K = 2 μ (1 + ν) / (3 (1 - 2 ν))
        let material = &mut sensor.gel.material;
        material.bulk_modulus_kpa = material.shear_modulus_kpa() * 2.0 * 1.49 / (3.0 * 0.02);
        cases.push(Case {
            name,
            poissons_ratio: 0.49,
            n_nodes: [6570, 8030],
            sensor: Arc::new(sensor),
            path: path(poses),
            edges: None,
        });
    }
    Ok(cases)
}

impl Case {
    /// The first part of the way down.
    pub(crate) fn shortened(&self, part: f64) -> Self {
        let mut path = self.path.clone();
        path.poses.truncate(2);
        if let [start, end] = &mut path.poses[..] {
            end.time_s = start.time_s + part * (end.time_s - start.time_s);
            end.position_mm = start.position_mm.lerp(end.position_mm, part);
        }
        Self {
            sensor: self.sensor.clone(),
            path,
            ..*self
        }
    }

    fn gel(&self, tolerance: f64, linear: LinearSolver) -> Gel {
        let mut settings = SimulateSettings {
            max_path_nodes: self.n_nodes[1],
            ..SimulateSettings::fine()
        };
        if let Some(edges) = self.edges {
            settings.edges_per_height = edges;
            settings.edges_per_contact_radius = edges;
        }
        settings.solver.linear = linear;
        settings.solver.tolerance = tolerance;
        settings.solver.max_iterations = 60;
        Gel::new(self.sensor.clone(), settings)
    }

    /// The mesh as JSON: `nodes_mm` and `tets`.
    pub(crate) fn mesh_json(&self) -> Result<String> {
        let gel = self
            .gel(1.0, LinearSolver::TwoLevel)
            .mesh_along(&BALL, &self.path)?;
        let mesh = gel.body().mesh();
        let nodes_mm: Vec<[f64; 3]> = mesh.nodes_mm.iter().map(DVec3::to_array).collect();
        Ok(serde_json::json!({ "nodes_mm": nodes_mm, "tets": mesh.tets }).to_string())
    }

    /// Follows the press with a solver tolerance. `advanced` is called after each frame.
    pub(crate) fn follow(&self, tolerance: f64, advanced: &mut dyn FnMut()) -> Result<Followed> {
        self.follow_by(LinearSolver::TwoLevel, tolerance, advanced)
    }

    /// The same with a limit of the wall time of each frame.
    pub(crate) fn follow_within(&self, deadline: Duration, tolerance: f64) -> Result<Followed> {
        let gel = self
            .gel(tolerance, LinearSolver::TwoLevel)
            .with_deadline(deadline);
        self.follow_on(&gel, &mut || ())
    }

    /// The same with a choice of the linear solver.
    pub(crate) fn follow_by(
        &self,
        linear: LinearSolver,
        tolerance: f64,
        advanced: &mut dyn FnMut(),
    ) -> Result<Followed> {
        self.follow_on(&self.gel(tolerance, linear), advanced)
    }

    fn follow_on(&self, gel: &Gel, advanced: &mut dyn FnMut()) -> Result<Followed> {
        let followed = gel.follow(&BALL, &self.path, &mut || {
            advanced();
            ControlFlow::Continue(())
        })?;
        if let Some(failure) = &followed.failure {
            anyhow::bail!("{}: {failure}", self.name);
        }
        ensure!(
            (self.n_nodes[0]..=self.n_nodes[1]).contains(&followed.n_nodes),
            "{}: the mesh has {} nodes, expected {:?}",
            self.name,
            followed.n_nodes,
            self.n_nodes
        );
        Ok(followed)
    }
}

fn path(poses: &[(f64, [f64; 3], f64)]) -> PressPath {
    PressPath {
        summary: String::new(),
        indenter: "ball of 25 mm".into(),
        zero: Zero::Touch,
        rate_hz: Some(RATE_HZ),
        poses: poses
            .iter()
            .map(|&(time_s, position_mm, tilt_rad)| Waypoint {
                time_s,
                position_mm: DVec3::from_array(position_mm),
                turn_rad: DVec3::Y * tilt_rad,
                force_n: None,
            })
            .collect(),
        force_direction: DVec3::NEG_Z,
        force_travel_mm: None,
        points: Vec::new(),
    }
}

fn no_files(path: &str) -> std::io::Result<Vec<u8>> {
    Err(std::io::Error::other(format!("{path} is not read here")))
}
