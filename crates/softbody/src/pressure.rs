//! The pressure field that belongs to a displacement field.
//!
//! In the pair of linear displacements and linear pressures, the potential is
//!
//! `Π(u, p) = ∫ W̄ - p (J - 1) - p²/(2K) - w/(2μ) (p - πp)² dV`,
//!
//! `p` positive in compression, `p²` integrated at the nodes, and `πp` the mean of `p` over a tetrahedron: the stabilisation of
//! Dohrmann and Bochev (Int. J. Numer. Methods Fluids 46, 2004), which for a tetrahedron of size `h` is the better known
//! `-α h²/(2μ) |∇p|²` with α near `0.04 w`, but needs no choice of `h`. `Π` is quadratic and concave in `p`, so that its stationary
//! point can be put in: `p = -S⁻¹ g(u)` with `g_a = ∫ N_a (J - 1) dV`, and what is left is an energy of the displacements alone,
//! `∫ W̄ dV + ½ gᵀ S⁻¹ g`, which a line search can go down. `S` never changes.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, MatMut, Par, Side, Spec};

use crate::SoftBodyError;
use crate::element::Element;

/// `S` and its factors.
pub(crate) struct Compressibility {
    symbolic: SymbolicCholesky<u32>,
    factors: Vec<f64>,
}

/// `S` of an element, mm³/MPa: for two corners that are the same, and two that are not.
pub(crate) fn element_compressibility(
    element: &Element,
    bulk_mpa: f64,
    shear_mpa: f64,
    weight: f64,
) -> (f64, f64) {
    let stabilisation = weight * element.volume_mm3 / shear_mpa;
    // Mass matrix V/20 (1 + δ_ab) less that of the means, V/16.
    let (same, other) = (0.1 - 0.0625, 0.05 - 0.0625);
    (
        0.25 * element.volume_mm3 / bulk_mpa + stabilisation * same,
        stabilisation * other,
    )
}

impl Compressibility {
    pub(crate) fn new(
        elements: &[Element],
        n_nodes: usize,
        of_element: impl Fn(&Element) -> (f64, f64),
    ) -> Result<Self, SoftBodyError> {
        let failed = |reason: String| SoftBodyError::Analysis {
            n_unknowns: n_nodes,
            reason,
        };
        let mut triplets = Vec::with_capacity(10 * elements.len());
        for element in elements {
            let (same, other) = of_element(element);
            for (a, &row) in element.nodes.iter().enumerate() {
                for &column in &element.nodes[..a] {
                    triplets.push(Triplet::new(row.min(column), row.max(column), other));
                }
                triplets.push(Triplet::new(row, row, same));
            }
        }
        let upper = SparseColMat::<u32, f64>::try_new_from_triplets(n_nodes, n_nodes, &triplets)
            .map_err(|error| failed(error.to_string()))?;
        let symbolic = factorize_symbolic_cholesky(
            upper.symbolic(),
            Side::Upper,
            SymmetricOrdering::Amd,
            CholeskySymbolicParams::default(),
        )
        .map_err(|error| failed(error.to_string()))?;
        let mut factors = vec![0.0; symbolic.len_val()];
        let mut scratch =
            MemBuffer::new(symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default()));
        symbolic
            .factorize_numeric_llt(
                &mut factors,
                upper.as_ref(),
                Side::Upper,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut scratch),
                Spec::default(),
            )
            .map_err(|error| failed(error.to_string()))?;
        Ok(Self { symbolic, factors })
    }

    pub(crate) fn scratch(&self) -> MemBuffer {
        MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq))
    }

    /// `values ← S⁻¹ values`
    pub(crate) fn solve(&self, values: &mut [f64], scratch: &mut MemBuffer) {
        let n = values.len();
        LltRef::new(&self.symbolic, &self.factors).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(values, n, 1),
            Par::Seq,
            MemStack::new(scratch),
        );
    }
}
