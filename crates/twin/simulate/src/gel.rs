//! A sensor's gel as a soft body, ready to be pressed.

use std::cell::Cell;
use std::sync::Arc;
use std::time::Duration;

use glam::{DQuat, DVec2, DVec3};
use serde::{Serialize, Serializer};
use twintac_depth_table::{DepthTable, PressFrame};
use twintac_mesh::{Cuboid, Focus, MeshError, MeshSettings, TetMesh};
use twintac_sensor::Sensor;
use twintac_shape::{Pose, Shape, SignedDistance};
use twintac_softbody::{Element, Frame, Material, SoftBody, SolveError, SolverSettings, State};

use crate::error::reason;
use crate::history::solve_quality;
use crate::readout::{PortReadout, PortSlopes, StressCluster};
use crate::rounding::{Rims, Roundings};
use crate::shell::Wall;
use crate::touch::{contact_radius_mm, first_touch};
use crate::{PressHistory, SimulateError, SimulateSettings};

/// Fraction of the depth at which the indenter is about as wide as its contact. One half is exact
/// for a sphere in Hertz's theory.
const CONTACT_DEPTH: f64 = 0.5;

/// Smallest factor by which edges grow when a mesh has too many nodes.
const MIN_COARSENING: f64 = 1.01;

/// Largest ratio of edge lengths away from the indenter to those under it. Beyond it, cells below a
/// pin would be slivers: as narrow as the short edges and as high as the long ones.
const LARGEST_EDGE_RATIO: f64 = 20.0;

/// Edges grow by the excess of nodes to this power. It is less than a third, because the number of
/// nodes falls in steps.
const COARSENING_POWER: f64 = 0.2;

/// Nodes of a coarse mesh that is only used to estimate how deep a force presses.
const COARSE_NODES: usize = 1500;

/// How finely a kind of press is meshed.
struct Fineness {
    /// Length of edges as a fraction of the length asked for, if the number of nodes allows it.
    scale: f64,
    /// Shortest edge at a rim as a fraction of the edge under the rest of the indenter.
    sharpest: f64,
    /// Edge length along z at the gel's surface, as a fraction of that away from the indenter, in
    /// meshes with fine rims: below a rim, the gel bends within a fraction of its height.
    top: f64,
    /// Number of nodes that a mesh with fine rims may have before they are refined, and with them,
    /// as fractions of the number allowed without rims.
    even_share: f64,
    rim_share: f64,
    /// Smallest factor by which all edges get shorter where nodes are left over after rims are
    /// refined.
    finest: f64,
    /// Whether there is a line of the mesh where a rim begins. It brings tables of PhysTac's cube
    /// no closer to those of fine meshes.
    rim_lines: bool,
    /// The element of meshes with fine rims, if the settings have the default one. With as many
    /// nodes, blended takes two to three times as long on the fine meshes of tables.
    rim_element: Element,
}

const TABLE: Fineness = Fineness {
    scale: 1.0,
    sharpest: 0.5,
    top: 1.0,
    even_share: 1.0,
    rim_share: 1.0,
    finest: 1.0,
    rim_lines: false,
    rim_element: Element::Layered,
};

/// Chosen so that five shapes with rims, pressed to 2 mm on 7,000 nodes, are near the solution on
/// 40,000 nodes in force and pressure (`cargo xtask verify rims`); errors of other presses are
/// larger.
const PATH: Fineness = Fineness {
    scale: 0.7,
    sharpest: 0.45,
    top: 0.6,
    even_share: 0.7,
    rim_share: 1.6,
    finest: 0.8,
    rim_lines: true,
    rim_element: Element::Blended,
};

/// A gel and the settings of its simulation. Many presses share it.
#[derive(Clone, Debug)]
pub struct Gel {
    sensor: Arc<Sensor>,
    settings: SimulateSettings,
    material: Material,
    /// Whether paths also give the stress feature.
    pub(crate) stress_along_paths: bool,
    /// Wall time that a frame of a path may take.
    pub(crate) deadline: Option<Duration>,
    upwards: DVec3,
}

/// The serialized gel has everything that its results depend on.
impl Serialize for Gel {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self {
            sensor,
            settings,
            material,
            stress_along_paths,
            deadline,
            upwards,
        } = self;
        (
            &**sensor,
            settings,
            material,
            stress_along_paths,
            deadline,
            upwards,
        )
            .serialize(serializer)
    }
}

