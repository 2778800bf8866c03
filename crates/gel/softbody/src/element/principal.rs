//! Principal axes of symmetric matrices, eight at a time.
//!
//! This is code of our own because eight matrices are rotated side by side in the vector registers
//! of the processor, inside of the kernels; a library such as faer decomposes one matrix at a time,
//! with other round-off.

use super::deformation::{Matrix, Vector};
use crate::wide::{LANES, Real, Wide};

/// Largest number of rounds of rotations, which no matrix reaches.
const MAX_ROUNDS: usize = 10;

/// Eigenvalues of symmetric matrices, and orthonormal eigenvectors in the same order, by the
/// rotations of Jacobi (1846). The vectors are orthonormal to round-off, also for equal
/// eigenvalues.
#[inline(always)]
pub(super) fn principal<T: Real>(matrix: &Matrix<T>) -> (Vector<T>, [Vector<T>; 3]) {
    let (zero, one) = (Wide::zero(), Wide::splat(1.0));
    let [[mut xx, mut xy, mut xz], [_, mut yy, mut yz], [_, _, mut zz]] = *matrix;
    let mut axes = [[one, zero, zero], [zero, one, zero], [zero, zero, one]];
    for _ in 0..MAX_ROUNDS {
        if is_diagonal([xx, yy, zz], [yz, xz, xy]) {
            break;
        }
        let [x, y, z] = &mut axes;
        rotate([&mut xx, &mut yy, &mut xy], [&mut xz, &mut yz], [x, y]);
        rotate([&mut xx, &mut zz, &mut xz], [&mut xy, &mut yz], [x, z]);
        rotate([&mut yy, &mut zz, &mut yz], [&mut xy, &mut xz], [y, z]);
    }
    ([xx, yy, zz], axes)
}

/// Whether the entries off the diagonal are below round-off.
#[inline(always)]
fn is_diagonal<T: Real>(diagonal: Vector<T>, [a, b, c]: Vector<T>) -> bool {
    let trace = diagonal[0] + diagonal[1] + diagonal[2];
    let off = a * a + b * b + c * c;
    (0..LANES).all(|lane| {
        let limit = trace.0[lane] * T::ROUND_OFF;
        off.0[lane] <= limit * limit
    })
}

/// Rotates the axes `p` and `q` so that `a_pq` vanishes.
#[inline(always)]
fn rotate<T: Real>(
    [pp, qq, pq]: [&mut Wide<T>; 3],
    [rp, rq]: [&mut Wide<T>; 2],
    [axis_p, axis_q]: [&mut Vector<T>; 2],
) {
    let difference = *qq - *pp;
    let twice = *pq + *pq;
    let root = (difference * difference + twice * twice).sqrt();
    // The tangent of the angle, at most 1; zero if there is nothing to rotate.
    let mut tangent = Wide::zero();
    for lane in 0..LANES {
        let (difference, twice, root) = (difference.0[lane], twice.0[lane], root.0[lane]);
        let zero = T::from_f64(0.0);
        let (size, signed) = if difference < zero {
            (-difference, -twice)
        } else {
            (difference, twice)
        };
        tangent.0[lane] = if root > zero { signed / (size + root) } else { zero };
    }
    let cosine = Wide::splat(1.0) / (Wide::splat(1.0) + tangent * tangent).sqrt();
    let sine = tangent * cosine;
    *pp -= tangent * *pq;
    *qq += tangent * *pq;
    *pq = Wide::zero();
    (*rp, *rq) = (cosine * *rp - sine * *rq, sine * *rp + cosine * *rq);
    for i in 0..3 {
        (axis_p[i], axis_q[i]) = (
            cosine * axis_p[i] - sine * axis_q[i],
            sine * axis_p[i] + cosine * axis_q[i],
        );
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::deformation::{dot, multiply, right_cauchy_green};
    use super::*;

    fn check<T: Real + Into<f64>>(entries: [f64; 9], tolerance: f64) -> Result<(), TestCaseError> {
        let mut f = [[Wide::<T>::zero(); 3]; 3];
        for (i, entry) in entries.into_iter().enumerate() {
            f[i / 3][i % 3] = Wide::splat(entry);
        }
        let c = right_cauchy_green(&f);
        let (values, axes) = principal(&c);
        let norm: f64 = values.iter().map(|value| value.0[0].into()).sum();
        for k in 0..3 {
            for l in 0..3 {
                let expected = f64::from(u8::from(k == l));
                prop_assert!((dot(&axes[k], &axes[l]).0[5].into() - expected).abs() < tolerance);
            }
            let mut scaled = axes;
            for l in 0..3 {
                scaled[l] = axes[l].map(|x| x * values[l]);
            }
            let mut columns = axes;
            for i in 0..3 {
                for l in 0..3 {
                    columns[i][l] = axes[l][i];
                }
            }
            let again = multiply(&columns, &scaled);
            for i in 0..3 {
                prop_assert!((again[i][k] - c[i][k]).0[7].into().abs() < tolerance * norm);
            }
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn axes_are_orthonormal_and_give_the_matrix_back(
            entries in prop::array::uniform9(-1.0..1.0_f64),
            size in prop::sample::select(vec![0.0, 1e-9, 1e-4, 1.0]),
        ) {
            let mut entries = entries.map(|entry| entry * size);
            for i in 0..3 {
                entries[4 * i] += 1.0;
            }
            check::<f64>(entries, 1e-14)?;
            check::<f32>(entries, 2e-6)?;
        }
    }
}
