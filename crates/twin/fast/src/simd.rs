//! Vectors of a few numbers, as long as the processor has them.

use pulp::{Simd, WithSimd};

/// Numbers in a vector of this processor. Rows are filled up with zeros to whole vectors.
pub(crate) fn lanes() -> usize {
    dispatch(Lanes)
}

struct Lanes;

impl WithSimd for Lanes {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> usize {
        S::F32_LANES
    }
}

/// Runs what is compiled for each instruction set, with the best one that there is. All give the same bits.
pub(crate) fn dispatch<W: WithSimd>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    return match pulp::x86::V3::try_new() {
        Some(simd) => Simd::vectorize(simd, work),
        None => Simd::vectorize(pulp::Scalar::new(), work),
    };
    #[cfg(not(target_arch = "x86_64"))]
    pulp::Arch::new().dispatch(work)
}

/// Numbers as vectors, of which they are a whole number.
#[inline(always)]
pub(crate) fn vectors<S: Simd>(numbers: &[f32]) -> &[S::f32s] {
    debug_assert!(numbers.len().is_multiple_of(S::F32_LANES));
    S::as_simd_f32s(numbers).0
}