/// Location, indenter and depth of a press.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PressPlace {
    /// The indenter's name, for the record.
    pub indenter: String,
    /// The indenter's shape.
    pub shape: Shape,
    /// x of the indenter's origin in the gel's plane, mm.
    pub x_mm: f64,
    /// y of the indenter's origin in the gel's plane, mm.
    pub y_mm: f64,
    /// Tilt and yaw of the indenter.
    pub rotation: DQuat,
    /// Depth below first touch to simulate, mm.
    pub depth_mm: f64,
    /// Force that is enough, N: the press ends with the frame that reaches it.
    pub enough_force_n: Option<f64>,
}

/// A moment of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keyframe {
    /// Time, s.
    pub time_s: f64,
    /// Depth below first touch, mm; negative above the gel.
    pub depth_mm: f64,
}

/// The mesh and the model of one press, with the pose of first touch.
pub struct GelMesh {
    pub(crate) body: SoftBody,
    pub(crate) indenter: Box<dyn SignedDistance>,
    pub(crate) touch: Pose,
    upwards: DVec3,
    pub(crate) ports: Vec<PortReadout>,
    slopes: Vec<PortSlopes>,
    clusters: Vec<StressCluster>,
}

impl Gel {
    /// Prepares a sensor's gel with the material of its description.
    #[must_use]
    pub fn new(sensor: Arc<Sensor>, settings: SimulateSettings) -> Self {
        let material = soft_material(&sensor.gel.material);
        Self {
            sensor,
            settings,
            material,
            stress_along_paths: false,
            deadline: None,
            upwards: DVec3::Z,
        }
    }

    /// The same gel, which also gives the stress feature above each taxel along paths. Paths take
    /// about a third longer.
    #[must_use]
    pub fn with_stress_along_paths(mut self) -> Self {
        self.stress_along_paths = true;
        self
    }

    /// The same gel with a wall time for each frame along paths and of a [`crate::GelState`]. A
    /// frame is answered within it, converged or not: see [`crate::FollowedFrame::converged`].
    /// Frames with a prescribed force take the time that they need. Such results are not
    /// reproducible.
    #[must_use]
    pub fn with_deadline(mut self, deadline: Duration) -> Self {
        self.deadline = Some(deadline);
        self
    }

    /// The same gel under a robot whose upward direction is this unit vector in the gel's frame; it
    /// is not z for a sensor that does not lie level. Depths count along it. Paths have directions
    /// of their own.
    #[must_use]
    pub fn with_upwards(mut self, upwards: DVec3) -> Self {
        self.upwards = upwards;
        self
    }

    /// The same gel with another material.
    #[must_use]
    pub fn with_material(mut self, material: Material) -> Self {
        self.material = material;
        self
    }

    /// The same gel with a sensor that differs only in its indenters.
    #[must_use]
    pub fn with_sensor(mut self, sensor: Arc<Sensor>) -> Self {
        self.sensor = sensor;
        self
    }

    /// The material that is simulated.
    #[must_use]
    pub fn material(&self) -> &Material {
        &self.material
    }

    /// The sensor whose gel this is.
    #[must_use]
    pub fn sensor(&self) -> &Sensor {
        &self.sensor
    }

    /// Height of the gel, mm.
    #[must_use]
    pub fn height_mm(&self) -> f64 {
        self.sensor.gel.solid.bounds_mm(&self.sensor.surfaces).1.z
    }

    /// Lowers an indenter, at a pose whose z is ignored, until it touches the undeformed gel.
    pub fn touch(&self, shape: &Shape, above: &Pose) -> Result<Pose, SimulateError> {
        let indenter = shape.signed_distance_field(&self.sensor.surfaces)?;
        Ok(self.first_touch(indenter.as_ref(), above)?.0)
    }

    fn first_touch(
        &self,
        indenter: &dyn SignedDistance,
        above: &Pose,
    ) -> Result<(Pose, DVec3), SimulateError> {
        let (solid, surfaces) = (&self.sensor.gel.solid, &self.sensor.surfaces);
        let top_height_mm = |x_mm: f64, y_mm: f64| solid.top_height_mm(x_mm, y_mm, surfaces);
        first_touch(indenter, above, &top_height_mm).ok_or(SimulateError::NoTouch {
            x_mm: above.position_mm.x,
            y_mm: above.position_mm.y,
        })
    }

