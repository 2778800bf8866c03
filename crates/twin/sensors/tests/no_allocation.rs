//! Steps do not allocate memory.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use digitac::Variant;
use glam::{DQuat, DVec3};
use twintac_fast::{Body, FastGel, Friction, Touch};
use twintac_sensor::SensorFile;
use twintac_sensors::{Coupling, HeldTouch, SensorBatch, SensorVariation, TouchId};
use twintac_shape::{Pose, Shape, Surfaces};

#[path = "../examples/rate/counting.rs"]
mod counting;
#[path = "../../digitac/examples/step_rate/invented.rs"]
#[allow(dead_code)] // the benchmark alone needs some of it
mod invented;

const N_TAXELS: usize = 8;
const N_SENSORS: usize = 100;

fn variation() -> SensorVariation {
    SensorVariation {
        gain_deviation: 0.05,
        drift_deviation_kpa_per_k: 0.05,
        temperature_deviation_k: 2.0,
        temperature_time_s: 60.0,
        noise_deviation_kpa: 0.05,
        hysteresis: 0.03,
        late_chance: 0.05,
        rate_hz: 60.0,
        jitter: 0.1,
        place_deviation_mm: 0.3,
        turn_deviation_rad: 0.01,
        tilt_deviation_rad: 0.01,
        ..SensorVariation::default()
    }
}

/// A ball and a box on each sensor.
fn touches(step: usize) -> Vec<Touch> {
    let touch = |number: usize| Touch {
        body: (number % 2) as u32,
        gel_from_body: Pose {
            position_mm: DVec3::new((0.1 * (number + step) as f64).sin() * 10.0, 2.0, 7.5),
            rotation: DQuat::from_rotation_y(0.01 * step as f64),
        },
    };
    (0..2 * N_SENSORS).map(touch).collect()
}

/// This is one test, because the allocations of another test that runs at the same time would be
/// counted too.
#[test]
fn steps_allocate_nothing() {
    let cube = Shape::Box {
        size_mm: [8.0; 3],
        edge_radius_mm: 0.5,
    };
    let shapes = [Shape::Sphere { radius_mm: 6.0 }, cube];
    let bodies = shapes.map(|shape| Body::new(&shape, &Surfaces::new()).unwrap());
    let gel = FastGel::phystac().unwrap();
    let twin = invented::twin(Variant::PressureMemory, N_TAXELS).unwrap();
    let ends: Vec<usize> = (1..=N_SENSORS).map(|sensor| 2 * sensor).collect();
    let steps: Vec<Vec<Touch>> = (0..50).map(touches).collect();
    let (mut readings_kpa, mut wrench) = (vec![0.0; N_SENSORS * N_TAXELS], vec![[0.0; 6]; N_SENSORS]);

    let mut counted = |n_threads: usize| {
        let sizes = [N_SENSORS, n_threads];
        let mut batch = SensorBatch::new(&gel, Some(&twin), variation(), sizes, 1);
        let mut step = |touches: &[Touch]| {
            batch.step(0.01, &bodies, touches, &ends, &mut readings_kpa, &mut wrench);
        };
        steps[..5].iter().for_each(|touches| step(touches));
        let before = counting::n_allocations();
        steps[5..].iter().for_each(|touches| step(touches));
        counting::n_allocations() - before
    };
    for n_threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .build()
            .unwrap();
        let fewest = pool.install(|| counting::fewest_of_runs(|| counted(n_threads)));
        assert_eq!(fewest, 0, "{n_threads} threads");
    }
    let coupling = Coupling {
        friction: Friction::on(&SensorFile::phystac().unwrap().sensor, 0.8),
        retardation_s: 0.005,
    };
    let held = |touches: &Vec<Touch>| -> Vec<HeldTouch> {
        let things = touches.iter().zip((0..).map(TouchId));
        things
            .map(|(touch, id)| HeldTouch { id, touch: *touch })
            .collect()
    };
    let held_steps: Vec<Vec<HeldTouch>> = steps.iter().map(held).collect();
    let counted_holding = || {
        let batch = SensorBatch::new(&gel, Some(&twin), variation(), [N_SENSORS, 1], 1);
        let mut batch = batch.with_coupling(coupling.clone()).unwrap();
        let (mut readings_kpa, mut wrench) = (vec![0.0; N_SENSORS * N_TAXELS], vec![[0.0; 6]; N_SENSORS]);
        let mut step = |touches: &[HeldTouch]| {
            let step = batch.step(0.01, &bodies, touches, &ends, &mut readings_kpa, &mut wrench);
            step.unwrap();
        };
        held_steps[..5].iter().for_each(|touches| step(touches));
        let before = counting::n_allocations();
        held_steps[5..].iter().for_each(|touches| step(touches));
        counting::n_allocations() - before
    };
    assert_eq!(counting::fewest_of_runs(counted_holding), 0, "gels that hold");
    // Work from a thread outside the pool goes through the pool's queue, which allocates memory for
    // some 60 entries at once.
    assert!(counting::fewest_of_runs(|| counted(2)) <= 2);

    let mut reader = gel.reader();
    let before = counting::n_allocations();
    for touches in &steps {
        let there = [
            (&bodies[0], touches[0].gel_from_body),
            (&bodies[1], touches[1].gel_from_body),
        ];
        reader.read(&there, &mut readings_kpa[..N_TAXELS], &mut wrench[0]);
    }
    assert_eq!(counting::n_allocations() - before, 0);
    assert!(before > 0, "nothing was counted");
}
