//! Elementary functions as arithmetic without branches, so that the compiler can use vector
//! instructions. They give the same bits on every machine.

use super::plus_product::PlusProduct;

/// A number with a square root, a logarithm and an exponential.
pub trait Elementary: Sized {
    /// Square root.
    fn sqrt(self) -> Self;

    /// Natural logarithm of a number above zero, to round-off.
    fn ln(self) -> Self;

    /// `e^x`, to round-off; beyond the range of the number type, some large or small number.
    fn exp(self) -> Self;
}

/// `1 + z/3 + z²/5 + …`: `atanh(s)/s` at `s² = z`.
macro_rules! atanh_series {
    ($type:ty, $z:expr, $terms:expr) => {{
        let mut sum: $type = 0.0;
        let mut term = $terms;
        while term > 0 {
            term -= 1;
            sum = (1.0 / (2 * term + 1) as $type).plus_product(sum, $z);
        }
        sum
    }};
}

/// `1 + x + x²/2 + …`, by Horner's rule.
macro_rules! exp_series {
    ($type:ty, $x:expr, $terms:expr) => {{
        let mut sum: $type = 1.0;
        let mut term = $terms;
        while term > 0 {
            sum = <$type>::plus_product(1.0, sum * $x, 1.0 / term as $type);
            term -= 1;
        }
        sum
    }};
}

impl Elementary for f64 {
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        // `self = 2^exponent · m`, with the mantissa `m` between √½ and √2, and
        // `ln m = 2 atanh((m - 1)/(m + 1))`.
        let exponent = ((self.to_bits().wrapping_sub(0x3fe6_a09e_667f_3bcd) as i64) >> 52) as i32;
        let mantissa = Self::from_bits(self.to_bits().wrapping_sub((i64::from(exponent) << 52) as u64));
        let s = (mantissa - 1.0) / (mantissa + 1.0);
        let series = atanh_series!(Self, s * s, 11);
        (2.0 * s * series).plus_product(Self::from(exponent), std::f64::consts::LN_2)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        // The upper bits of ln 2, whose product with an integer below 2048 is exact, and the
        // remaining bits.
        const UPPER: f64 = 0.693_147_180_369_123_8;
        const LOWER: f64 = 1.908_214_929_270_587_7e-10;
        let x = self.clamp(-700.0, 700.0);
        let whole = (x * std::f64::consts::LOG2_E).round_ties_even();
        let rest = x.plus_product(-whole, UPPER).plus_product(-whole, LOWER);
        let power = Self::from_bits(((whole as i32 + 1023) as u64) << 52);
        exp_series!(Self, rest, 13) * power
    }
}

impl Elementary for f32 {
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        let exponent = (self.to_bits().wrapping_sub(0x3f35_04f3) as i32) >> 23;
        let mantissa = Self::from_bits(self.to_bits().wrapping_sub((exponent << 23) as u32));
        let s = (mantissa - 1.0) / (mantissa + 1.0);
        let series = atanh_series!(Self, s * s, 5);
        (2.0 * s * series).plus_product(exponent as Self, std::f32::consts::LN_2)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        const UPPER: f32 = 0.693_359_4;
        const LOWER: f32 = -2.121_944_4e-4;
        let x = self.clamp(-80.0, 80.0);
        let whole = (x * std::f32::consts::LOG2_E).round_ties_even();
        let rest = x.plus_product(-whole, UPPER).plus_product(-whole, LOWER);
        let power = Self::from_bits(((whole as i32 + 127) as u32) << 23);
        exp_series!(Self, rest, 7) * power
    }
}

#[cfg(test)]
mod tests {
    use super::Elementary;

    #[test]
    fn logarithm_and_exponential_are_right_to_round_off() {
        for i in -2000..=2000 {
            let x = 0.01 * f64::from(i);
            assert!(
                (Elementary::exp(x) / f64::exp(x) - 1.0).abs() < 5e-16 * (1.0 + x.abs()),
                "{x}"
            );
            let y = f64::exp(x);
            assert!(
                (Elementary::ln(y) - f64::ln(y)).abs() <= 4e-16 * f64::ln(y).abs(),
                "{y}"
            );
            let single = x as f32;
            let error = f64::from(Elementary::exp(single)) / f64::exp(f64::from(single)) - 1.0;
            assert!(error.abs() < 3e-7 * (1.0 + x.abs()), "{x}: {error}");
            let y = single.exp();
            let error = f64::from(Elementary::ln(y)) - f64::from(y).ln();
            assert!(error.abs() <= 3e-7 * f64::from(y).ln().abs(), "{y}: {error}");
        }
    }
}
