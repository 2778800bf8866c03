//! Multiplication and addition in one operation.

/// A number to which a product can be added.
pub trait PlusProduct: Sized {
    /// `self + a b`, rounded once if the processor has an instruction for that. WebAssembly has
    /// none: there it is rounded twice, because the routine that rounds once takes two thirds of
    /// the time of a press.
    #[must_use]
    fn plus_product(self, a: Self, b: Self) -> Self;
}

macro_rules! plus_product {
    ($type:ty) => {
        impl PlusProduct for $type {
            #[inline(always)]
            fn plus_product(self, a: Self, b: Self) -> Self {
                if cfg!(target_arch = "wasm32") {
                    self + a * b
                } else {
                    a.mul_add(b, self)
                }
            }
        }
    };
}

plus_product!(f32);
plus_product!(f64);
