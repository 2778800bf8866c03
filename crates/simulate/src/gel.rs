//! A sensor's gel as a soft body, ready to be pressed.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use rayon::prelude::*;
use twintac_mesh::{Cuboid, Focus, MeshSettings, TetMesh};
use twintac_sensor::Sensor;
use twintac_shape::{Cavity, Pose, SignedDistance};
use twintac_softbody::{Frame, SoftBody, State};

use crate::readout::{PortReadout, StressCluster};
use crate::touch::{contact_radius_mm, first_touch};
use crate::{Honesty, SimulateError, SimulateSettings, Sweep, SweepFrame};

/// A gel and how finely it is to be simulated. Shared by many presses.
#[derive(Clone, Debug)]
pub struct Gel {
    sensor: Arc<Sensor>,
    settings: SimulateSettings,
    material: twintac_softbody::Material,
}

/// Where, with what and how deep to press.
#[derive(Clone, Debug, PartialEq)]
pub struct PressPlace {
    /// The indenter's name, for the record.
    pub indenter: String,
    /// The indenter's shape.
    pub shape: twintac_shape::Shape,
    /// Place of the indenter's origin in the gel's plane, mm.
    pub x_mm: f64,
    /// Place of the indenter's origin in the gel's plane, mm.
    pub y_mm: f64,
    /// Tilt and spin of the indenter.
    pub rotation: DQuat,
    /// Depth below first touch to simulate, mm.
    pub depth_mm: f64,
}

/// A moment of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keyframe {
    /// Time, s.
    pub time_s: f64,
    /// Depth below first touch, mm; negative above the gel.
    pub depth_mm: f64,
}

/// One press's mesh and model, with where the indenter touches first.
pub struct GelMesh {
    body: SoftBody,
    indenter: Box<dyn SignedDistance>,
    touch: Pose,
    ports: Vec<PortReadout>,
    clusters: Vec<StressCluster>,
}

impl Gel {
    /// Prepares a sensor's gel with the material of its description.
    #[must_use]
    pub fn new(sensor: Arc<Sensor>, settings: SimulateSettings) -> Self {
        let material = soft_material(&sensor.gel.material);
        Self { sensor, settings, material }
    }

    /// The same gel of another material.
    #[must_use]
    pub fn with_material(mut self, material: twintac_softbody::Material) -> Self {
        self.material = material;
        self
    }

    /// The material that is simulated.
    #[must_use]
    pub fn material(&self) -> &twintac_softbody::Material {
        &self.material
    }

    /// The sensor whose gel this is.
    #[must_use]
    pub fn sensor(&self) -> &Sensor {
        &self.sensor
    }

    /// Meshes the gel for a press: fine under the indenter, coarser elsewhere.
    pub fn mesh(&self, place: &PressPlace) -> Result<GelMesh, SimulateError> {
        let sensor = &*self.sensor;
        let solid = &sensor.gel.solid;
        let indenter = place.shape.signed_distance_field(&sensor.surfaces)?;
        let above = Pose { position_mm: DVec3::new(place.x_mm, place.y_mm, 0.0), rotation: place.rotation };
        let top_height_mm = |x_mm: f64, y_mm: f64| solid.top_height_mm(x_mm, y_mm, &sensor.surfaces);
        let (touch, touched) = first_touch(indenter.as_ref(), &above, &top_height_mm)
            .ok_or(SimulateError::NoTouch { x_mm: place.x_mm, y_mm: place.y_mm })?;
        let radius_mm = contact_radius_mm(indenter.as_ref(), &touch, touched, place.depth_mm);
        let edge_mm = (radius_mm / self.settings.edges_per_contact_radius)
            .clamp(self.settings.smallest_edge_mm.min(self.settings.edge_mm), self.settings.edge_mm);
        let settings = MeshSettings {
            edge_mm: self.settings.edge_mm,
            focuses: vec![Focus { center_mm: touched, radius_mm, edge_mm }],
            ..MeshSettings::default()
        };
        let inclusions: Vec<Cuboid> =
            sensor.inclusions.iter().map(|i| Cuboid { min_mm: i.min_mm, max_mm: i.max_mm }).collect();
        let mesh = twintac_mesh::generate(solid, &sensor.surfaces, &inclusions, &settings)?;
        GelMesh::new(sensor, mesh, self.material.clone(), &self.settings, indenter, touch)
    }

