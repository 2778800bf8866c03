//! A gel that is pressed frame by frame.

use glam::DVec3;
use twintac_protocol::{PathFrame, PressPath};
use twintac_shape::{Pose, Shape};
use twintac_softbody::SolveError;

use crate::history::solve_quality;
use crate::readout::PortReadout;
use crate::walk::Walk;
use crate::{Fields, FollowedFrame, Gel, SimulateError};

/// A gel that one indenter presses, frame by frame: pushed, slid and turned as poses come. It keeps
/// its deformation, the history variables of its material, and the locations where friction holds
/// it.
pub struct GelState {
    walk: Walk,
    /// Ports of the taxels, then the points of the path, each with its name.
    ports: Vec<(String, PortReadout)>,
    /// Height of the indenter's origin at first touch, at the location and rotation of the first
    /// pose, mm.
    touch_mm: f64,
    reads_stress: bool,
    /// The largest force that the sensor withstands, N.
    limit_n: Option<f64>,
}

impl Gel {
    /// The gel at rest, before an indenter is taken along a path. The mesh is fine wherever the
    /// path presses.
    ///
    /// # Errors
    /// Those of [`Gel::mesh`]; a point outside the gel, or with the name of a taxel; a force above
    /// the sensor's limit.
    pub fn state_along(&self, shape: &Shape, path: &PressPath) -> Result<GelState, SimulateError> {
        let limit_n = self.sensor().limits.map(|limits| limits.force_n);
        for force_n in path.poses.iter().filter_map(|pose| pose.force_n) {
            stands(limit_n, force_n)?;
        }
        let rough = self.rough_for(&path.indenter);
        let first = rough.frames(shape, path)?[0].pose;
        let touch_mm = rough.touch(shape, &first)?.position_mm.z;
        // Two threads, because the caller waits for this single press.
        let gel = rough.mesh_along(shape, path)?.on_two_threads();
        let taxels = self.sensor().taxels.iter().map(|taxel| taxel.name.clone());
        let mut ports: Vec<(String, PortReadout)> = taxels.zip(gel.ports.iter().cloned()).collect();
        let n_taxels = ports.len();
        for point in &path.points {
            if ports[..n_taxels].iter().any(|(taxel, _)| *taxel == point.name) {
                let point = point.name.clone();
                return Err(SimulateError::PointIsTaxel { point });
            }
            let port = PortReadout::new(gel.body.mesh(), &point.name, point.position_mm, point.radius_mm)?;
            ports.push((point.name.clone(), port));
        }
        Ok(GelState {
            walk: Walk::new(gel, path, self.height_mm()).within(self.deadline),
            ports,
            touch_mm,
            reads_stress: self.stress_along_paths,
            limit_n,
        })
    }
}

/// An error if a force is above the sensor's limit. A search for a force far above it goes on until
/// the gel is flat, which takes minutes.
fn stands(limit_n: Option<f64>, force_n: f64) -> Result<(), SimulateError> {
    match limit_n.filter(|limit_n| force_n > *limit_n) {
        Some(limit_n) => Err(SimulateError::ForceLimit { force_n, limit_n }),
        None => Ok(()),
    }
}

impl GelState {
    /// One more frame, `since_previous_s` after the last: the indenter moves to a pose at constant
    /// speed on a straight line. The first frame ignores the time.
    ///
    /// # Errors
    /// [`SimulateError::Press`]: the solver finds no equilibrium. The gel keeps the state that it
    /// had before.
    pub fn step(
        &mut self,
        since_previous_s: f64,
        gel_from_indenter: &Pose,
    ) -> Result<FollowedFrame, SimulateError> {
        self.step_to(since_previous_s, gel_from_indenter, None)
    }

    /// As [`step`](Self::step), to where the indenter presses straight down with a force, N,
    /// above 0. The pose is moved up or down for this by at most the gel's height.
    ///
    /// # Errors
    /// As for [`step`](Self::step); also a force that is not reached, or that is above the sensor's
    /// limit.
    pub fn step_to_force(
        &mut self,
        since_previous_s: f64,
        gel_from_indenter: &Pose,
        force_n: f64,
    ) -> Result<FollowedFrame, SimulateError> {
        stands(self.limit_n, force_n)?;
        self.step_to(since_previous_s, gel_from_indenter, Some(force_n))
    }

    /// Releases the gel: it is at rest, without any history.
    pub fn rest(&mut self) {
        self.walk.rest();
    }

    /// The indenter's pose; `None` before the first frame.
    #[must_use]
    pub fn gel_from_indenter(&self) -> Option<Pose> {
        self.walk.pose()
    }

    fn step_to(
        &mut self,
        since_previous_s: f64,
        gel_from_indenter: &Pose,
        force_n: Option<f64>,
    ) -> Result<FollowedFrame, SimulateError> {
        let to = PathFrame {
            time_s: self.walk.time_s() + since_previous_s,
            pose: *gel_from_indenter,
            part: 1.0,
            forces_n: [None, force_n],
        };
        self.walk_to(&to).map_err(|error| SimulateError::Press {
            depth_mm: self.touch_mm - gel_from_indenter.position_mm.z,
            error,
        })
    }

    /// Height of the indenter's origin at first touch, at the location and rotation of the path's
    /// first pose, mm. Depths count from there.
    #[must_use]
    pub fn touch_mm(&self) -> f64 {
        self.touch_mm
    }

    /// The gel as it is now: its mesh, the displacements, and the stresses at its nodes.
    #[must_use]
    pub fn fields(&self) -> Fields<'_> {
        self.walk.gel.fields(&self.walk.state)
    }

    /// Nodes and tetrahedra of the mesh.
    pub(crate) fn mesh_size(&self) -> [usize; 2] {
        let mesh = self.walk.gel.body.mesh();
        [mesh.nodes_mm.len(), mesh.tets.len()]
    }

    pub(crate) fn walk_to(&mut self, to: &PathFrame) -> Result<FollowedFrame, SolveError> {
        let frame = self.walk.step(to)?;
        let (gel, state) = (&self.walk.gel, &self.walk.state);
        let position_mm: DVec3 = self.walk.pose().unwrap_or(to.pose).position_mm;
        let nodal_kpa = gel.body.pressure_kpa(state);
        let ports = self.ports.iter();
        Ok(FollowedFrame {
            time_s: to.time_s,
            position_mm,
            depth_mm: self.touch_mm - position_mm.z,
            force_n: frame.indenter_force_n,
            torque_n_mm: frame.indenter_torque_n_mm,
            pressure_kpa: ports
                .map(|(name, port)| (name.clone(), port.read(&nodal_kpa)))
                .collect(),
            port_slope_kpa_per_mm: gel.port_slopes_kpa_per_mm(&nodal_kpa),
            stress_feature_kpa_per_mm: if self.reads_stress {
                gel.stress_features_kpa_per_mm(&gel.fields(state))
            } else {
                Vec::new()
            },
            converged: frame.converged,
            behind_mm: frame.behind_mm,
            quality: solve_quality(&frame),
            wall_time_s: frame.wall_time_s,
            cost: frame.cost,
        })
    }
}
