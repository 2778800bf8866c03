//! The linear tetrahedron: constant deformation, mean of its corners' pressures.
//!
//! With `F = 1 + Σ u_a ⊗ G_a`, `γ_a = F⁻ᵀ G_a`, the isochoric stress `S̄` of the step, `φ_a = F S̄ G_a`, `q = S̄ : FᵀF` and the
//! pressure `p` (positive in compression), the energy `V [W̄(C̄) - p (J - 1)]` has the derivatives
//!
//! `f_a  = V [J^(-2/3) (φ_a - q/3 γ_a) - p J γ_a]`
//!
//! `K_ab = V { J^(-2/3) [(G_a·S̄ G_b) 1 - 2/3 (γ_a⊗φ_b + φ_a⊗γ_b) + 2/9 q γ_a⊗γ_b + q/3 γ_b⊗γ_a]
//!            - p J (γ_a⊗γ_b - γ_b⊗γ_a) + ½ δ_aC̄ : ∂S̄/∂C̄ : δ_bC̄ }`

use glam::{DMat3, DVec3};

use crate::material::Response;

/// Shape of a tetrahedron at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Element {
    /// Its nodes, in the order of elimination.
    pub(crate) nodes: [u32; 4],
    /// Gradients of its shape functions, 1/mm.
    pub(crate) gradients: [DVec3; 4],
    /// Volume, mm³.
    pub(crate) volume_mm3: f64,
}

/// How a tetrahedron is deformed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deformation {
    /// `F`
    pub(crate) gradient: DMat3,
    /// `J F⁻ᵀ`
    pub(crate) cofactor: DMat3,
    /// `J = det F`
    pub(crate) volume_ratio: f64,
}

/// Derivatives of an element's energy.
pub(crate) struct Tangent {
    /// `K_ab` for `a >= b`, at `a (a + 1) / 2 + b`. N/mm.
    pub(crate) stiffness: [DMat3; 10],
    /// Change of the element's volume with each corner's displacement, mm².
    pub(crate) volume_slope: [DVec3; 4],
}

impl Element {
    pub(crate) fn new(nodes: [u32; 4], corners_mm: [DVec3; 4]) -> Self {
        let [a, b, c, d] = corners_mm;
        let edges = DMat3::from_cols(b - a, c - a, d - a);
        let inverse = edges.inverse().transpose();
        let gradients = [
            -(inverse.x_axis + inverse.y_axis + inverse.z_axis),
            inverse.x_axis,
            inverse.y_axis,
            inverse.z_axis,
        ];
        Self {
            nodes,
            gradients,
            volume_mm3: edges.determinant().abs() / 6.0,
        }
    }

    #[inline]
    pub(crate) fn deformation(&self, displacements_mm: &[DVec3]) -> Deformation {
        let mut gradient = DMat3::IDENTITY;
        for (node, shape) in self.nodes.iter().zip(&self.gradients) {
            let u = displacements_mm[*node as usize];
            gradient.x_axis += u * shape.x;
            gradient.y_axis += u * shape.y;
            gradient.z_axis += u * shape.z;
        }
        Deformation::new(gradient)
    }

    /// Mean of the corners' pressures.
    #[inline]
    pub(crate) fn mean(&self, pressures: &[f64]) -> f64 {
        0.25 * self
            .nodes
            .iter()
            .map(|&node| pressures[node as usize])
            .sum::<f64>()
    }

    /// Gradient of the energy with respect to each corner, N.
    #[inline]
    pub(crate) fn forces(&self, deformation: &Deformation, response: &Response, pressure: f64) -> [DVec3; 4] {
        let stress = deformation.first_piola_kirchhoff(response, pressure) * self.volume_mm3;
        self.gradients.map(|gradient| stress * gradient)
    }

