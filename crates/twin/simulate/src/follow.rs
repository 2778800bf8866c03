//! An indenter on a path of its own: down, aside, tilted, and up again, to poses or with forces.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use serde::Serialize;
use twintac_depth_table::SolveQuality;
use twintac_protocol::{PathFrame, PressPath, Zero};
use twintac_shape::{Pose, Shape};
use twintac_softbody::{Cost, Frame, Push, SolveError, State};

use crate::history::solve_quality;
use crate::readout::PortReadout;
use crate::{Gel, GelMesh, SimulateError};

/// First guess of the depth that a prescribed force presses, as a fraction of the gel's height.
const GUESSED_DEPTH: f64 = 0.25;

/// The gel and the indenter at one moment of a path. Forces act on the gel, in its frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FollowedFrame {
    /// Time, s.
    pub time_s: f64,
    /// The indenter's origin, mm; z counts from the board.
    pub position_mm: DVec3,
    /// How far the indenter is below where, at the place and turn of the first pose, it first touches the gel, mm.
    pub depth_mm: f64,
    /// Force of the indenter, N.
    pub force_n: DVec3,
    /// Torque of the indenter about its origin, N mm.
    pub torque_n_mm: DVec3,
    /// Hydrostatic pressure -tr(σ)/3, averaged over the port of each taxel and over each point's disc, kPa.
    pub pressure_kpa: BTreeMap<String, f64>,
    /// How the pressure at each taxel changes with its port's place along x, along y and with its radius, kPa/mm; `[n_taxels]`.
    #[serde(skip)]
    pub port_slope_kpa_per_mm: Vec<[f64; 3]>,
    /// The stress feature above each taxel, as a table over depth has it, kPa/mm; `[n_taxels]`, or empty if the gel was not asked for it by
    /// [`Gel::with_stress_along_paths`].
    #[serde(skip)]
    pub stress_feature_kpa_per_mm: Vec<f64>,
    /// Quality of the solve.
    pub quality: SolveQuality,
    /// Wall time of the frame, s. It is not reproducible, and no result depends on it.
    pub wall_time_s: f64,
    /// The wall time by part of the solver.
    pub cost: Cost,
}

/// The result of a path.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Followed {
    /// Nodes of the mesh.
    pub n_nodes: usize,
    /// Tetrahedra of the mesh.
    pub n_tets: usize,
    /// Frames up to the last good one.
    pub frames: Vec<FollowedFrame>,
    /// Why the frames end before the path does; `None` if they do not.
    pub failure: Option<String>,
}

impl Gel {
    /// Meshes the gel for a path: fine wherever the path presses.
    ///
    /// # Errors
    /// Those of [`Gel::mesh`].
    pub fn mesh_along(&self, shape: &Shape, path: &PressPath) -> Result<GelMesh, SimulateError> {
        let frames = self.frames(shape, path)?;
        let first = frames[0].pose;
        let touch_mm = self.touch(shape, &first)?.position_mm.z;
        let depth_mm = |pose: &Pose| touch_mm - pose.position_mm.z;
        let is_pressed = |frame: &&PathFrame| depth_mm(&frame.pose) > 0.0 || frame.forces_n[1].is_some();
        let place = |frame: &PathFrame| frame.pose.position_mm.truncate();
        // Half the gel's height apart, the fine parts of the mesh run into each other.
        let apart_mm = 0.5 * self.height_mm();
        let mut ways_mm: Vec<DVec2> = vec![DVec2::ZERO];
        for frame in frames.iter().filter(is_pressed) {
            let way_mm = place(frame) - place(&frames[0]);
            if ways_mm.iter().all(|other| other.distance(way_mm) > apart_mm) {
                ways_mm.push(way_mm);
            }
        }
        let ways_mm = &ways_mm[1..];
        let mut deepest_mm = frames
            .iter()
            .map(|frame| depth_mm(&frame.pose))
            .fold(1e-3, f64::max);
        if path.asks_for_force() {
            let guess_mm = deepest_mm.max(GUESSED_DEPTH * self.height_mm());
            let gel = self.coarse().mesh_for(shape, &first, guess_mm, Some(ways_mm))?;
            let mut walk = Walk::new(&gel, path, self.height_mm());
            // Between waypoints forces and poses change evenly: the deepest place is at one.
            let waypoints = PressPath {
                rate_hz: None,
                ..path.clone()
            };
            for frame in self.frames(shape, &waypoints)? {
                if walk.step(&frame).is_err() {
                    break;
                }
                deepest_mm = deepest_mm.max(walk.pose().map_or(0.0, |pose| depth_mm(&pose)));
            }
        }
        self.mesh_for(shape, &first, deepest_mm, Some(ways_mm))
    }

    /// A path's frames in the gel's frame.
    fn frames(&self, shape: &Shape, path: &PressPath) -> Result<Vec<PathFrame>, SimulateError> {
        let mut frames = path.frames();
        if path.zero == Zero::Touch {
            let zero_mm = self.touch(shape, &frames[0].pose)?.position_mm.z;
            for frame in &mut frames {
                frame.pose.position_mm.z += zero_mm;
            }
        }
        Ok(frames)
    }

