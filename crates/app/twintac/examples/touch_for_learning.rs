//! Steps a thousand imperfect sensors under a thousand balls:
//! `cargo run --release --example touch_for_learning`.
#![allow(clippy::print_stdout)] // programs print

use std::time::Instant;

use twintac::{Body, Error, FastGel, Pose, SensorBatch, SensorVariation, Shape, Touch};

const N_SENSORS: usize = 1024;

fn main() -> Result<(), Error> {
    // Made by `twintac fast variation` from a model and recordings of the emulated bench.
    let text = include_str!("data/variation.toml");
    let variation = SensorVariation::parse("variation.toml", text)?;
    for (name, variation) in [("perfect", SensorVariation::default()), ("imperfect", variation)] {
        let (readings_kpa, seconds) = step(variation, 100)?;
        println!(
            "{name}: the first sensor reads {:.2?} kPa (simulated), {:.0} sensors are read a second",
            &readings_kpa[..8],
            100.0 * N_SENSORS as f64 / seconds
        );
    }
    Ok(())
}

/// Presses each ball a little deeper at each step. Returns the last readings of all sensors, kPa,
/// and the time that the steps took, s.
pub fn step(variation: SensorVariation, n_steps: usize) -> Result<(Vec<f32>, f64), Error> {
    let n_threads = std::thread::available_parallelism().map_or(1, usize::from);
    let (gel, seed) = (FastGel::phystac()?, 1);
    // A trained twin instead of `None` adds the gains and the viscoelastic relaxation of its
    // barometers.
    let mut sensors = SensorBatch::new(&gel, None, variation, [N_SENSORS, n_threads], seed);
    let bodies = [Body::new(&Shape::Sphere { radius_mm: 6.0 }, &Default::default())?];
    let ends: Vec<usize> = (1..=N_SENSORS).collect(); // one body touches each sensor
    let (mut readings_kpa, mut wrench) = (vec![0.0; 8 * N_SENSORS], vec![[0.0; 6]; N_SENSORS]);
    let started = Instant::now();
    for step in 0..n_steps {
        let depth_mm = 2.0 * step as f64 / n_steps as f64;
        let touch = |sensor: usize| {
            let x_mm = 20.0 * sensor as f64 / N_SENSORS as f64 - 10.0;
            Touch {
                body: 0,
                gel_from_body: Pose::from_position([x_mm, 0.0, 8.5 - depth_mm].into()),
            }
        };
        let touches: Vec<Touch> = (0..N_SENSORS).map(touch).collect();
        sensors.step(0.01, &bodies, &touches, &ends, &mut readings_kpa, &mut wrench);
    }
    Ok((readings_kpa, started.elapsed().as_secs_f64()))
}
