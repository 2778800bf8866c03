//! A product added to a number.

/// A number to which a product is added.
pub trait PlusProduct: Sized {
    /// `self + a b`, rounded once where the processor has an instruction for that. WebAssembly has none: there it is rounded twice, as the routine that rounds
    /// once takes two thirds of a press.
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