    /// Second derivatives of the energy.
    #[inline]
    pub(crate) fn tangent(&self, deformation: &Deformation, response: &Response, pressure: f64) -> Tangent {
        let Deformation {
            gradient,
            cofactor,
            volume_ratio,
        } = deformation;
        let isochoric = deformation.isochoric_factor() * self.volume_mm3;
        let volumetric = pressure * volume_ratio * self.volume_mm3;
        let spatial = self.gradients.map(|g| *cofactor * g / *volume_ratio);
        let stressed = self.gradients.map(|g| response.stress * g);
        let pushed = stressed.map(|g| *gradient * g);
        let q = (0..3)
            .map(|i| gradient.row(i).dot(response.stress * gradient.row(i)))
            .sum::<f64>();

        let outer = isochoric * 2.0 / 9.0 * q - volumetric;
        let crossed = isochoric * q / 3.0 + volumetric;
        let mut stiffness = [DMat3::ZERO; 10];
        for a in 0..4 {
            // -2/3 (γ_a⊗φ_b + φ_a⊗γ_b) + 2/9 q γ_a⊗γ_b gathered into what stands left of γ_b and of φ_b.
            let left_of_spatial = spatial[a] * outer - pushed[a] * (isochoric * 2.0 / 3.0);
            let left_of_pushed = spatial[a] * (-isochoric * 2.0 / 3.0);
            let right_of_spatial = spatial[a] * crossed;
            for b in 0..=a {
                let diagonal = isochoric * self.gradients[a].dot(stressed[b]);
                let column = |i: usize| {
                    left_of_spatial * spatial[b][i]
                        + left_of_pushed * pushed[b][i]
                        + spatial[b] * right_of_spatial[i]
                };
                stiffness[a * (a + 1) / 2 + b] = DMat3::from_cols(
                    column(0) + DVec3::new(diagonal, 0.0, 0.0),
                    column(1) + DVec3::new(0.0, diagonal, 0.0),
                    column(2) + DVec3::new(0.0, 0.0, diagonal),
                );
            }
        }
        if response.trace_stiffness != 0.0 || response.full_stiffness != 0.0 {
            self.add_material_stiffness(deformation, response, &spatial, &mut stiffness);
        }
        Tangent {
            stiffness,
            volume_slope: spatial.map(|g| g * (volume_ratio * self.volume_mm3)),
        }
    }

    /// Adds `V/2 δ_aC̄ : (a 1⊗1 + b 𝕀) : δ_bC̄`.
    fn add_material_stiffness(
        &self,
        deformation: &Deformation,
        response: &Response,
        spatial: &[DVec3; 4],
        stiffness: &mut [DMat3; 10],
    ) {
        let gradient = deformation.gradient;
        let factor = deformation.isochoric_factor();
        let right_cauchy_green = gradient.transpose() * gradient;
        // δC̄ of each corner's motion along x, y and z.
        let mut variations = [[DMat3::ZERO; 3]; 4];
        for a in 0..4 {
            for i in 0..3 {
                let (row, g) = (gradient.row(i), self.gradients[a]);
                let sum = outer(row, g) + outer(g, row) - right_cauchy_green * (spatial[a][i] * 2.0 / 3.0);
                variations[a][i] = sum * factor;
            }
        }
        let traces = variations.map(|corner| corner.map(|m| m.x_axis.x + m.y_axis.y + m.z_axis.z));
        for a in 0..4 {
            for b in 0..=a {
                let block = &mut stiffness[a * (a + 1) / 2 + b];
                for i in 0..3 {
                    for j in 0..3 {
                        let mut value = response.trace_stiffness * traces[a][i] * traces[b][j];
                        if response.full_stiffness != 0.0 {
                            let product = crate::material::contract(&variations[a][i], &variations[b][j]);
                            value += response.full_stiffness * product;
                        }
                        block.col_mut(j)[i] += 0.5 * self.volume_mm3 * value;
                    }
                }
            }
        }
    }
}

impl Deformation {
    #[inline]
    pub(crate) fn new(gradient: DMat3) -> Self {
        let DMat3 {
            x_axis: x,
            y_axis: y,
            z_axis: z,
        } = gradient;
        let cofactor = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
        Self {
            gradient,
            cofactor,
            volume_ratio: x.dot(cofactor.x_axis),
        }
    }

    /// `J^(-2/3)`
    #[inline]
    pub(crate) fn isochoric_factor(&self) -> f64 {
        1.0 / self.volume_ratio.cbrt().powi(2)
    }

    /// `C̄ = J^(-2/3) FᵀF`
    #[inline]
    pub(crate) fn isochoric_right_cauchy_green(&self) -> DMat3 {
        self.gradient.transpose() * self.gradient * self.isochoric_factor()
    }

    /// `P = J^(-2/3) (F S̄ - q/3 F⁻ᵀ) - p J F⁻ᵀ`
    #[inline]
    pub(crate) fn first_piola_kirchhoff(&self, response: &Response, pressure: f64) -> DMat3 {
        let pushed = self.gradient * response.stress;
        let q = crate::material::contract(&pushed, &self.gradient);
        let isochoric = self.isochoric_factor();
        pushed * isochoric - self.cofactor * (isochoric * q / (3.0 * self.volume_ratio) + pressure)
    }

    /// Deviator of the Cauchy stress, `J^(-5/3) dev(F S̄ Fᵀ)`.
    pub(crate) fn cauchy_deviator(&self, response: &Response) -> DMat3 {
        let kirchhoff = self.gradient * response.stress * self.gradient.transpose();
        let mean = (kirchhoff.x_axis.x + kirchhoff.y_axis.y + kirchhoff.z_axis.z) / 3.0;
        (kirchhoff - DMat3::from_diagonal(DVec3::splat(mean))) * (self.isochoric_factor() / self.volume_ratio)
    }
}

#[inline]
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

#[cfg(test)]
mod tests;
