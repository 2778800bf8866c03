//! A block that represents a half-space: its sides and its bottom are moved as in the half-space.

use std::f64::consts::PI;

use anyhow::Result;
use glam::DVec3;
use twintac_mesh::{TetMesh, bricks};
use twintac_softbody::{SoftBody, State};

/// Half of the block's width, and its height, in radii of the loaded disc.
pub(crate) const SIZE: f64 = 8.0;

/// A half-space with linear elasticity at small strain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfSpace {
    pub(crate) youngs_kpa: f64,
    pub(crate) poissons_ratio: f64,
    /// Radius of the loaded disc about the origin of the surface, mm.
    pub(crate) radius_mm: f64,
}

impl HalfSpace {
    /// The block below a disc, with its top at z = 0 and this many edges along the disc's radius,
    /// also in depth down to `fine_depth` radii.
    pub(crate) fn block(&self, edges: f64, fine_depth: f64) -> TetMesh {
        let radius_mm = self.radius_mm;
        let size_mm = SIZE * radius_mm;
        let growth = 1.0 + 1.8 / edges;
        let side = bricks::mirrored(&bricks::graded(
            radius_mm / edges,
            1.25 * radius_mm,
            growth,
            size_mm,
        ));
        let downs = bricks::graded(radius_mm / edges, fine_depth * radius_mm, growth, size_mm);
        let heights: Vec<f64> = downs.iter().rev().map(|down| -down).collect();
        let mut mesh = bricks::block(&side, &side, &heights);
        let is_outside = |at: DVec3| at.z == -size_mm || at.truncate().abs().max_element() == size_mm;
        bricks::bond(&mut mesh, is_outside);
        mesh
    }

    /// Moves the sides and the bottom as a vertical force at one point of the surface would
    /// (Boussinesq, 1885; Johnson, Contact Mechanics, 1985, equation 3.18). The displacement of a
    /// load on a disc differs from that, at a distance `r`, by the order of `(radius/r)²`.
    pub(crate) fn move_far(&self, body: &SoftBody, state: &mut State, force_n: f64) -> Result<()> {
        let mesh = body.mesh();
        let bonded = mesh.sets.bonded.iter();
        let moved: Vec<DVec3> = bonded
            .map(|&node| self.point_load_mm(mesh.nodes_mm[node as usize], force_n))
            .collect();
        body.advance_prescribed(state, &moved, 0.0)?;
        Ok(())
    }

    fn point_load_mm(&self, at_mm: DVec3, force_n: f64) -> DVec3 {
        let nu = self.poissons_ratio;
        let shear_mpa = 1e-3 * self.youngs_kpa / (2.0 * (1.0 + nu));
        let (distance, depth) = (at_mm.length(), -at_mm.z);
        let scale = force_n / (4.0 * PI * shear_mpa * distance);
        let aside = depth / distance.powi(2) - (1.0 - 2.0 * nu) / (distance + depth);
        let down = 2.0 * (1.0 - nu) + (depth / distance).powi(2);
        scale * (at_mm * aside).with_z(-down)
    }
}