    /// Takes an indenter along a path. The mesh is fine wherever the path presses.
    ///
    /// # Errors
    /// Those of [`Gel::mesh`], and a point outside the gel. A path that can't be followed to its end is no error.
    pub fn follow(
        &self,
        shape: &Shape,
        path: &PressPath,
        advanced: &mut dyn FnMut(),
    ) -> Result<Followed, SimulateError> {
        let rough = self.rough_for(&path.indenter);
        let frames = rough.frames(shape, path)?;
        let touch_mm = rough.touch(shape, &frames[0].pose)?.position_mm.z;
        let depth_mm = |pose: &Pose| touch_mm - pose.position_mm.z;
        // Somebody waits for this one press.
        let gel = rough.mesh_along(shape, path)?.on_two_threads();
        let mesh = gel.body.mesh();
        let taxels = self.sensor().taxels.iter().map(|taxel| taxel.name.clone());
        let mut ports: Vec<(String, &PortReadout)> = taxels.zip(&gel.ports).collect();
        let points = path
            .points
            .iter()
            .map(|point| PortReadout::new(mesh, &point.name, point.position_mm, point.radius_mm))
            .collect::<Result<Vec<_>, _>>()?;
        ports.extend(path.points.iter().map(|point| point.name.clone()).zip(&points));

        let mut walk = Walk::new(&gel, path, self.height_mm());
        let mut followed = Followed {
            n_nodes: mesh.nodes_mm.len(),
            n_tets: mesh.tets.len(),
            frames: Vec::with_capacity(frames.len()),
            failure: None,
        };
        for path_frame in &frames {
            let time_s = path_frame.time_s;
            let frame = match walk.step(path_frame) {
                Ok(frame) => frame,
                Err(error) => {
                    followed.failure = Some(format!("at {time_s} s: {error}"));
                    break;
                }
            };
            let pose = walk.pose().unwrap_or(path_frame.pose);
            let nodal_kpa = gel.body.pressure_kpa(&walk.state);
            followed.frames.push(FollowedFrame {
                time_s,
                position_mm: pose.position_mm,
                depth_mm: depth_mm(&pose),
                force_n: frame.indenter_force_n,
                torque_n_mm: frame.indenter_torque_n_mm,
                pressure_kpa: ports
                    .iter()
                    .map(|(name, port)| (name.clone(), port.read(&nodal_kpa)))
                    .collect(),
                port_slope_kpa_per_mm: gel.port_slopes_kpa_per_mm(&nodal_kpa),
                stress_feature_kpa_per_mm: if self.stress_along_paths {
                    gel.stress_features_kpa_per_mm(&gel.fields(&walk.state))
                } else {
                    Vec::new()
                },
                quality: solve_quality(&frame),
                wall_time_s: frame.wall_time_s,
                cost: frame.cost,
            });
            advanced();
        }
        Ok(followed)
    }
}

/// A gel on whose indenter a path is followed.
struct Walk<'a> {
    gel: &'a GelMesh,
    state: State,
    direction: DVec3,
    travel_mm: f64,
    /// Time of the last frame, s.
    time_s: Option<f64>,
    /// How far beyond its pose the indenter was at the last frame of prescribed force, mm.
    beyond_mm: f64,
    /// Force along the direction at the last frame of prescribed pose, N.
    force_n: f64,
}

impl<'a> Walk<'a> {
    fn new(gel: &'a GelMesh, path: &PressPath, height_mm: f64) -> Self {
        Self {
            gel,
            state: gel.body.rest(),
            direction: path.force_direction.normalize_or(DVec3::NEG_Z),
            travel_mm: path.force_travel_mm.unwrap_or(height_mm),
            time_s: None,
            beyond_mm: 0.0,
            force_n: 0.0,
        }
    }

    /// Where the indenter is.
    fn pose(&self) -> Option<Pose> {
        self.state.gel_from_indenter()
    }

    fn step(&mut self, to: &PathFrame) -> Result<Frame, SolveError> {
        let time_step_s = to.time_s - self.time_s.unwrap_or(to.time_s);
        let (body, indenter) = (&self.gel.body, self.gel.indenter.as_ref());
        let mut pose = to.pose;
        let frame = match to.forces_n {
            [from_n, Some(to_n)] => {
                let from_n = from_n.unwrap_or(self.force_n);
                let push = Push {
                    direction: self.direction,
                    force_n: from_n + to.part * (to_n - from_n),
                    travel_mm: self.travel_mm,
                };
                let frame = body.advance_to_force(&mut self.state, indenter, &pose, &push, time_step_s)?;
                let found_mm = self.pose().map_or(pose.position_mm, |found| found.position_mm);
                self.beyond_mm = (found_mm - pose.position_mm).dot(self.direction);
                frame
            }
            [from_n, None] => {
                if from_n.is_some() {
                    pose.position_mm += self.direction * (self.beyond_mm * (1.0 - to.part));
                }
                let frame = body.advance(&mut self.state, indenter, &pose, time_step_s)?;
                self.force_n = frame.indenter_force_n.dot(self.direction).max(0.0);
                frame
            }
        };
        self.time_s = Some(to.time_s);
        Ok(frame)
    }
}
