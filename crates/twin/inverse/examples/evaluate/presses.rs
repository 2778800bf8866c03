//! FEM solutions of presses.

use std::error::Error;
use std::f64::consts::TAU;
use std::path::Path;

use glam::DVec2;
use rand::Rng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use twintac_fast::FemPress;
use twintac_fem_presses::FemPresses;
use twintac_inverse::KnownShape;
use twintac_random::stream;
use twintac_sensor::Sensor;

/// Number of presses of each shape.
const OF_EACH: usize = 10;

/// Distance that a shape's origin keeps from the gel's edges, mm.
const MARGIN_MM: f64 = 3.0;

/// Range of the largest depth of a press, mm.
const DEPTHS_MM: std::ops::Range<f64> = 1.5..4.0;

/// The FEM solution of a press.
#[derive(Serialize, Deserialize)]
pub(crate) struct Solved {
    pub(crate) shape: usize,
    pub(crate) place_mm: DVec2,
    pub(crate) yaw_rad: f64,
    pub(crate) depth_mm: f64,
    pub(crate) solved: FemPress,
}

/// All presses. Those with a stored file are not solved again.
pub(crate) fn solved(
    sensor: &Sensor,
    shapes: &[KnownShape],
    places_mm: &[DVec2],
) -> Result<Vec<Solved>, Box<dyn Error + Send + Sync>> {
    let folder = Path::new("runs/inverse");
    std::fs::create_dir_all(folder)?;
    let fem_presses = FemPresses::new(sensor, places_mm)?;
    let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
    let (low, high) = (low.truncate() + MARGIN_MM, high.truncate() - MARGIN_MM);
    let solve = |number: usize| {
        let path = folder.join(format!("press-{number:03}.json"));
        if let Ok(bytes) = std::fs::read(&path) {
            return Ok(serde_json::from_slice(&bytes)?);
        }
        let random = &mut stream(1, &format!("press to judge the inverse {number}"));
        let shape = number % shapes.len();
        let place_mm = low + (high - low) * DVec2::new(random.random(), random.random());
        let yaw_rad = random.random_range(0.0..TAU);
        let depth_mm = random.random_range(DEPTHS_MM);
        let solved = fem_presses.upright(&shapes[shape].shape, place_mm, yaw_rad, depth_mm)?;
        let solved = Solved {
            shape,
            place_mm,
            yaw_rad,
            depth_mm,
            solved,
        };
        std::fs::write(path, serde_json::to_vec(&solved)?)?;
        Ok(solved)
    };
    (0..OF_EACH * shapes.len())
        .into_par_iter()
        .with_max_len(1)
        .map(solve)
        .collect()
}
