//! An indenter along a path: down, sideways, tilted and up again, given by poses or by forces.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use twintac_depth_table::SolveQuality;
use twintac_protocol::{PathFrame, PressPath, Zero};
use twintac_shape::{Pose, Shape};
use twintac_softbody::Cost;

use crate::error::reason;
use crate::walk::Walk;
use crate::{Gel, GelMesh, SimulateError};

/// First guess of the depth that a prescribed force presses, as a fraction of the gel's height.
const GUESSED_DEPTH: f64 = 0.25;

/// The gel and the indenter at one moment of a path. Forces act on the gel, in its frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FollowedFrame {
    /// Time, s.
    pub time_s: f64,
    /// The indenter's origin, mm; z counts from the board.
    pub position_mm: DVec3,
    /// Depth of the indenter, mm, from its height at first touch at the location and rotation of
    /// the path's first pose.
    pub depth_mm: f64,
    /// Force of the indenter, N.
    pub force_n: DVec3,
    /// Torque of the indenter about its origin, N mm.
    pub torque_n_mm: DVec3,
    /// Hydrostatic pressure -tr(σ)/3, averaged over the port of each taxel and over the disc of
    /// each point of the path, kPa; by name.
    pub pressure_kpa: BTreeMap<String, f64>,
    /// Derivatives of the pressure at each taxel with respect to its port's x, y and radius,
    /// kPa/mm; `[n_taxels]`.
    #[serde(skip)]
    pub port_slope_kpa_per_mm: Vec<[f64; 3]>,
    /// The stress feature above each taxel, as in a table over depth, kPa/mm; `[n_taxels]`. Empty
    /// unless the gel was asked for it by [`Gel::with_stress_along_paths`].
    #[serde(skip)]
    pub stress_feature_kpa_per_mm: Vec<f64>,
    /// Whether this is the equilibrium at the pose that the path asks for. It always is, unless the
    /// gel has a deadline ([`Gel::with_deadline`]) that came first.
    #[serde(default = "yes")]
    pub converged: bool,
    /// How far the indenter of this frame is behind the pose that the path asks for, mm; 0 without
    /// a deadline.
    #[serde(default)]
    pub behind_mm: f64,
    /// Quality of the solve. Its residual says how far the forces are from balance.
    pub quality: SolveQuality,
    /// Wall time of the frame, s. It is not reproducible, and no result depends on it.
    pub wall_time_s: f64,
    /// The wall time by part of the solver.
    pub cost: Cost,
}

/// Frames that were written before there were deadlines had converged.
fn yes() -> bool {
    true
}

/// The result of a path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Followed {
    /// Nodes of the mesh.
    pub n_nodes: usize,
    /// Tetrahedra of the mesh.
    pub n_tets: usize,
    /// Frames, up to the last one that was solved.
    pub frames: Vec<FollowedFrame>,
    /// Why the frames end before the path does; `None` if they reach its end.
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
        // Fine parts of the mesh that are half the gel's height apart run into each other.
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
            let mut walk = Walk::new(gel, path, self.height_mm());
            // Forces and poses change linearly between waypoints, so the deepest location is at a
            // waypoint.
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
    pub(crate) fn frames(&self, shape: &Shape, path: &PressPath) -> Result<Vec<PathFrame>, SimulateError> {
        let mut frames = path.frames();
        if path.zero == Zero::Touch {
            let zero_mm = self.touch(shape, &frames[0].pose)?.position_mm.z;
            for frame in &mut frames {
                frame.pose.position_mm.z += zero_mm;
            }
        }
        Ok(frames)
    }

    /// Takes an indenter along a path. The mesh is fine wherever the path presses. `advanced` is
    /// called after each frame and says whether to continue.
    ///
    /// # Errors
    /// Those of [`Gel::mesh`], and a point outside the gel. A path that cannot be followed to its
    /// end is not an error: see [`Followed::failure`].
    pub fn follow(
        &self,
        shape: &Shape,
        path: &PressPath,
        advanced: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<Followed, SimulateError> {
        let frames = self.frames(shape, path)?;
        let mut state = self.state_along(shape, path)?;
        let [n_nodes, n_tets] = state.mesh_size();
        let mut followed = Followed {
            n_nodes,
            n_tets,
            frames: Vec::with_capacity(frames.len()),
            failure: None,
        };
        for to in &frames {
            match state.walk_to(to) {
                Ok(frame) => followed.frames.push(frame),
                Err(error) => {
                    followed.failure = Some(format!("at {} s: {}", to.time_s, reason(&error)));
                    break;
                }
            }
            if advanced().is_break() {
                followed.failure = Some(format!("stopped after {} s", to.time_s));
                break;
            }
        }
        Ok(followed)
    }
}
