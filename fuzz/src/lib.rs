//! The common part of all libFuzzer targets: the call of the check, and an allocator that aborts on
//! allocations that no wire or file may cause.
//!
//! The checks are in `crates/app/fuzz`. libFuzzer limits the memory of the whole process, but it
//! sees single allocations only with a sanitizer, which stable compilers lack.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

#[doc(hidden)]
pub use libfuzzer_sys;
#[doc(hidden)]
pub use twintac_fuzz::run;

/// Most bytes of one allocation, and of all live allocations together. The largest input has 16
/// KiB.
const LARGEST: usize = 16 << 20;
const MOST: usize = 64 << 20;

/// Defines the fuzz target of this name.
#[macro_export]
macro_rules! fuzz {
    ($name:literal) => {
        $crate::libfuzzer_sys::fuzz_target!(|bytes: &[u8]| $crate::run($name, bytes));
    };
}

struct Bounded;

#[global_allocator]
static ALLOCATOR: Bounded = Bounded;
static LIVE: AtomicUsize = AtomicUsize::new(0);

impl Bounded {
    fn take(size: usize) {
        let live = LIVE.fetch_add(size, Ordering::Relaxed) + size;
        if size > LARGEST || live > MOST {
            // Abort without allocating: libFuzzer keeps the input of a process that aborts.
            std::process::abort();
        }
    }
}

// SAFETY: every call is passed on to the system's allocator.
unsafe impl GlobalAlloc for Bounded {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Self::take(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(place, layout) }
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        Self::take(size);
        unsafe { System.realloc(place, layout, size) }
    }
}
