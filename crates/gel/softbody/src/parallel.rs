//! Work with the vectors of the processor, and two halves of a piece of work at the same time.
//!
//! What belongs to which half does not depend on the number of threads, nor do the sums: any number of threads gives the same bits. The same
//! holds for the vectors, as all arithmetic is written out.

#[cfg(target_arch = "wasm32")]
pub(crate) use one_thread::{join_halves, on_two_threads};
#[cfg(not(target_arch = "wasm32"))]
pub(crate) use two_threads::{join_halves, on_two_threads};

/// Runs a kernel with the widest vectors that the processor has. Not inlined: each kernel is compiled once for each kind of vectors.
#[cfg(not(target_arch = "wasm32"))]
#[inline(never)]
pub(crate) fn dispatch<K: pulp::NullaryFnOnce>(kernel: K) -> K::Output {
    pulp::Arch::new().dispatch(kernel)
}

/// WebAssembly has one kind of vectors, which all of it is compiled for.
#[cfg(target_arch = "wasm32")]
#[inline(never)]
pub(crate) fn dispatch<K: pulp::NullaryFnOnce>(kernel: K) -> K::Output {
    kernel.call()
}

#[cfg(not(target_arch = "wasm32"))]
mod two_threads {
    use std::cell::Cell;
    use std::sync::atomic::{AtomicBool, Ordering};

    /// Spins of the helper between two looks for work, about a microsecond: looking for work slows the other thread.
    const SPINS: u32 = 32;

    thread_local! {
        static MAY_SPLIT: Cell<bool> = const { Cell::new(false) };
    }

    /// Does both, at the same time inside [`on_two_threads`].
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

    /// Runs a piece of work whose halves may run at the same time. They do not split further.
    pub(crate) fn on_two_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
        let is_done = AtomicBool::new(false);
        let (result, ()) = rayon::join(
            || {
                let _guard = Splitting::new(&is_done);
                work()
            },
            // Halves take a fraction of a millisecond: a helper that sleeps between them would wake too late.
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

    /// While this lives, its thread may split its work. When it is dropped, even in a panic, the helper ends.
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

/// Where there are no threads, one half after the other.
#[cfg(target_arch = "wasm32")]
mod one_thread {
    pub(crate) fn join_halves<A, B>(a: impl FnOnce() -> A, b: impl FnOnce() -> B) -> (A, B) {
        (a(), b())
    }

    pub(crate) fn on_two_threads<T>(work: impl FnOnce() -> T) -> T {
        work()
    }
}