    /// Presses a place to increasing depths. A table that ends early says why in [`Sweep::failure`].
    pub fn sweep(&self, place: &PressPlace) -> Result<Sweep, SimulateError> {
        let n_frames = self.settings.sweep_frames.max(1);
        let keyframes: Vec<Keyframe> = (0..=n_frames)
            .map(|i| {
                // Closer together near the surface, where the contact grows fastest.
                let fraction = (f64::from(i) / f64::from(n_frames)).powf(1.25);
                Keyframe { time_s: 0.0, depth_mm: fraction * place.depth_mm }
            })
            .collect();
        self.press(place, &keyframes)
    }

    /// Follows a trajectory in time; the material remembers what it is made to remember.
    pub fn press(&self, place: &PressPlace, keyframes: &[Keyframe]) -> Result<Sweep, SimulateError> {
        self.mesh(place)?.press(place, keyframes)
    }
}

impl GelMesh {
    fn new(
        sensor: &Sensor,
        mesh: TetMesh,
        material: twintac_softbody::Material,
        settings: &SimulateSettings,
        indenter: Box<dyn SignedDistance>,
        touch: Pose,
    ) -> Result<Self, SimulateError> {
        let ports =
            sensor.taxels.iter().map(|taxel| PortReadout::new(&mesh, taxel)).collect::<Result<Vec<_>, _>>()?;
        let clusters = StressCluster::for_each_taxel(&mesh, sensor);
        let mut body = SoftBody::new(mesh, material, settings.solver.clone())?;
        if let Some(shell) = &sensor.shell {
            let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
            let cavity = Cavity::around(low.truncate(), high.truncate(), shell.gap_mm, shell.height_mm);
            body = body.with_obstacle(Arc::new(cavity), Pose::IDENTITY);
        }
        Ok(Self { body, indenter, touch, ports, clusters })
    }

    /// The soft body of this press.
    #[must_use]
    pub fn body(&self) -> &SoftBody {
        &self.body
    }

    /// Presses along the keyframes. Gaps above the gel are not simulated unless the gel remembers.
    pub fn press(&self, place: &PressPlace, keyframes: &[Keyframe]) -> Result<Sweep, SimulateError> {
        let mut state = self.body.rest();
        let mut frames: Vec<SweepFrame> = Vec::with_capacity(keyframes.len());
        let mut failure = None;
        let mut previous_s = keyframes.first().map_or(0.0, |k| k.time_s);
        for keyframe in keyframes {
            let pose = Pose { position_mm: self.touch.position_mm - DVec3::Z * keyframe.depth_mm, ..self.touch };
            let time_step_s = keyframe.time_s - previous_s;
            previous_s = keyframe.time_s;
            match self.body.advance(&mut state, self.indenter.as_ref(), &pose, time_step_s) {
                Ok(frame) => frames.push(self.read(&state, &frame, keyframe)),
                Err(error) => {
                    failure = Some(format!("at {:.3} mm: {error}", keyframe.depth_mm));
                    break;
                }
            }
        }
        Ok(Sweep {
            indenter: place.indenter.clone(),
            gel_from_indenter_at_touch: self.touch,
            n_nodes: self.body.mesh().nodes_mm.len(),
            frames,
            failure,
        })
    }

    fn read(&self, state: &State, frame: &Frame, keyframe: &Keyframe) -> SweepFrame {
        let pressure_kpa = self.body.pressure_kpa(state);
        let von_mises_kpa = self.body.von_mises_kpa(state);
        let rest = &self.body.mesh().nodes_mm;
        let positions = |node: usize| rest[node] + state.displacement_mm(node);
        SweepFrame {
            time_s: keyframe.time_s,
            depth_mm: keyframe.depth_mm,
            force_n: -frame.indenter_force_n.z,
            port_pressure_kpa: self.ports.iter().map(|port| port.read(&pressure_kpa)).collect(),
            stress_feature_kpa_per_mm: self.clusters.iter().map(|c| c.read(&von_mises_kpa, &positions)).collect(),
            honesty: Honesty {
                converged: frame.converged,
                iterations: frame.iterations,
                residual: frame.residual,
                penetration_mm: frame.penetration_mm,
                smallest_volume_ratio: frame.smallest_volume_ratio,
                wall_time_s: frame.wall_time_s,
            },
        }
    }
}

/// Sweeps many places over all cores, in the order of the places. `done` is called as each finishes, from any thread.
pub fn sweeps(
    gel: &Gel,
    places: &[PressPlace],
    done: &(dyn Fn(usize, &Sweep) + Sync),
) -> Result<Vec<Sweep>, SimulateError> {
    places
        .par_iter()
        .enumerate()
        .with_max_len(1)
        .map(|(index, place)| {
            let sweep = gel.sweep(place)?;
            done(index, &sweep);
            Ok(sweep)
        })
        .collect()
}

fn soft_material(material: &twintac_sensor::Material) -> twintac_softbody::Material {
    let _ = material;
    todo!()
}
