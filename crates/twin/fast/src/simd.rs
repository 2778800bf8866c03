//! Vectors of a few numbers, as long as the processor supports.

use pulp::{Simd, WithSimd};

/// Numbers in a vector of this processor. Rows are padded with zeros to whole vectors.
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

/// Runs code that is compiled for each instruction set, with the best one available. All give the
/// same bits.
pub(crate) fn dispatch<W: WithSimd>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    return match pulp::x86::V3::try_new() {
        Some(simd) => Simd::vectorize(simd, work),
        None => Simd::vectorize(pulp::Scalar::new(), work),
    };
    #[cfg(not(target_arch = "x86_64"))]
    pulp::Arch::new().dispatch(work)
}

/// Numbers as vectors; their number is a multiple of a vector's length.
#[inline(always)]
pub(crate) fn vectors<S: Simd>(numbers: &[f32]) -> &[S::f32s] {
    debug_assert!(numbers.len().is_multiple_of(S::F32_LANES));
    S::as_simd_f32s(numbers).0
}
