//! Steps allocate no memory.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
#![allow(unsafe_code)] // an allocator cannot be written without

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use digitac::{BenchEstimate, TwinAtPlace, Variant};
use serde_json::json;
use twintac_depth_table::{DepthTable, PressFrame, SolveQuality};
use twintac_shape::Pose;

#[path = "../examples/step_rate/invented.rs"]
#[allow(dead_code)] // items that only the benchmark uses
mod invented;

/// The system's allocator with a counter.
struct Counting;

thread_local! {
    static N_ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    N_ALLOCATIONS.set(N_ALLOCATIONS.get() + 1);
}

// SAFETY: every call is forwarded to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller guarantees the conditions.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller guarantees the conditions.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: the caller guarantees the conditions.
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

#[test]
fn steps_at_a_place_allocate_nothing() {
    let n_taxels = 5;
    let frame = |number: i32| {
        let depth_mm = 0.2 * f64::from(number);
        PressFrame {
            depth_mm,
            force_n: depth_mm.powf(1.5),
            port_pressure_kpa: vec![10.0 * depth_mm; n_taxels],
            port_slope_kpa_per_mm: vec![[depth_mm; 3]; n_taxels],
            stress_feature_kpa_per_mm: vec![depth_mm; n_taxels],
            quality: SolveQuality {
                iterations: 1,
                residual: 0.0,
                penetration_mm: 0.0,
                smallest_volume_ratio: 1.0,
                wall_time_s: 0.0,
            },
        }
    };
    let table = DepthTable {
        indenter: "invented".to_owned(),
        gel_from_indenter_at_touch: Pose::IDENTITY,
        n_nodes: 1,
        frames: (0..6).map(frame).collect(),
        failure: None,
    };
    let bench: BenchEstimate = serde_json::from_value(json!({
        "tip_radius_mm": null,
        "contact_offset_mm": {},
        "contact_offset_elsewhere_mm": 0.02,
        "stiffness": null,
        "ports": vec![json!({ "shift_mm": [0.1, 0.2], "wider_mm": 0.1 }); n_taxels],
        "smooth_factor": {
            "ports_mm": vec![[1.0, 2.0]; n_taxels],
            "reach_mm": 5.0,
            "depth_mm": 1.0,
            "coefficients": vec![0.01; 21],
        },
        "gains": null,
        "deviation_percent": 0.0,
        "doubts": [],
    }))
    .unwrap();
    for variant in Variant::ALL {
        let twin = invented::twin(variant, n_taxels).unwrap();
        let mut at_place = TwinAtPlace::new(&twin, &table, &bench, "invented").unwrap();
        let mut readings_kpa = vec![0.0; n_taxels];
        let before = N_ALLOCATIONS.get();
        for number in 0..30 {
            at_place.step(0.01, 0.03 * f64::from(number), &mut readings_kpa);
        }
        assert_eq!(N_ALLOCATIONS.get() - before, 0, "{variant}");
        assert!(readings_kpa[0] != 0.0, "{variant}");
    }
}