    /// Meshes the gel for a press: fine under the indenter, coarser elsewhere.
    pub fn mesh(&self, place: &PressPlace) -> Result<GelMesh, SimulateError> {
        let above = Pose {
            position_mm: DVec3::new(place.x_mm, place.y_mm, 0.0),
            rotation: place.rotation,
        };
        self.rough_for(&place.indenter)
            .mesh_for(&place.shape, &above, place.depth_mm, None)
    }

    /// Coulomb's coefficient of friction between an indenter and the gel: from the description, or
    /// else from the settings.
    #[must_use]
    pub fn friction(&self, indenter: &str) -> f64 {
        let known = self.sensor.indenter(indenter);
        known
            .and_then(|known| known.friction)
            .unwrap_or(self.settings.solver.friction)
    }

    /// The same gel with this coefficient of friction for every indenter that has none in the
    /// description.
    #[must_use]
    pub fn with_friction(mut self, friction: f64) -> Self {
        self.settings.solver.friction = friction;
        self
    }

    /// The same gel with the coefficient of friction of an indenter.
    pub(crate) fn rough_for(&self, indenter: &str) -> Self {
        let friction = self.friction(indenter);
        self.clone().with_friction(friction)
    }

    /// The same gel with a coarse mesh, to estimate the depth to which a force presses.
    pub(crate) fn coarse(&self) -> Self {
        let mut gel = self.clone();
        gel.settings.edges_per_height = gel.settings.edges_per_height.min(4.0);
        gel.settings.edges_per_contact_radius = gel.settings.edges_per_contact_radius.min(4.0);
        gel.settings.max_path_nodes = gel.settings.max_path_nodes.min(COARSE_NODES);
        gel
    }

    /// Meshes the gel for an indenter that first touches below a pose and presses to this depth.
    /// For a path, `ways_mm` are the displacements from there.
    pub(crate) fn mesh_for(
        &self,
        shape: &Shape,
        above: &Pose,
        depth_mm: f64,
        ways_mm: Option<&[DVec2]>,
    ) -> Result<GelMesh, SimulateError> {
        let sensor = &*self.sensor;
        let solid = &sensor.gel.solid;
        let indenter = shape.signed_distance_field(&sensor.surfaces)?;
        let (touch, touched) = self.first_touch(indenter.as_ref(), above)?;
        let radius_mm = contact_radius_mm(indenter.as_ref(), &touch, touched, CONTACT_DEPTH * depth_mm);
        let coarse_mm = self.height_mm() / self.settings.edges_per_height;
        let contact_edge_mm = self.settings.contact_edge_mm;
        let fine_mm = contact_edge_mm.unwrap_or(radius_mm / self.settings.edges_per_contact_radius);
        let fine_mm = fine_mm.clamp(coarse_mm / LARGEST_EDGE_RATIO, coarse_mm);
        let inclusions: Vec<Cuboid> = sensor
            .inclusions
            .iter()
            .map(|i| Cuboid {
                min_mm: i.min_mm,
                max_mm: i.max_mm,
            })
            .collect();
        let roundings = Roundings::of(indenter.as_ref(), &touch, touched, radius_mm, depth_mm);
        let generate = |scale: f64, rims: &Rims, top_edge_ratio: f64| {
            // There is at least one edge over the gel's height, however few nodes are allowed.
            let [coarse_mm, fine_mm] =
                [coarse_mm, fine_mm].map(|edge_mm| self.height_mm().min(scale * edge_mm));
            let settings = MeshSettings {
                edge_mm: coarse_mm,
                focuses: std::iter::once(&DVec2::ZERO)
                    .chain(ways_mm.unwrap_or_default())
                    .map(|way_mm| Focus {
                        center_mm: touched + way_mm.extend(0.0),
                        radius_mm,
                        edge_mm: fine_mm,
                        stretches: rims.stretches.clone(),
                        lines_mm: rims.lines_mm.clone(),
                    })
                    .collect(),
                top_edge_ratio,
                ..MeshSettings::default()
            };
            // Each of these tetrahedra will be cut into eight, with edges half as long.
            twintac_mesh::generate_unchecked(solid, &sensor.surfaces, &inclusions, &settings.scaled(2.0))
        };
        let even = |scale: f64| generate(scale, &Rims::default(), 1.0);
        let (fineness, most) = match ways_mm {
            None => (&TABLE, self.settings.max_nodes),
            Some(_) => (&PATH, self.settings.max_path_nodes),
        };
        let coarsest = self.height_mm() / fine_mm;
        let mut solver = self.settings.solver.clone();
        let (scale, mut mesh) = coarsen(even, [fineness.scale, coarsest], most)?;
        let rims = |scale: f64, rim_scale: f64| {
            let edge_mm = scale * fine_mm;
            let per_radius = self.settings.edges_per_rounding / rim_scale;
            let mut rims = roundings.rims(per_radius, [rim_scale * fineness.sharpest * edge_mm, edge_mm]);
            if !fineness.rim_lines {
                rims.lines_mm = Default::default();
            }
            rims
        };
        if rims(scale, 1.0).stretches.iter().any(|axis| !axis.is_empty()) {
            let most_even = (fineness.even_share * most as f64) as usize;
            let (scale, _) = coarsen(even, [scale, coarsest], most_even)?;
            let most = (fineness.rim_share * most as f64) as usize;
            // Below 1, all edges get shorter; beyond, only those at rims get longer.
            let rimmed = |fewer: f64| {
                let (scale, rim_scale) = (scale * fewer.min(1.0), fewer.max(1.0));
                generate(scale, &rims(scale, rim_scale), fineness.top)
            };
            let with_rims = closely(rimmed, [fineness.finest, 1.0 / fineness.sharpest], most)?;
            if with_rims.n_nodes_refined() <= most {
                mesh = with_rims;
                if solver.element == Element::default() {
                    solver.element = fineness.rim_element;
                }
            }
        }
        mesh.check_volumes()?;
        GelMesh::new(
            sensor,
            &mesh,
            self.material.clone(),
            solver,
            indenter,
            (touch, self.upwards),
        )
    }

