//! Whether quadratic tetrahedra have folded: between quadrature points, at which everything is
//! right, displacements may turn a tetrahedron inside out.

use glam::DVec3;

use super::deformation::Deformation;
use super::elements::Elements;
use super::quadratic;

impl Elements {
    /// Smallest volume ratio at the corners of quadratic tetrahedra, where their gradients are
    /// extreme.
    pub(crate) fn smallest_corner_ratio(&self, displacements_mm: &[DVec3]) -> f64 {
        let corners: Vec<_> = quadratic::corners().collect();
        let mut smallest = f64::INFINITY;
        for pack in &self.packs {
            let ten = pack.gather(displacements_mm);
            for corner in &corners {
                let ratios = Deformation::new(&ten, corner, &pack.gradients).volume_ratio;
                smallest = ratios.0.into_iter().fold(smallest, f64::min);
            }
        }
        smallest
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::one;
    use super::super::{Element, Volumes};
    use super::*;

    #[test]
    fn a_fold_at_a_corner_is_seen_between_points_that_are_right() {
        let (nodes_mm, elements) = one(Element::Quadratic);
        let mut moved_mm: Vec<DVec3> = nodes_mm.iter().map(|at| *at * 0.2).collect();
        assert!((elements.smallest_corner_ratio(&moved_mm) - 1.2_f64.powi(3)).abs() < 1e-12);

        // Along an edge with the displaced midpoint, the ratio is 1 - 4 δ at one end.
        moved_mm.fill(DVec3::ZERO);
        let middle_mm = 0.5 * (nodes_mm[0] + nodes_mm[1]);
        let midpoint = nodes_mm.iter().position(|at| at.distance(middle_mm) < 1e-12);
        moved_mm[midpoint.expect("an edge has a midpoint")] = 0.3 * (nodes_mm[1] - nodes_mm[0]);
        assert!((elements.smallest_corner_ratio(&moved_mm) + 0.2).abs() < 1e-12);
        let at_points = elements.volumes(&moved_mm, &mut Volumes::default());
        assert!(at_points > 0.4, "{at_points}");
    }
}
