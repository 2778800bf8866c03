//! The blocks of the pairs of nodes at one quadrature point.
//!
//! With the derivatives of the invariants `f_a = F G_a`, `c_a = J F⁻ᵀ G_a`,
//! `h_a = 2 (I1 F - F C) G_a` and `o_a = 2 F O G_a`, the second derivatives of the energy give a
//! pair of nodes the block
//!
//! ```text
//! w_11 4 f⊗f + w_22 h⊗h + w_12 2 (f⊗h + h⊗f)
//! + w_1J 2 (f⊗c + c⊗f) + w_2J (h⊗c + c⊗h) + w_JJ c⊗c
//! ```
//!
//! and the same for the constant stress `O` of the history variables. The second derivatives of the
//! invariants add
//!
//! ```text
//! 2 w_1 G_a·G_b 1
//! 2 w_2 [2 f_a⊗f_b - f_b⊗f_a + (I1 G_a·G_b - f_a·f_b) 1 - G_a·G_b FFᵀ]
//! (w_J - p)/J (c_a⊗c_b - c_b⊗c_a)
//! ```

use twintac_material::LawProperties;

use super::super::deformation::{
    Deformation, Matrix, Vector, apply, contract, dot, multiply, right_cauchy_green, symmetric,
};
use super::super::law::{Points, SecondDerivatives};
use super::super::table::NODES;
use super::sink::NodeBlock;
use crate::wide::Wide;

/// The terms of which the blocks of a point are made. Scratch memory, set point by point; vectors
/// are set for the nodes of the point only.
pub(super) struct PointStiffness {
    /// `f_a`
    pushed: [Vector<f32>; NODES],
    /// `c_a`
    pub(super) spatial: [Vector<f32>; NODES],
    /// `w_1J`, `w_11` and `w_JJ` with their factors, and `2 w_1`.
    spatial_pushed: Wide<f32>,
    pushed_pushed: Wide<f32>,
    spatial_spatial: Wide<f32>,
    isotropic: Wide<f32>,
    /// `(w_J - p)/J`
    skew: Wide<f32>,
    offset: OffsetTerms,
    second: SecondTerms,
}

/// The terms of a constant stress `O`; set only if there is one.
struct OffsetTerms {
    is_set: bool,
    /// `o_a`/2
    pushed: [Vector<f32>; NODES],
    /// `O G_a`, times `J^(-2/3)` and the volume.
    turned: [Vector<f32>; NODES],
    spatial_pushed: Wide<f32>,
}

/// The terms of the second invariant; set only for a law that uses it.
struct SecondTerms {
    /// `h_a`
    slopes: [Vector<f32>; NODES],
    /// `FFᵀ`
    left_cauchy_green: Matrix<f32>,
    first_invariant: Wide<f32>,
    /// `2 w_2`
    twice: Wide<f32>,
    /// `w_2J`, `w_22` and `2 w_12`
    with_volume: Wide<f32>,
    with_second: Wide<f32>,
    with_first: Wide<f32>,
}

impl PointStiffness {
    pub(super) fn new() -> Self {
        let zero = Wide::zero();
        let vectors = [[zero; 3]; NODES];
        Self {
            pushed: vectors,
            spatial: vectors,
            spatial_pushed: zero,
            pushed_pushed: zero,
            spatial_spatial: zero,
            isotropic: zero,
            skew: zero,
            offset: OffsetTerms {
                is_set: false,
                pushed: vectors,
                turned: vectors,
                spatial_pushed: zero,
            },
            second: SecondTerms {
                slopes: vectors,
                left_cauchy_green: [[zero; 3]; 3],
                first_invariant: zero,
                twice: zero,
                with_volume: zero,
                with_second: zero,
                with_first: zero,
            },
        }
    }

    /// Sets all terms for a point whose nodes have these gradients.
    #[inline(always)]
    pub(super) fn set(
        &mut self,
        at: &Points<SecondDerivatives>,
        point: usize,
        properties: LawProperties,
        gradients: &[Vector<f32>],
        [pressure, volume_mm3, factor]: [Wide<f32>; 3],
        offset: Option<&[Wide<f64>; 6]>,
    ) {
        let deformation = &at.deformations[point];
        let SecondDerivatives {
            slopes, curvatures, ..
        } = &at.law[point];
        let two = Wide::splat(2.0);
        let scale = factor * volume_mm3;
        let inverse = if properties.bears_inversion {
            Wide::splat(1.0) / away_from_zero(deformation.volume_ratio)
        } else {
            Wide::splat(1.0) / deformation.volume_ratio
        };
        for (a, gradient) in gradients.iter().enumerate() {
            self.pushed[a] = apply(&deformation.gradient, gradient);
            self.spatial[a] = apply(&deformation.cofactor, gradient);
        }
        let mut along_volume = slopes.volume * scale - pressure * volume_mm3;
        self.spatial_spatial = curvatures.volume_volume * scale;
        self.spatial_pushed = curvatures.first_volume * scale * two;
        self.pushed_pushed = curvatures.first_first * scale * Wide::splat(4.0);
        self.isotropic = slopes.first * scale * two;
        self.offset.is_set = offset.is_some();
        if let Some(offset) = offset {
            let isochoric = at.arguments[point].invariants.isochoric * volume_mm3;
            let square = self
                .offset
                .set(&deformation.gradient, &symmetric(offset), gradients, isochoric);
            along_volume -= square * inverse * Wide::splat(1.0 / 3.0);
            self.spatial_spatial += square * inverse * inverse * Wide::splat(5.0 / 9.0);
            self.offset.spatial_pushed = isochoric * inverse * Wide::splat(-2.0 / 3.0);
        }
        if properties.uses_second {
            let first = at.arguments[point].invariants.first;
            self.second.set(deformation, first, gradients, &self.pushed);
            self.second.twice = slopes.second * scale * two;
            self.second.with_volume = curvatures.second_volume * scale;
            self.second.with_second = curvatures.second_second * scale;
            self.second.with_first = curvatures.first_second * scale * two;
        }
        self.skew = along_volume * inverse;
    }