    /// Presses a location to increasing depths. A table that ends early gives the reason in
    /// [`DepthTable::failure`].
    pub fn depth_table(&self, place: &PressPlace) -> Result<DepthTable, SimulateError> {
        Ok(self
            .mesh(place)?
            .depth_table(place, &self.depths(place), &mut |_| ()))
    }

    /// The depths of a table. They are closer together near the surface, where the contact grows
    /// fastest.
    #[must_use]
    pub fn depths(&self, place: &PressPlace) -> Vec<Keyframe> {
        let n_frames = (place.depth_mm / self.settings.depth_step_mm)
            .ceil()
            .max(SimulateSettings::MIN_DEPTH_STEPS) as u32;
        let fraction = |i: u32| (f64::from(i) / f64::from(n_frames)).powf(1.25);
        (0..=n_frames)
            .map(|i| Keyframe {
                time_s: 0.0,
                depth_mm: fraction(i) * place.depth_mm,
            })
            .collect()
    }

    /// Follows a trajectory in time. The material relaxes according to its history variables.
    pub fn press(&self, place: &PressPlace, keyframes: &[Keyframe]) -> Result<PressHistory, SimulateError> {
        Ok(self.mesh(place)?.press(place, keyframes, &mut |_| ()))
    }
}

/// Number of times that [`closely`] halves the last step of the scale.
const HALVINGS: u32 = 4;

/// Like [`coarsen`], but closer to the number of nodes that is allowed: lines along several axes
/// can vanish at almost the same scale, so that one step of it may halve the number of nodes.
fn closely(
    generate: impl Fn(f64) -> Result<TetMesh, MeshError>,
    scales: [f64; 2],
    max_nodes: usize,
) -> Result<TetMesh, MeshError> {
    let (tried, too_fine) = (Cell::new(None), Cell::new(None));
    let followed = |scale: f64| {
        too_fine.set(tried.replace(Some(scale)));
        generate(scale)
    };
    let (mut scale, mut mesh) = coarsen(followed, scales, max_nodes)?;
    let Some(mut too_fine) = too_fine.get() else {
        return Ok(mesh);
    };
    for _ in 0..HALVINGS {
        let middle = 0.5 * (too_fine + scale);
        let finer = generate(middle)?;
        if finer.n_nodes_refined() <= max_nodes {
            (scale, mesh) = (middle, finer);
        } else {
            too_fine = middle;
        }
    }
    Ok(mesh)
}

