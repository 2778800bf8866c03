//! Eight numbers side by side, for which the compiler uses the vector registers of the processor.

mod elementary;
mod plus_product;

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use elementary::Elementary;
pub use plus_product::PlusProduct;

/// Number of values side by side.
pub const LANES: usize = 8;

/// A number of single or double precision.
pub trait Real:
    Copy
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Elementary
    + PlusProduct
{
    /// A relative difference below round-off.
    const ROUND_OFF: Self;

    /// The nearest number of this type.
    fn from_f64(value: f64) -> Self;

    /// `x^(-1/3)` of a number above zero.
    fn inverse_cube_root(self) -> Self;
}

impl Real for f64 {
    const ROUND_OFF: Self = Self::EPSILON / 8.0;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn inverse_cube_root(self) -> Self {
        // 4/3 of the bias of the exponent minus a third of the number's bits has an error of about
        // 3 %; Halley's method does the rest.
        let mut root = Self::from_bits(0x553e_f0ff_289d_d796_u64.wrapping_sub(self.to_bits() / 3));
        for _ in 0..3 {
            let error = 1.0 - self * root * root * root;
            root *= 1.0 + error * (1.0 / 3.0 + error * (2.0 / 9.0));
        }
        root
    }
}

impl Real for f32 {
    const ROUND_OFF: Self = Self::EPSILON / 8.0;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value as Self
    }

    #[inline(always)]
    fn inverse_cube_root(self) -> Self {
        let mut root = Self::from_bits(0x54a2_1d2a_u32.wrapping_sub(self.to_bits() / 3));
        for _ in 0..2 {
            let error = 1.0 - self * root * root * root;
            root *= 1.0 + error * (1.0 / 3.0 + error * (2.0 / 9.0));
        }
        root
    }
}

/// Eight numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(32))]
pub struct Wide<T>(pub [T; LANES]);

impl<T: Real> Wide<T> {
    /// Eight times the same number.
    #[inline(always)]
    #[must_use]
    pub fn splat(value: f64) -> Self {
        Self([T::from_f64(value); LANES])
    }

    /// `self + a b`; see [`PlusProduct`].
    #[inline(always)]
    #[must_use]
    pub fn plus_product(mut self, a: Self, b: Self) -> Self {
        for lane in 0..LANES {
            self.0[lane] = self.0[lane].plus_product(a.0[lane], b.0[lane]);
        }
        self
    }

    /// Eight zeros.
    #[inline(always)]
    #[must_use]
    pub fn zero() -> Self {
        Self::splat(0.0)
    }

    /// `x^(-1/3)` of numbers above zero.
    #[inline(always)]
    #[must_use]
    pub fn inverse_cube_root(self) -> Self {
        let mut out = self;
        for lane in &mut out.0 {
            *lane = lane.inverse_cube_root();
        }
        out
    }

    /// Square roots.
    #[inline(always)]
    #[must_use]
    pub fn sqrt(self) -> Self {
        self.map(T::sqrt)
    }

    /// Natural logarithms of numbers above zero.
    #[inline(always)]
    #[must_use]
    pub fn ln(self) -> Self {
        self.map(T::ln)
    }

    /// `e^x`
    #[inline(always)]
    #[must_use]
    pub fn exp(self) -> Self {
        self.map(T::exp)
    }

    /// `(e^a - e^b)/(a - b)` from `a`, `b` and their exponentials. It is accurate for close values
    /// as well, where it is computed as `√(e^a e^b) sinh(z)/z` with `z = (a - b)/2`.
    #[inline(always)]
    #[must_use]
    pub fn exponential_quotient([a, b]: [Self; 2], [exp_a, exp_b]: [Self; 2]) -> Self {
        let difference = a - b;
        let square = difference * difference * Self::splat(0.25);
        let mut series = Self::splat(1.0);
        for term in [12.0, 10.0, 8.0, 6.0, 4.0, 2.0] {
            series = (series * square * Self::splat(1.0 / (term * (term + 1.0)))) + Self::splat(1.0);
        }
        let close = (exp_a * exp_b).sqrt() * series;
        let mut quotient = (exp_a - exp_b) / difference;
        for lane in 0..LANES {
            if square.0[lane] < T::from_f64(0.25) {
                quotient.0[lane] = close.0[lane];
            }
        }
        quotient
    }

    /// The function applied to each number.
    #[inline(always)]
    #[must_use]
    pub fn map(mut self, f: impl Fn(T) -> T) -> Self {
        for lane in &mut self.0 {
            *lane = f(*lane);
        }
        self
    }
}

impl Wide<f64> {
    /// The same numbers in another precision.
    #[inline(always)]
    #[must_use]
    pub fn cast<T: Real>(self) -> Wide<T> {
        let mut out = Wide([T::default(); LANES]);
        for (out, value) in out.0.iter_mut().zip(self.0) {
            *out = T::from_f64(value);
        }
        out
    }

    /// The smallest number, or NaN if one of them is NaN.
    #[inline(always)]
    #[must_use]
    pub fn least(self) -> f64 {
        self.0.into_iter().fold(f64::INFINITY, least)
    }

    /// Their sum.
    #[inline(always)]
    #[must_use]
    pub fn sum(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.0;
        ((a + b) + (c + d)) + ((e + f) + (g + h))
    }
}

/// The smaller of two numbers, or NaN if one of them is NaN.
#[inline(always)]
#[must_use]
pub fn least(a: f64, b: f64) -> f64 {
    if a.is_nan() || a < b { a } else { b }
}

macro_rules! lane_by_lane {
    ($trait:ident, $function:ident, $assign_trait:ident, $assign:ident, $op:tt) => {
        impl<T: Real> $trait for Wide<T> {
            type Output = Self;

            #[inline(always)]
            fn $function(mut self, other: Self) -> Self {
                for (a, b) in self.0.iter_mut().zip(other.0) {
                    *a = *a $op b;
                }
                self
            }
        }

        impl<T: Real> $assign_trait for Wide<T> {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                *self = *self $op other;
            }
        }
    };
}

lane_by_lane!(Add, add, AddAssign, add_assign, +);
lane_by_lane!(Sub, sub, SubAssign, sub_assign, -);
lane_by_lane!(Mul, mul, MulAssign, mul_assign, *);

impl<T: Real> Div for Wide<T> {
    type Output = Self;

    #[inline(always)]
    fn div(mut self, other: Self) -> Self {
        for (a, b) in self.0.iter_mut().zip(other.0) {
            *a = *a / b;
        }
        self
    }
}

impl<T: Real> Neg for Wide<T> {
    type Output = Self;

    #[inline(always)]
    fn neg(mut self) -> Self {
        for a in &mut self.0 {
            *a = -*a;
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_cube_root_is_exact() {
        for x in [0.001, 0.01, 0.3, 0.9, 1.0, 1.1, 2.0, 9.0, 400.0] {
            let found = Wide::<f64>::splat(x).inverse_cube_root().0[0];
            assert!((found * f64::cbrt(x) - 1.0).abs() < 1e-14, "{x}: {found}");
            let found = f64::from(Wide::<f32>::splat(x).inverse_cube_root().0[0]);
            assert!((found * f64::cbrt(x) - 1.0).abs() < 1e-6, "{x}: {found}");
        }
    }

    #[test]
    fn nan_is_never_lost() {
        let mut wide = Wide::<f64>::splat(1.0);
        wide.0[3] = f64::NAN;
        assert!(wide.least().is_nan());
    }
}
