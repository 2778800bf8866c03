//! Steps allocate nothing.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
#![allow(unsafe_code)] // an allocator cannot be written without

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use digitac::Variant;

#[path = "../examples/step_rate/invented.rs"]
#[allow(dead_code)] // what the benchmark alone needs
mod invented;

/// The system's allocator, which counts.
struct Counting;

thread_local! {
    static N_ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    N_ALLOCATIONS.set(N_ALLOCATIONS.get() + 1);
}

// SAFETY: everything is passed on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: as the caller promises.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

#[test]
fn steps_allocate_nothing() {
    let n_taxels = 5;
    for variant in Variant::ALL {
        let twin = invented::twin(variant, n_taxels).unwrap();
        for n_sensors in [1, 64, 1000] {
            let seen = vec![3.0; n_sensors * n_taxels];
            let mut readings_kpa = vec![0.0; seen.len()];
            let mut state = twin.states(n_sensors);
            state.step(0.01, &seen, &mut readings_kpa);
            for mut state in [twin.states(n_sensors), state.clone()] {
                let before = N_ALLOCATIONS.get();
                for _ in 0..20 {
                    state.step(0.01, &seen, &mut readings_kpa);
                    state.tare();
                    state.rest(n_sensors - 1);
                }
                let n_allocations = N_ALLOCATIONS.get() - before;
                assert_eq!(n_allocations, 0, "{variant}, {n_sensors} sensors");
            }
        }
    }
    assert!(N_ALLOCATIONS.get() > 0, "nothing was counted");
}