/// Generates ever coarser meshes. Returns the first (finest) one with few enough nodes, or else the
/// coarsest, with its scale.
fn coarsen(
    generate: impl Fn(f64) -> Result<TetMesh, MeshError>,
    [mut scale, largest]: [f64; 2],
    max_nodes: usize,
) -> Result<(f64, TetMesh), MeshError> {
    let mut mesh = generate(scale)?;
    while mesh.n_nodes_refined() > max_nodes {
        let excess = mesh.n_nodes_refined() as f64 / max_nodes as f64;
        let coarser = scale * excess.powf(COARSENING_POWER).max(MIN_COARSENING);
        if coarser > largest {
            break;
        }
        scale = coarser;
        mesh = generate(scale)?;
    }
    Ok((scale, mesh))
}

impl GelMesh {
    fn new(
        sensor: &Sensor,
        mesh: &TetMesh,
        material: Material,
        solver: SolverSettings,
        indenter: Box<dyn SignedDistance>,
        (touch, upwards): (Pose, DVec3),
    ) -> Result<Self, SimulateError> {
        let mut body = SoftBody::new(mesh, material, solver)?;
        let mesh = body.mesh();
        let ports = sensor
            .taxels
            .iter()
            .map(|taxel| PortReadout::of_taxel(mesh, taxel))
            .collect::<Result<Vec<_>, _>>()?;
        let slopes = sensor
            .taxels
            .iter()
            .map(|taxel| PortSlopes::of_taxel(mesh, taxel))
            .collect();
        let clusters = StressCluster::for_each_taxel(mesh, sensor);
        if let Some(shell) = &sensor.shell {
            let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
            for wall in Wall::around(low.truncate(), high.truncate(), shell.gap_mm, shell.height_mm) {
                body = body.with_obstacle(Arc::new(wall), Pose::IDENTITY);
            }
        }
        Ok(Self {
            body,
            indenter,
            touch,
            upwards,
            ports,
            slopes,
            clusters,
        })
    }

    /// Solves on two threads.
    #[must_use]
    pub(crate) fn on_two_threads(mut self) -> Self {
        self.body = self.body.on_two_threads();
        self
    }

    /// The soft body of this press.
    #[must_use]
    pub fn body(&self) -> &SoftBody {
        &self.body
    }

