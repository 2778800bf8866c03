//! Surfaces without cavities.

use crate::TriangleSurface;
use crate::bvh::Bvh;
use crate::surface::bounds_of;

impl TriangleSurface {
    /// Whether there are closed cavities in it, which nothing outside can reach.
    pub(crate) fn has_cavities(&self) -> bool {
        self.is_cavity.contains(&true)
    }

    /// The same to whom asks how far it is: distances are those to a body whose cavities are filled. It still lists their triangles.
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
