//! The material's law at the points of a pack.
//!
//! Only this module is compiled once for each law. The kernels around it are compiled once, and
//! branch on the properties of the law.

use pulp::NullaryFnOnce;
use twintac_material::{
    Curvatures, Invariants, Law, LawProperties, Model, Slopes, StretchLaw, StretchSlopes, Visitor,
};

use super::deformation::{Deformation, Matrix, Vector};
use super::spectral::Principal;
use super::table::{MAX_POINTS, NODES, Table};
use crate::parallel::dispatch;
use crate::wide::{Real, Wide};

/// The arguments of a law, at eight points.
#[derive(Clone, Copy)]
pub(super) struct Arguments<T> {
    pub(super) invariants: Invariants<T>,
    /// Logarithms of the isochoric principal stretches; set only for a law that uses them.
    isochoric_logarithms: Vector<T>,
}

/// The energy of a law and its first derivatives, kPa.
#[derive(Clone, Copy)]
pub(super) struct FirstDerivatives {
    pub(super) energy: Wide<f64>,
    pub(super) slopes: Slopes<f64>,
    /// Energy of the part in the principal stretches.
    pub(super) stretch_energy: Wide<f64>,
    pub(super) stretch_slopes: Vector<f64>,
}

/// The first and second derivatives of a law, kPa.
#[derive(Clone, Copy)]
pub(super) struct SecondDerivatives {
    pub(super) slopes: Slopes<f32>,
    pub(super) curvatures: Curvatures<f32>,
    /// Derivatives of the part in the principal stretches.
    pub(super) stretches: StretchSlopes<f32>,
}

/// Derivatives of a law, in some precision.
pub(super) trait Derivatives: Copy {
    type Precision: Real;

    /// The derivatives of an energy that is zero.
    fn none() -> Self;

    /// Sets the derivatives of a law. Without a part in the stretches, the derivatives of that part
    /// stay as they are, which is zero.
    fn set<L: Law>(&mut self, law: &L, at: &Arguments<Self::Precision>);
}

impl Derivatives for FirstDerivatives {
    type Precision = f64;

    fn none() -> Self {
        Self {
            energy: Wide::zero(),
            slopes: Slopes::none(),
            stretch_energy: Wide::zero(),
            stretch_slopes: [Wide::zero(); 3],
        }
    }

    #[inline(always)]
    fn set<L: Law>(&mut self, law: &L, at: &Arguments<f64>) {
        self.energy = law.energy(&at.invariants);
        self.slopes = law.slopes(&at.invariants);
        if let Some(stretches) = law.stretches() {
            (self.stretch_energy, self.stretch_slopes) =
                stretches.energy_and_slopes(&at.isochoric_logarithms);
        }
    }
}

impl Derivatives for SecondDerivatives {
    type Precision = f32;

    fn none() -> Self {
        let zero = [Wide::zero(); 3];
        Self {
            slopes: Slopes::none(),
            curvatures: Curvatures::none(),
            stretches: StretchSlopes {
                slopes: zero,
                own: zero,
                between: zero,
            },
        }
    }

    #[inline(always)]
    fn set<L: Law>(&mut self, law: &L, at: &Arguments<f32>) {
        self.slopes = law.slopes(&at.invariants);
        self.curvatures = law.curvatures(&at.invariants);
        if let Some(stretches) = law.stretches() {
            self.stretches = stretches.derivatives(&at.isochoric_logarithms);
        }
    }
}

/// The points of a pack: their deformation, and the derivatives of the law. Scratch memory of a
/// kernel, filled pack by pack.
pub(super) struct Points<D: Derivatives> {
    pub(super) deformations: [Deformation<D::Precision>; MAX_POINTS],
    pub(super) arguments: [Arguments<D::Precision>; MAX_POINTS],
    /// Set only for a law that uses stretches.
    pub(super) principal: [Principal<D::Precision>; MAX_POINTS],
    pub(super) law: [D; MAX_POINTS],
}

impl<D: Derivatives> Points<D> {
    pub(super) fn new() -> Self {
        let zero = Wide::zero();
        let matrix = [[zero; 3]; 3];
        Self {
            deformations: [Deformation {
                gradient: matrix,
                cofactor: matrix,
                volume_ratio: zero,
            }; MAX_POINTS],
            arguments: [Arguments {
                invariants: Invariants {
                    first: zero,
                    second: zero,
                    volume_ratio: zero,
                    isochoric: zero,
                },
                isochoric_logarithms: [zero; 3],
            }; MAX_POINTS],
            principal: [Principal::zero(); MAX_POINTS],
            law: [D::none(); MAX_POINTS],
        }
    }

    /// Evaluates the points of a pack with this table, from the displacements of its ten nodes and
    /// the gradients of its coordinates.
    #[inline(always)]
    pub(super) fn evaluate(
        &mut self,
        model: &Model,
        properties: LawProperties,
        table: &Table,
        ten: &[Vector<D::Precision>; NODES],
        gradients: &Matrix<D::Precision>,
    ) {
        for (index, point) in table.points.iter().enumerate() {
            let deformation = Deformation::new(ten, point, gradients);
            let arguments = &mut self.arguments[index];
            arguments.invariants = deformation.invariants(properties.uses_second);
            if properties.uses_stretches {
                let principal = Principal::new(&deformation.gradient);
                arguments.isochoric_logarithms = principal.isochoric_logarithms;
                self.principal[index] = principal;
            }
            self.deformations[index] = deformation;
        }
        let n_points = table.points.len();
        evaluate(model, &self.arguments[..n_points], &mut self.law[..n_points]);
    }
}

/// Evaluates a law with the vector instructions of the processor. It is not inlined, so that it is
/// compiled once for all callers.
#[inline(never)]
fn evaluate<D: Derivatives>(model: &Model, at: &[Arguments<D::Precision>], found: &mut [D]) {
    model.visit(Evaluation { at, found });
}

struct Evaluation<'a, D: Derivatives> {
    at: &'a [Arguments<D::Precision>],
    found: &'a mut [D],
}

impl<D: Derivatives> Visitor for Evaluation<'_, D> {
    type Output = ();

    fn visit<L: Law>(self, law: L) {
        dispatch(EvaluationOf(self, law));
    }
}

struct EvaluationOf<'a, D: Derivatives, L>(Evaluation<'a, D>, L);

impl<D: Derivatives, L: Law> NullaryFnOnce for EvaluationOf<'_, D, L> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(Evaluation { at, found }, law) = self;
        for (at, found) in at.iter().zip(found) {
            found.set(&law, at);
        }
    }
}
