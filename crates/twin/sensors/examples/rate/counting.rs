//! The system's allocator, which counts the allocations of all threads.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

struct Counting;

static N_ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);
static N_BYTES: AtomicUsize = AtomicUsize::new(0);

/// Number of allocations so far.
#[allow(dead_code)] // only a test needs it
pub(crate) fn n_allocations() -> usize {
    N_ALLOCATIONS.load(Ordering::Relaxed)
}

/// The smallest count of several equal runs. A thread of a pool allocates memory for itself when it
/// first takes work from another thread, in any of the runs. Allocations of the run itself are in
/// all counts.
#[allow(dead_code)] // only a test needs it
pub(crate) fn fewest_of_runs(count: impl FnMut() -> usize) -> usize {
    std::iter::repeat_with(count).take(10).min().unwrap_or(usize::MAX)
}

/// Bytes that are in use.
#[allow(dead_code)] // only the benchmark needs it
pub(crate) fn n_bytes() -> usize {
    N_BYTES.load(Ordering::Relaxed)
}

#[global_allocator]
static COUNTING: Counting = Counting;

// SAFETY: all calls are passed on to the system's allocator.
#[allow(unsafe_code)] // an allocator requires it
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        N_ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        N_BYTES.fetch_add(layout.size(), Ordering::Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        N_BYTES.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(pointer, layout) }
    }
}
