//! Bodies that move freely are held by gels: friction, loss, several bodies at once.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use glam::DVec3;
use twintac_fast::{Body, FastGel, Friction, Touch};
use twintac_sensor::SensorFile;
use twintac_sensors::{Coupling, Imperfection, SensorBatch};
use twintac_shape::{Pose, Shape, Surfaces};

const TOP_MM: f64 = 8.5;

fn balls() -> Vec<Body> {
    let ball = |radius_mm: f64| Body::new(&Shape::Sphere { radius_mm }, &Surfaces::new()).unwrap();
    vec![ball(12.5), ball(6.0)]
}

fn sensors(n: usize, n_threads: usize, retardation_s: f64) -> SensorBatch {
    let sensor = SensorFile::phystac().unwrap().sensor;
    let coupling = Coupling {
        friction: Friction::on(&sensor, 0.8),
        retardation_s,
    };
    let gel = FastGel::phystac().unwrap();
    SensorBatch::new(&gel, None, Imperfection::default(), [n, n_threads], 1)
        .with_coupling(coupling)
        .unwrap()
}

fn at(body: u32, x_mm: f64, y_mm: f64, depth_mm: f64) -> Touch {
    Touch {
        body,
        gel_from_body: Pose::from_position(DVec3::new(x_mm, y_mm, TOP_MM - depth_mm)),
    }
}

/// Readings and the wrench of one sensor.
fn step(batch: &mut SensorBatch, touches: &[Touch]) -> ([f32; 8], [f32; 6]) {
    let (mut readings_kpa, mut wrench) = ([0.0; 8], [[0.0; 6]]);
    batch.step(
        0.01,
        &balls(),
        touches,
        &[touches.len()],
        &mut readings_kpa,
        &mut wrench,
    );
    (readings_kpa, wrench[0])
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
    // Taxels 1 and 5 are behind, 2 and 6 ahead. The ball itself moves by a sixteenth of their distance.
    let mut without = FastGel::phystac().unwrap().reader();
    let mut moved_kpa = [0.0; 8];
    let ball = &balls()[0];
    without.read(
        &[(ball, at(0, 0.5, 0.0, 1.0).gel_from_body)],
        &mut moved_kpa,
        &mut [0.0; 6],
    );
    assert!(pulled_kpa[2] > moved_kpa[2] + 0.2 && pulled_kpa[1] < moved_kpa[1] - 0.2);
    assert!((pressed_kpa[2] - pressed_kpa[1]).abs() < 0.1);
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
fn sensors_hold_the_same_for_any_number_of_threads() {
    let moments: Vec<Vec<Touch>> = (0..5)
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
            batch.step(0.01, &balls(), touches, &ends, &mut readings_kpa, &mut wrench);
            numbers.extend(readings_kpa);
            numbers.extend(batch.wrench_of_touches().flatten());
        }
        numbers
    };
    assert_eq!(all(1), all(2));
    assert_eq!(all(1), all(5));
}

/// The force under a ball of 100 g that falls onto the gel from 1 mm above, N, and its speed, mm/s, after 1.5 s.
fn fallen(retardation_s: f64) -> (f64, f64) {
    let (step_s, mass_kg) = (0.001, 0.1);
    let mut batch = sensors(1, 1, retardation_s);
    let (mut depth_mm, mut speed_mm_per_s, mut force_n) = (-1.0, 0.0, 0.0);
    for _ in 0..1500 {
        let (mut readings_kpa, mut wrench) = ([0.0; 8], [[0.0; 6]]);
        let touches = [at(0, 0.0, 0.0, depth_mm)];
        batch.step(step_s, &balls(), &touches, &[1], &mut readings_kpa, &mut wrench);
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