    /// Presses to the depths of a table, such as [`Gel::depths`], and calls `show` with the gel at
    /// each.
    #[must_use]
    pub fn depth_table(
        &self,
        place: &PressPlace,
        depths: &[Keyframe],
        show: &mut dyn FnMut(&Fields<'_>),
    ) -> DepthTable {
        let mut history = self.press(place, depths, show);
        if let ([untouched, _, deeper @ ..], true) = (depths, history.frames.len() < 2)
            && !deeper.is_empty()
        {
            // With friction, a first step in which only an edge touches may have no equilibrium.
            // The table then starts one step deeper.
            let depths = [&[*untouched], deeper].concat();
            history = self.press(place, &depths, show);
        }
        history.end_where_force_falls();
        DepthTable {
            indenter: place.indenter.clone(),
            gel_from_indenter_at_touch: history.gel_from_indenter_at_touch,
            n_nodes: self.body.mesh().nodes_mm.len(),
            frames: history.frames,
            failure: history.failure,
        }
    }

    /// Presses along the keyframes and calls `show` with the gel at each.
    fn press(
        &self,
        place: &PressPlace,
        keyframes: &[Keyframe],
        show: &mut dyn FnMut(&Fields<'_>),
    ) -> PressHistory {
        let mut state = self.body.rest();
        let mut frames: Vec<PressFrame> = Vec::with_capacity(keyframes.len());
        let mut failure = None;
        let mut advance = |state: &mut State, keyframe: &Keyframe, time_step_s: f64| {
            let pose = Pose {
                position_mm: self.touch.position_mm - self.upwards * keyframe.depth_mm,
                ..self.touch
            };
            let frame = self
                .body
                .advance(state, self.indenter.as_ref(), &pose, time_step_s)?;
            let fields = self.fields(state);
            show(&fields);
            frames.push(self.read(&fields, &frame, keyframe));
            Ok::<f64, SolveError>(self.force_n(&frame))
        };
        let mut previous = keyframes.first().copied();
        for keyframe in keyframes {
            let before = previous.replace(*keyframe).unwrap_or(*keyframe);
            let time_step_s = keyframe.time_s - before.time_s;
            match advance(&mut state, keyframe, time_step_s) {
                Ok(force_n) if place.enough_force_n.is_some_and(|enough_n| force_n >= enough_n) => break,
                Ok(_) => {}
                Err(error) => {
                    failure = Some(format!("at {:.3} mm: {}", keyframe.depth_mm, reason(&error)));
                    let share = error.converged_fraction();
                    if share > 0.0 {
                        // Takes the last step as far as it converges.
                        let last = Keyframe {
                            time_s: before.time_s + share * time_step_s,
                            depth_mm: before.depth_mm + share * (keyframe.depth_mm - before.depth_mm),
                        };
                        let _ = advance(&mut state, &last, share * time_step_s);
                    }
                    break;
                }
            }
        }
        PressHistory {
            gel_from_indenter_at_touch: self.touch,
            frames,
            failure,
        }
    }

    /// Force of the indenter on the gel along the robot's downward direction, N.
    fn force_n(&self, frame: &Frame) -> f64 {
        -frame.indenter_force_n.dot(self.upwards)
    }

    /// The fields of the gel in a state.
    pub(crate) fn fields<'a>(&'a self, state: &'a State) -> Fields<'a> {
        Fields {
            mesh: self.body.mesh(),
            displacements_mm: state.displacements_mm(),
            pressure_kpa: self.body.pressure_kpa(state),
            von_mises_kpa: self.body.von_mises_kpa(state),
        }
    }

    pub(crate) fn port_slopes_kpa_per_mm(&self, pressure_kpa: &[f64]) -> Vec<[f64; 3]> {
        let slopes = self.slopes.iter();
        slopes.map(|slopes| slopes.read(pressure_kpa)).collect()
    }

    pub(crate) fn stress_features_kpa_per_mm(&self, fields: &Fields<'_>) -> Vec<f64> {
        let positions = |node: usize| fields.mesh.nodes_mm[node] + fields.displacements_mm[node];
        let clusters = self.clusters.iter();
        clusters
            .map(|cluster| cluster.read(&fields.von_mises_kpa, &positions))
            .collect()
    }

    fn read(&self, fields: &Fields<'_>, frame: &Frame, keyframe: &Keyframe) -> PressFrame {
        PressFrame {
            depth_mm: keyframe.depth_mm,
            force_n: self.force_n(frame),
            port_pressure_kpa: self
                .ports
                .iter()
                .map(|port| port.read(&fields.pressure_kpa))
                .collect(),
            port_slope_kpa_per_mm: self.port_slopes_kpa_per_mm(&fields.pressure_kpa),
            stress_feature_kpa_per_mm: self.stress_features_kpa_per_mm(fields),
            quality: solve_quality(frame),
        }
    }
}

/// The gel at one moment.
#[derive(Clone, Debug)]
pub struct Fields<'a> {
    /// The mesh at rest.
    pub mesh: &'a TetMesh,
    /// Displacement of each node, mm; `[n_nodes]`.
    pub displacements_mm: &'a [DVec3],
    /// Hydrostatic pressure -tr(σ)/3 at each node, kPa; `[n_nodes]`.
    pub pressure_kpa: Vec<f64>,
    /// Von Mises stress at each node, kPa; `[n_nodes]`.
    pub von_mises_kpa: Vec<f64>,
}

fn soft_material(material: &twintac_sensor::GelMaterial) -> Material {
    Material {
        model: material.model.clone(),
        bulk_modulus_kpa: material.bulk_modulus_kpa,
        prony: material.prony.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether the mesh for a bar of 3 mm with a rim of 0.5 mm has lines at ±1 mm, where the rim
    /// begins.
    fn has_lines(ways_mm: Option<&[DVec2]>, max_nodes: usize) -> bool {
        let settings = SimulateSettings {
            max_nodes,
            max_path_nodes: max_nodes,
            ..SimulateSettings::fine()
        };
        let gel = Gel::new(
            Arc::new(Sensor::read("../../../sensors/phystac.toml").unwrap()),
            settings,
        );
        let bar = Shape::Box {
            size_mm: [3.0, 10.0, 10.0],
            edge_radius_mm: 0.5,
        };
        let mesh = gel.mesh_for(&bar, &Pose::IDENTITY, 1.0, ways_mm).unwrap();
        [-1.0, 1.0].iter().all(|line_mm: &f64| {
            let mut nodes = mesh.body.mesh().nodes_mm.iter();
            nodes.any(|node| (node.x - line_mm).abs() < 0.01)
        })
    }

    #[test]
    fn meshes_of_paths_have_a_line_where_a_rim_begins_if_they_resolve_it() {
        assert!(has_lines(Some(&[]), 20_000));
        assert!(!has_lines(Some(&[]), 2_000));
        assert!(!has_lines(None, 20_000));
    }
}
