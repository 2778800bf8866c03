//! Friction, loss and several bodies at once, for bodies that move freely.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use glam::DVec3;
use twintac_fast::{Body, FastGel, Friction, Touch};
use twintac_sensor::SensorFile;
use twintac_sensors::{
    CoupledBatch, Coupling, HeldTouch, SensorBatch, SensorVariation, TouchId, TouchedTwice,
};
use twintac_shape::{Pose, Shape, Surfaces};

const TOP_MM: f64 = 8.5;

fn balls() -> Vec<Body> {
    let ball = |radius_mm: f64| Body::new(&Shape::Sphere { radius_mm }, &Surfaces::new()).unwrap();
    vec![ball(12.5), ball(6.0)]
}

fn sensors(n: usize, n_threads: usize, retardation_s: f64) -> CoupledBatch {
    imperfect(SensorVariation::default(), [n, n_threads], retardation_s)
}

fn imperfect(variation: SensorVariation, sizes: [usize; 2], retardation_s: f64) -> CoupledBatch {
    let sensor = SensorFile::phystac().unwrap().sensor;
    let coupling = Coupling {
        friction: Friction::on(&sensor, 0.8),
        retardation_s,
    };
    let gel = FastGel::phystac().unwrap();
    SensorBatch::new(&gel, None, variation, sizes, 1)
        .with_coupling(coupling)
        .unwrap()
}

/// A thing that is the only one of its shape.
fn at(body: u32, x_mm: f64, y_mm: f64, depth_mm: f64) -> HeldTouch {
    thing(u64::from(body), body, [x_mm, y_mm, depth_mm])
}

fn thing(id: u64, body: u32, [x_mm, y_mm, depth_mm]: [f64; 3]) -> HeldTouch {
    HeldTouch {
        id: TouchId(id),
        touch: Touch {
            body,
            gel_from_body: Pose::from_position(DVec3::new(x_mm, y_mm, TOP_MM - depth_mm)),
        },
    }
}

/// Readings and the wrench of one sensor.
fn step(batch: &mut CoupledBatch, touches: &[HeldTouch]) -> ([f32; 8], [f32; 6]) {
    try_step(batch, touches).unwrap()
}

fn try_step(batch: &mut CoupledBatch, touches: &[HeldTouch]) -> Result<([f32; 8], [f32; 6]), TouchedTwice> {
    let (mut readings_kpa, mut wrench) = ([0.0; 8], [[0.0; 6]]);
    let ends = [touches.len()];
    batch.step(0.01, &balls(), touches, &ends, &mut readings_kpa, &mut wrench)?;
    Ok((readings_kpa, wrench[0]))
}

#[test]
fn a_pulled_body_is_held_and_felt() {
    let mut batch = sensors(1, 1, 0.0);
    let (pressed_kpa, pressed) = step(&mut batch, &[at(0, 0.0, 0.0, 1.0)]);
    let (pulled_kpa, pulled) = step(&mut batch, &[at(0, 0.5, 0.0, 1.0)]);
    assert!(
        pressed[0].abs() < 0.02 && pulled[0] > 0.1,
        "{pressed:?} {pulled:?}"
    );
    // Taxels 1 and 5 are behind the ball, 2 and 6 ahead. The ball itself moves by a sixteenth of
    // their distance.
    let mut without = FastGel::phystac().unwrap().reader();
    let mut moved_kpa = [0.0; 8];
    let ball = &balls()[0];
    without.read(
        &[(ball, at(0, 0.5, 0.0, 1.0).touch.gel_from_body)],
        &mut moved_kpa,
        &mut [0.0; 6],
    );
    assert!(pulled_kpa[2] > moved_kpa[2] + 0.2 && pulled_kpa[1] < moved_kpa[1] - 0.2);
    assert!((pressed_kpa[2] - pressed_kpa[1]).abs() < 0.1);
}