    /// Adds to the block of the nodes `a >= b` of the point.
    #[inline(always)]
    pub(super) fn add(
        &self,
        properties: LawProperties,
        gradients: &[Vector<f32>; NODES],
        [a, b]: [usize; 2],
        block: &mut NodeBlock,
    ) {
        let Self {
            pushed,
            spatial,
            spatial_pushed,
            offset,
            ..
        } = self;
        // The factors to the right of c_a and of f_a.
        let mut right_of_spatial = [Wide::zero(); 3];
        let mut right_of_pushed = [Wide::zero(); 3];
        for j in 0..3 {
            right_of_spatial[j] = (spatial[b][j] * (self.spatial_spatial + self.skew))
                .plus_product(pushed[b][j], *spatial_pushed);
            right_of_pushed[j] = spatial[b][j] * *spatial_pushed;
            if properties.is_curved {
                right_of_pushed[j] += pushed[b][j] * self.pushed_pushed;
            }
            if offset.is_set {
                right_of_spatial[j] += offset.pushed[b][j] * offset.spatial_pushed;
            }
        }
        for i in 0..3 {
            let left = -(spatial[b][i] * self.skew);
            for j in 0..3 {
                block[i][j] = block[i][j]
                    .plus_product(spatial[a][i], right_of_spatial[j])
                    .plus_product(pushed[a][i], right_of_pushed[j])
                    .plus_product(left, spatial[a][j]);
            }
        }
        let product = dot(&gradients[a], &gradients[b]);
        let mut diagonal = self.isotropic * product;
        if offset.is_set {
            diagonal += dot(&gradients[a], &offset.turned[b]);
            for i in 0..3 {
                for j in 0..3 {
                    block[i][j] += offset.pushed[a][i] * offset.spatial_pushed * spatial[b][j];
                }
            }
        }
        if properties.uses_second {
            let second = &self.second;
            diagonal += second.twice * (second.first_invariant * product - dot(&pushed[a], &pushed[b]));
            second.add(properties, product, pushed, spatial, [a, b], block);
        }
        for i in 0..3 {
            block[i][i] += diagonal;
        }
    }
}

impl OffsetTerms {
    /// Sets the vectors; returns `O:C` times `J^(-2/3)` and the volume.
    #[inline(always)]
    fn set(
        &mut self,
        f: &Matrix<f32>,
        offset: &Matrix<f32>,
        gradients: &[Vector<f32>],
        isochoric: Wide<f32>,
    ) -> Wide<f32> {
        let product = multiply(f, offset);
        for (a, gradient) in gradients.iter().enumerate() {
            self.pushed[a] = apply(&product, gradient);
            self.turned[a] = apply(offset, gradient).map(|x| x * isochoric);
        }
        contract(f, &product) * isochoric
    }
}

impl SecondTerms {
    /// Sets the vectors, `FFᵀ` and the first invariant.
    #[inline(always)]
    fn set(
        &mut self,
        deformation: &Deformation<f32>,
        first: Wide<f32>,
        gradients: &[Vector<f32>],
        pushed: &[Vector<f32>; NODES],
    ) {
        let f = &deformation.gradient;
        let product = multiply(f, &right_cauchy_green(f));
        for (a, gradient) in gradients.iter().enumerate() {
            let moved = apply(&product, gradient);
            for i in 0..3 {
                self.slopes[a][i] = (first * pushed[a][i] - moved[i]) * Wide::splat(2.0);
            }
        }
        for i in 0..3 {
            for j in 0..3 {
                self.left_cauchy_green[i][j] = dot(&f[i], &f[j]);
            }
        }
        self.first_invariant = first;
    }

    /// Adds everything except for the multiple of the identity.
    #[inline(always)]
    fn add(
        &self,
        properties: LawProperties,
        product: Wide<f32>,
        pushed: &[Vector<f32>; NODES],
        spatial: &[Vector<f32>; NODES],
        [a, b]: [usize; 2],
        block: &mut NodeBlock,
    ) {
        let second = &self.slopes;
        for i in 0..3 {
            for j in 0..3 {
                block[i][j] += self.twice
                    * (Wide::splat(2.0) * pushed[a][i] * pushed[b][j]
                        - pushed[b][i] * pushed[a][j]
                        - product * self.left_cauchy_green[i][j])
                    + self.with_volume * (second[a][i] * spatial[b][j] + spatial[a][i] * second[b][j]);
                if properties.is_curved {
                    block[i][j] += self.with_second * second[a][i] * second[b][j]
                        + self.with_first * (pushed[a][i] * second[b][j] + second[a][i] * pushed[b][j]);
                }
            }
        }
    }
}

/// Keeps single precision meaningful in tetrahedra that are close to inversion.
#[inline(always)]
fn away_from_zero(volume_ratio: Wide<f32>) -> Wide<f32> {
    volume_ratio.map(|ratio| ratio.abs().max(1e-3).copysign(ratio))
}
