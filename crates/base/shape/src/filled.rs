//! Surfaces without cavities.

use crate::TriangleSurface;
use crate::bvh::Bvh;
use crate::surface::bounds_of;

impl TriangleSurface {
    /// Whether the surface has closed cavities, which cannot be reached from outside.
    pub(crate) fn has_cavities(&self) -> bool {
        self.is_cavity.contains(&true)
    }

    /// The same surface, but distances are those to a body whose cavities are filled. The list of
    /// triangles still includes those of the cavities.
    pub(crate) fn with_distances_of_filled(&self) -> Self {
        let all = 0..self.is_cavity.len();
        let boxes: Vec<_> = all.map(|triangle| bounds_of(self.corners(triangle))).collect();
        let outer = |body: &Bvh| {
            let triangles = body.triangles().iter().copied();
            Bvh::new(
                &boxes,
                triangles.filter(|triangle| !self.is_cavity[*triangle]).collect(),
            )
        };
        let mut filled = self.clone();
        filled.bodies = self.bodies.iter().map(outer).collect();
        filled
    }
}
