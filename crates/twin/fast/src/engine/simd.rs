//! Vectors of a few numbers, as long as the processor has them.

use pulp::{Simd, WithSimd};

/// Rows are filled up with zeros to whole numbers of so many: no vector that is used is longer.
pub(crate) const LANES: usize = 8;

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

/// Numbers as vectors. They are whole numbers of [`LANES`].
#[inline(always)]
pub(crate) fn vectors<S: Simd>(numbers: &[f32]) -> &[S::f32s] {
    debug_assert!(numbers.len().is_multiple_of(LANES) && S::F32_LANES <= LANES);
    S::as_simd_f32s(numbers).0
}