#[test]
fn the_slip_of_a_body_is_the_motion_that_friction_does_not_hold() {
    let mut batch = sensors(1, 1, 0.0);
    let slip = |batch: &CoupledBatch| batch.slip_of_touches().next().copied().unwrap();
    step(&mut batch, &[at(0, 0.0, 0.0, 1.0)]);
    step(&mut batch, &[at(0, 0.01, 0.0, 1.0)]);
    assert_eq!(slip(&batch), [0.0; 2], "it sticks");
    for moment in 1..=60 {
        step(&mut batch, &[at(0, 0.01 + 0.05 * f64::from(moment), 0.0, 1.0)]);
    }
    // 0.05 mm in 0.01 s. The force changes a little from location to location.
    let [along, across] = slip(&batch);
    assert!(
        (along - 5.0).abs() < 0.25 && across.abs() < 0.25,
        "{along} {across}"
    );
    step(&mut batch, &[at(0, 3.01, 0.0, -1.0)]);
    assert_eq!(slip(&batch), [0.0; 2], "nothing touches");
}

#[test]
fn several_bodies_share_the_force() {
    let mut batch = sensors(1, 1, 0.0);
    let touches = [at(0, -8.0, 0.0, 1.0), at(1, 8.0, 0.0, 1.5)];
    let (_, both) = step(&mut batch, &touches);
    let apart: Vec<[f32; 6]> = batch.wrench_of_touches().copied().collect();
    assert!((apart[0][2] + apart[1][2] - both[2]).abs() < 1e-4);
    assert!(apart[0][2] < -0.1 && apart[1][2] < -0.1);
    let (_, alone) = step(&mut sensors(1, 1, 0.0), &touches[..1]);
    assert!((apart[0][2] / alone[2] - 1.0).abs() < 0.1, "{apart:?} {alone:?}");
}

#[test]
fn a_stiffer_gel_holds_each_body_with_more_force_by_the_same_factor() {
    let stiff = SensorVariation {
        modulus_deviation: 5.0,
        ..SensorVariation::default()
    };
    let [soft, stiff] = [SensorVariation::default(), stiff].map(|variation| {
        let mut batch = imperfect(variation, [1, 1], 0.005);
        step(&mut batch, &[at(0, -8.0, 0.0, 1.0), at(1, 8.0, 0.0, 1.5)]);
        // One sticks, one slips.
        let (readings_kpa, wrench) = step(&mut batch, &[at(0, -7.9, 0.0, 1.1), at(1, 6.0, 0.0, 1.5)]);
        let apart = batch.wrench_of_touches().flatten().copied();
        let numbers: Vec<f32> = readings_kpa.into_iter().chain(wrench).chain(apart).collect();
        numbers
    });
    let factor = stiff[8 + 2] / soft[8 + 2];
    assert!((factor - 1.0).abs() > 0.1, "{factor}");
    for (stiff, soft) in stiff.iter().zip(&soft) {
        assert!(
            (stiff - factor * soft).abs() <= 1e-5 * stiff.abs() + 1e-6,
            "{stiff} {soft} {factor}"
        );
    }
}

#[test]
fn sensors_hold_the_same_for_any_number_of_threads() {
    let moments: Vec<Vec<HeldTouch>> = (0..5)
        .map(|moment| {
            let touch = |n: u32| at(n % 2, f64::from(n) - 4.0, 0.3 * f64::from(moment), 0.5);
            (0..9).map(touch).collect()
        })
        .collect();
    let all = |n_threads: usize| {
        let mut batch = sensors(9, n_threads, 0.002);
        let mut numbers = Vec::new();
        for touches in &moments {
            let (mut readings_kpa, mut wrench) = ([0.0; 72], [[0.0; 6]; 9]);
            let ends: Vec<usize> = (1..=9).collect();
            batch
                .step(0.01, &balls(), touches, &ends, &mut readings_kpa, &mut wrench)
                .unwrap();
            numbers.extend(readings_kpa);
            numbers.extend(batch.wrench_of_touches().flatten());
        }
        numbers
    };
    assert_eq!(all(1), all(2));
    assert_eq!(all(1), all(5));
}

