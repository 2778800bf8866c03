//! Surfaces without cavities.

use glam::DVec3;

use crate::TriangleSurface;

impl TriangleSurface {
    /// Whether there are closed cavities in it, which nothing outside can reach.
    #[must_use]
    pub fn has_cavities(&self) -> bool {
        self.is_cavity.contains(&true)
    }

    /// The same with its cavities filled.
    #[must_use]
    pub fn filled(&self) -> Self {
        let outer = (0..self.is_cavity.len()).filter(|&triangle| !self.is_cavity[triangle]);
        let outer: Vec<[DVec3; 3]> = outer.map(|triangle| self.corners(triangle)).collect();
        // What is left is as closed as it was.
        Self::from_triangles(&outer).unwrap_or_else(|_| self.clone())
    }
}
