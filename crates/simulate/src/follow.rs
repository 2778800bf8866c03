//! An indenter on a path of its own: down, aside, tilted, and up again.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use serde::Serialize;
use twintac_protocol::{PressPath, Zero};
use twintac_shape::{Pose, Shape};

use crate::readout::PortReadout;
use crate::{Gel, GelMesh, Honesty, SimulateError};

/// The gel and the indenter at one moment of a path. Forces act on the gel, in its frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FollowedFrame {
    /// Time, s.
    pub time_s: f64,
    /// The indenter's origin, mm; z counts from the board.
    pub position_mm: DVec3,
    /// Force of the indenter, N.
    pub force_n: DVec3,
    /// Torque of the indenter about its origin, N mm.
    pub torque_n_mm: DVec3,
    /// Hydrostatic pressure -tr(σ)/3, averaged over the port of each taxel and over each point's disc, kPa.
    pub pressure_kpa: BTreeMap<String, f64>,
    /// How far to trust it.
    pub honesty: Honesty,
    /// Wall time of the frame, s. No part of what repeats.
    pub wall_time_s: f64,
}

/// What came of a path.
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
        let frames = self.poses(shape, path)?;
        let first = frames[0].1;
        let touch_mm = self.touch(shape, &first)?.position_mm.z;
        let depth_mm = |pose: &Pose| touch_mm - pose.position_mm.z;
        let deepest_mm = frames.iter().map(|(_, pose)| depth_mm(pose)).fold(0.0, f64::max);
        let place = |pose: &Pose| pose.position_mm.truncate();
        // Half the gel's height apart, the fine parts of the mesh run into each other.
        let apart_mm = 0.5 * self.height_mm();
        let mut ways_mm: Vec<DVec2> = vec![DVec2::ZERO];
        for (_, pose) in frames.iter().filter(|(_, pose)| depth_mm(pose) > 0.0) {
            let way_mm = place(pose) - place(&first);
            if ways_mm.iter().all(|other| other.distance(way_mm) > apart_mm) {
                ways_mm.push(way_mm);
            }
        }
        self.mesh_for(shape, &first, deepest_mm.max(1e-3), Some(&ways_mm[1..]))
    }

    /// Times and poses in the gel's frame.
    fn poses(&self, shape: &Shape, path: &PressPath) -> Result<Vec<(f64, Pose)>, SimulateError> {
        let mut frames = path.frames();
        if let (Zero::Touch, Some((_, first))) = (path.zero, frames.first()) {
            let zero_mm = self.touch(shape, first)?.position_mm.z;
            for (_, pose) in &mut frames {
                pose.position_mm.z += zero_mm;
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
        let frames = self.poses(shape, path)?;
        // Somebody waits for this one press.
        let gel = self.mesh_along(shape, path)?.on_two_threads();
        let mesh = gel.body.mesh();
        let taxels = self.sensor().taxels.iter().map(|taxel| taxel.name.clone());
        let mut ports: Vec<(String, &PortReadout)> = taxels.zip(&gel.ports).collect();
        let points = path
            .points
            .iter()
            .map(|point| PortReadout::new(mesh, &point.name, point.position_mm, point.radius_mm))
            .collect::<Result<Vec<_>, _>>()?;
        ports.extend(path.points.iter().map(|point| point.name.clone()).zip(&points));

        let mut state = gel.body.rest();
        let mut followed = Followed {
            n_nodes: mesh.nodes_mm.len(),
            n_tets: mesh.tets.len(),
            frames: Vec::with_capacity(frames.len()),
            failure: None,
        };
        let mut previous_s = frames[0].0;
        for (time_s, pose) in &frames {
            let frame = match gel
                .body
                .advance(&mut state, gel.indenter.as_ref(), pose, time_s - previous_s)
            {
                Ok(frame) => frame,
                Err(error) => {
                    followed.failure = Some(format!("at {time_s} s: {error}"));
                    break;
                }
            };
            previous_s = *time_s;
            let nodal_kpa = gel.body.pressure_kpa(&state);
            followed.frames.push(FollowedFrame {
                time_s: *time_s,
                position_mm: pose.position_mm,
                force_n: frame.indenter_force_n,
                torque_n_mm: frame.indenter_torque_n_mm,
                pressure_kpa: ports
                    .iter()
                    .map(|(name, port)| (name.clone(), port.read(&nodal_kpa)))
                    .collect(),
                honesty: Honesty::of(&frame),
                wall_time_s: frame.wall_time_s,
            });
            advanced();
        }
        Ok(followed)
    }
}