/// A ball of 100 g falls onto the gel from 1 mm above. Returns the force under it, N, and its
/// speed, mm/s, after 1.5 s.
fn fallen(retardation_s: f64) -> (f64, f64) {
    let (step_s, mass_kg) = (0.001, 0.1);
    let mut batch = sensors(1, 1, retardation_s);
    let (mut depth_mm, mut speed_mm_per_s, mut force_n) = (-1.0, 0.0, 0.0);
    for _ in 0..1500 {
        let (mut readings_kpa, mut wrench) = ([0.0; 8], [[0.0; 6]]);
        let touches = [at(0, 0.0, 0.0, depth_mm)];
        batch
            .step(step_s, &balls(), &touches, &[1], &mut readings_kpa, &mut wrench)
            .unwrap();
        force_n = -f64::from(wrench[0][2]);
        speed_mm_per_s += step_s * 1e3 * (9.81 - force_n / mass_kg);
        depth_mm += step_s * speed_mm_per_s;
    }
    (force_n, speed_mm_per_s)
}

#[test]
fn what_falls_onto_a_gel_comes_to_rest_with_its_weight_on_it() {
    let (force_n, speed_mm_per_s) = fallen(0.005);
    assert!((force_n / 0.981 - 1.0).abs() < 1e-3, "{force_n} N");
    assert!(speed_mm_per_s.abs() < 0.1);
    let (_, bouncing_mm_per_s) = fallen(0.0);
    let (force_n, _) = fallen(0.0);
    assert!(bouncing_mm_per_s.abs() > 5.0 || (force_n / 0.981 - 1.0).abs() > 0.1);
}

#[test]
fn equal_bodies_are_held_each_by_itself() {
    let (left, right) = ([-8.0, 0.0, 1.0], [8.0, 0.0, 1.0]);
    let mut batch = sensors(1, 1, 0.0);
    for moment in 0..5 {
        let mut touches = [thing(7, 1, left), thing(3, 1, right)];
        // The position in the list does not matter.
        if moment % 2 == 1 {
            touches.reverse();
        }
        let (_, wrench) = step(&mut batch, &touches);
        let apart: Vec<[f32; 6]> = batch.wrench_of_touches().copied().collect();
        assert!(
            wrench[2] < -0.1 && wrench[0].abs() < 0.02 && wrench[1].abs() < 0.02,
            "{wrench:?}"
        );
        assert!((apart[0][0] + apart[1][0]).abs() < 0.02, "{apart:?}");
    }
    // Two shapes of one size give the same bits as one shape used twice.
    let (_, of_one_shape) = step(&mut batch, &[thing(7, 1, left), thing(3, 1, right)]);
    let mut others = sensors(1, 1, 0.0);
    let twins = || vec![balls()[1].clone(), balls()[1].clone()];
    let (mut readings_kpa, mut wrench) = ([0.0; 8], [[0.0; 6]]);
    for _ in 0..2 {
        let touches = [thing(0, 0, left), thing(1, 1, right)];
        let step = others.step(0.01, &twins(), &touches, &[2], &mut readings_kpa, &mut wrench);
        step.unwrap();
    }
    assert_eq!(of_one_shape, wrench[0]);
}

#[test]
fn what_comes_is_not_what_has_left() {
    let mut batch = sensors(1, 1, 0.005);
    step(&mut batch, &[thing(1, 0, [-5.0, 0.0, 1.0])]);
    let (_, arrived) = step(&mut batch, &[thing(2, 0, [5.0, 0.0, 1.0])]);
    let (_, alone) = step(&mut sensors(1, 1, 0.005), &[thing(2, 0, [5.0, 0.0, 1.0])]);
    assert_eq!(arrived, alone);
    // The same thing is dragged there.
    let mut dragged = sensors(1, 1, 0.005);
    step(&mut dragged, &[thing(1, 0, [-5.0, 0.0, 1.0])]);
    let (_, dragged) = step(&mut dragged, &[thing(1, 0, [5.0, 0.0, 1.0])]);
    assert!(dragged[0] > arrived[0] + 0.2, "{dragged:?} {arrived:?}");
    // Two things that exchange their positions are dragged there.
    let mut batch = sensors(1, 1, 0.0);
    let (left, right) = ([-8.0, 0.0, 1.0], [8.0, 0.0, 1.0]);
    step(&mut batch, &[thing(1, 1, left), thing(2, 1, right)]);
    step(&mut batch, &[thing(1, 1, right), thing(2, 1, left)]);
    let apart: Vec<[f32; 6]> = batch.wrench_of_touches().copied().collect();
    assert!(apart[0][0] > 0.05 && apart[1][0] < -0.05, "{apart:?}");
}

