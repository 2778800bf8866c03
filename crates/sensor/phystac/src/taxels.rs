//! Sets of taxels.

/// A set of up to 64 taxels, by index.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Taxels(u64);

impl Taxels {
    pub(crate) const NONE: Self = Self(0);

    pub(crate) const fn contains(self, taxel: usize) -> bool {
        self.0 >> taxel & 1 == 1
    }

    pub(crate) const fn insert(&mut self, taxel: usize) {
        self.0 |= 1 << taxel;
    }

    pub(crate) const fn remove(&mut self, taxel: usize) {
        self.0 &= !(1 << taxel);
    }
}
