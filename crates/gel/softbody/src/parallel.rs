//! Runs code with the vector instructions of the processor, and two halves of a piece of work at
//! the same time.
//!
//! The division into halves does not depend on the number of threads, and neither do the sums:
//! every number of threads gives the same bits. The same is true for the vector instructions,
//! because all arithmetic is written out.

#[cfg(target_arch = "wasm32")]
pub(crate) use one_thread::{join_halves, on_two_threads};
#[cfg(not(target_arch = "wasm32"))]
pub(crate) use two_threads::{join_halves, on_two_threads};

/// Runs a kernel with the widest vectors of the processor. It is not inlined, so that each kernel
/// is compiled once for each kind of vectors.
#[cfg(not(target_arch = "wasm32"))]
#[inline(never)]
pub(crate) fn dispatch<K: pulp::NullaryFnOnce>(kernel: K) -> K::Output {
    pulp::Arch::new().dispatch(kernel)
}

/// WebAssembly has one kind of vectors, for which everything is compiled.
#[cfg(target_arch = "wasm32")]
#[inline(never)]
pub(crate) fn dispatch<K: pulp::NullaryFnOnce>(kernel: K) -> K::Output {
    kernel.call()
}

#[cfg(not(target_arch = "wasm32"))]
mod two_threads {
    use std::cell::Cell;
    use std::sync::atomic::{AtomicBool, Ordering};

    /// Number of spins of the helper between two searches for work, about a microsecond: searching
    /// for work slows the other thread down.
    const SPINS: u32 = 32;

    thread_local! {
        static MAY_SPLIT: Cell<bool> = const { Cell::new(false) };
    }

    /// Does both, inside of [`on_two_threads`] at the same time.
    pub(crate) fn join_halves<A: Send, B: Send>(
        a: impl FnOnce() -> A + Send,
        b: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        if MAY_SPLIT.get() {
            rayon::join(a, b)
        } else {
            (a(), b())
        }
    }

    /// Runs a piece of work whose halves may run at the same time. The halves are not divided
    /// further.
    pub(crate) fn on_two_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
        let is_done = AtomicBool::new(false);
        let (result, ()) = rayon::join(
            || {
                let _guard = Splitting::new(&is_done);
                work()
            },
            // The halves take a fraction of a millisecond: a helper that sleeps between them would
            // wake up too late.
            || {
                while !is_done.load(Ordering::Relaxed) {
                    rayon::yield_now();
                    for _ in 0..SPINS {
                        std::hint::spin_loop();
                    }
                }
            },
        );
        result
    }

    /// As long as this exists, its thread may divide its work. When it is dropped, even in a panic,
    /// the helper ends.
    struct Splitting<'a> {
        is_done: &'a AtomicBool,
        before: bool,
    }

    impl<'a> Splitting<'a> {
        fn new(is_done: &'a AtomicBool) -> Self {
            Self {
                is_done,
                before: MAY_SPLIT.replace(true),
            }
        }
    }

    impl Drop for Splitting<'_> {
        fn drop(&mut self) {
            MAY_SPLIT.set(self.before);
            self.is_done.store(true, Ordering::Relaxed);
        }
    }
}

/// Without threads, one half runs after the other.
#[cfg(target_arch = "wasm32")]
mod one_thread {
    pub(crate) fn join_halves<A, B>(a: impl FnOnce() -> A, b: impl FnOnce() -> B) -> (A, B) {
        (a(), b())
    }

    pub(crate) fn on_two_threads<T>(work: impl FnOnce() -> T) -> T {
        work()
    }
}