#[test]
fn a_thing_twice_on_a_sensor_is_refused_before_anything_is_done() {
    let mut batch = sensors(1, 1, 0.005);
    let touches = [thing(1, 0, [-5.0, 0.0, 1.0])];
    step(&mut batch, &touches);
    let mut other = batch.clone();
    let twice = [touches[0], thing(1, 1, [5.0, 0.0, 1.0])];
    let refused = try_step(&mut batch, &twice).unwrap_err();
    assert_eq!(
        refused,
        TouchedTwice {
            sensor: 0,
            id: TouchId(1)
        }
    );
    assert_eq!(step(&mut batch, &touches), step(&mut other, &touches));
}

#[test]
fn a_touch_that_is_new_has_no_speed() {
    let touches = [thing(1, 0, [0.0, 0.0, 1.0])];
    let (_, without) = step(&mut sensors(1, 1, 0.0), &touches);
    let mut batch = sensors(1, 1, 0.05);
    assert_eq!(step(&mut batch, &touches).1, without);
    batch.rest(0);
    assert_eq!(step(&mut batch, &touches).1, without);
}

#[test]
fn another_look_at_a_moment_finds_the_same() {
    let mut batch = sensors(1, 1, 0.05);
    step(&mut batch, &[thing(1, 0, [0.0, 0.0, 0.9])]);
    let touches = [thing(1, 0, [0.1, 0.0, 1.0])];
    let (readings_kpa, pushed) = step(&mut batch, &touches);
    let (_, without) = step(&mut batch.clone(), &touches);
    assert!(pushed[2] < 1.5 * without[2], "{pushed:?} {without:?}");
    for _ in 0..2 {
        let (mut again_kpa, mut again) = ([0.0; 8], [[0.0; 6]]);
        let look = batch.step(0.0, &balls(), &touches, &[1], &mut again_kpa, &mut again);
        look.unwrap();
        assert_eq!((again_kpa, again[0]), (readings_kpa, pushed));
    }
    assert_eq!(step(&mut batch, &touches).1, without);
}

#[test]
fn a_sensor_goes_on_from_its_state_to_the_same_bits() {
    let variation = || SensorVariation {
        noise_deviation_kpa: 0.1,
        hysteresis: 0.05,
        temperature_deviation_k: 2.0,
        drift_kpa_per_k: 0.1,
        temperature_time_s: 1.0,
        rate_hz: 60.0,
        jitter: 0.1,
        late_chance: 0.3,
        ..SensorVariation::default()
    };
    let mut batch = imperfect(variation(), [1, 1], 0.005);
    let way = |moment: u32| {
        let along_mm = 0.1 * f64::from(moment);
        [
            thing(1, 0, [along_mm - 6.0, 0.0, 0.5 + 0.02 * f64::from(moment)]),
            thing(2, 1, [8.0 - along_mm, 1.0, 1.0]),
        ]
    };
    for moment in 0..20 {
        step(&mut batch, &way(moment));
    }
    let state = batch.state(0);
    let go_on =
        |batch: &mut CoupledBatch| -> Vec<_> { (20..40).map(|moment| step(batch, &way(moment))).collect() };
    let first = go_on(&mut batch);
    assert_ne!(first, go_on(&mut batch));
    batch.set_state(0, &state);
    assert_eq!(first, go_on(&mut batch));
    // Also in another sensor of a batch.
    let mut others = imperfect(variation(), [2, 2], 0.005);
    others.set_state(1, &state);
    let replayed: Vec<_> = (20..40)
        .map(|moment| {
            let (mut readings_kpa, mut wrench) = ([0.0; 16], [[0.0; 6]; 2]);
            let step = others.step(
                0.01,
                &balls(),
                &way(moment),
                &[0, 2],
                &mut readings_kpa,
                &mut wrench,
            );
            step.unwrap();
            (*readings_kpa.last_chunk::<8>().unwrap(), wrench[1])
        })
        .collect();
    assert_eq!(first, replayed);
}
