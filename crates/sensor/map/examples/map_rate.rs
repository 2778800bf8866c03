//! Pressure maps per second: `cargo run --release -p twintac-map --example map_rate`.
//!
//! Eight taxels on 64 × 128 cells, each map solved anew or computed from a prepared map, in one run
//! on one core.

#![allow(clippy::print_stdout)] // its results

use std::error::Error;
use std::hint::black_box;
use std::time::{Duration, Instant};

use twintac_map::{Kernel, MapSettings, PreparedMap, Rectangle, Weights, pressure_map};

const TAXELS_MM: [[f64; 2]; 8] = [
    [-12.0, -4.0],
    [-4.0, -4.0],
    [4.0, -4.0],
    [12.0, -4.0],
    [-12.0, 4.0],
    [-4.0, 4.0],
    [4.0, 4.0],
    [12.0, 4.0],
];
const LONG_ENOUGH: Duration = Duration::from_secs(1);

fn main() -> Result<(), Box<dyn Error>> {
    let rectangle = Rectangle {
        min_mm: [-17.0, -9.0],
        max_mm: [17.0, 9.0],
    };
    println!("kernel       maps/s anew  maps/s prepared  ratio");
    for kernel in [Kernel::Gaussian, Kernel::ThinPlate] {
        let settings = MapSettings {
            grid: [64, 128],
            kernel,
            width_mm: Some(4.0),
            weights: Weights::Interpolating,
        };
        let anew_hz = rate_hz(|readings_kpa| {
            black_box(pressure_map(
                &TAXELS_MM,
                readings_kpa,
                &[0.0; 8],
                rectangle,
                &settings,
            )?);
            Ok(())
        })?;
        let prepared = PreparedMap::new(&TAXELS_MM, rectangle, &settings, &[])?;
        let mut map = Vec::new();
        let prepared_hz = rate_hz(|readings_kpa| {
            prepared.fill(readings_kpa, &mut map)?;
            black_box(&map);
            Ok(())
        })?;
        let name = format!("{kernel:?}");
        let ratio = prepared_hz / anew_hz;
        println!("{name:<12} {anew_hz:>11.0}  {prepared_hz:>15.0}  {ratio:>5.0}");
    }
    Ok(())
}

/// How often per second something can be computed from new readings.
fn rate_hz(mut make: impl FnMut(&[f64]) -> Result<(), Box<dyn Error>>) -> Result<f64, Box<dyn Error>> {
    let (begin, mut count) = (Instant::now(), 0_u32);
    while begin.elapsed() < LONG_ENOUGH {
        let readings_kpa: [f64; 8] = std::array::from_fn(|taxel| f64::from(count % 97) + taxel as f64);
        make(black_box(&readings_kpa))?;
        count += 1;
    }
    Ok(f64::from(count) / begin.elapsed().as_secs_f64())
}
