//! The sigmoid linear unit `x / (1 + e⁻ˣ)` (Elfwing, Uchibe and Doya, arXiv 1702.03118), a smooth
//! rectifier.

use pulp::{Arch, Simd, WithSimd};

/// Arguments of the exponential are limited to this size.
const LARGEST: f32 = 30.0;

/// Coefficients of the power series of eˣ, highest power first; used for |x| ≤ ln 2 / 2.
const SERIES: [f32; 6] = [1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0];

/// The unit's value. It consists of single additions and multiplications, so every processor gives
/// the same bits.
#[inline(always)]
pub(crate) fn silu(x: f32) -> f32 {
    x * sigmoid(x)
}

/// Replaces values by the unit's values.
pub(crate) fn apply(values: &mut [f32]) {
    struct Apply<'a>(&'a mut [f32]);

    impl WithSimd for Apply<'_> {
        type Output = ();

        #[inline(always)]
        fn with_simd<S: Simd>(self, _: S) {
            self.0.iter_mut().for_each(|value| *value = silu(*value));
        }
    }

    Arch::new().dispatch(Apply(values));
}

/// Multiplies gradients with respect to the unit's outputs by the unit's derivative at its inputs.
pub(crate) fn times_slope(slopes: &mut [f32], values: &[f32]) {
    struct Times<'a>(&'a mut [f32], &'a [f32]);

    impl WithSimd for Times<'_> {
        type Output = ();

        #[inline(always)]
        fn with_simd<S: Simd>(self, _: S) {
            let pairs = self.0.iter_mut().zip(self.1);
            pairs.for_each(|(slope, value)| *slope *= silu_slope(*value));
        }
    }

    Arch::new().dispatch(Times(slopes, values));
}

/// The unit's derivative.
#[inline(always)]
fn silu_slope(x: f32) -> f32 {
    let sigmoid = sigmoid(x);
    sigmoid * (1.0 + x * (1.0 - sigmoid))
}

#[inline(always)]
fn sigmoid(x: f32) -> f32 {
    1.0 / (1.0 + exp(-x))
}

/// eˣ with a precision of six digits.
#[inline(always)]
fn exp(x: f32) -> f32 {
    /// After this is added to a number, the last bits of the sum are the nearest whole number.
    const ROUND: f32 = 12_582_912.0;
    /// The first bits of ln 2, so that a product with a whole number is exact.
    const LN_2_HIGH: f32 = 0.693_359_4;
    // Unlike `clamp`, these comparisons become one instruction for eight numbers.
    let x = if x < LARGEST { x } else { LARGEST };
    let x = if x > -LARGEST { x } else { -LARGEST };
    let shifted = x.mul_add(std::f32::consts::LOG2_E, ROUND);
    let whole = shifted - ROUND;
    let rest = whole.mul_add(-LN_2_HIGH, x);
    let rest = whole.mul_add(LN_2_HIGH - std::f32::consts::LN_2, rest);
    let mut series = SERIES[0];
    for term in &SERIES[1..] {
        series = series.mul_add(rest, *term);
    }
    let exponent = (shifted.to_bits() as i32).wrapping_sub(ROUND.to_bits() as i32);
    let power = f32::from_bits(((exponent + 127) << 23) as u32);
    series * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_unit_and_its_slope() {
        for step in -4000..4000 {
            let x = step as f32 * 0.01;
            let exact = f64::from(x) / (1.0 + (-f64::from(x)).exp());
            assert!(
                (f64::from(silu(x)) - exact).abs() < 2e-6 * (1.0 + exact.abs()),
                "{x}"
            );
            let difference = (silu(x + 0.01) - silu(x - 0.01)) / 0.02;
            assert!((silu_slope(x) - difference).abs() < 1e-3, "{x}");
        }
    }
}
