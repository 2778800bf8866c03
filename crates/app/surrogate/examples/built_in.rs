//! Compares the built-in surrogate of PhysTac with the FEM solution of this version's solver, on
//! the test presses that the surrogate was evaluated on when it was trained:
//! `cargo run --release -p twintac-surrogate --example built_in [PRESSES [SLIDES]]`.
//!
//! Writes docs/results/built-in.json. 70 presses and 24 slides take minutes on two cores.

#![allow(clippy::print_stderr)]

use std::error::Error;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use serde::Serialize;
use twintac_fast::{Evaluation, FastGel, FemPress, training_places_mm};
use twintac_fem_presses::{FemPressError, FemPresses, test_surfaces};
use twintac_sensor::SensorFile;

const SEED: u64 = 1;

/// What is kept.
#[derive(Serialize)]
struct BuiltIn {
    command: String,
    provenance: &'static str,
    sensor: String,
    n_presses: u64,
    n_slides: u64,
    test_presses: Evaluation,
    slides: Evaluation,
}

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let given: Vec<u64> = std::env::args()
        .skip(1)
        .map(|n| n.parse())
        .collect::<Result<_, _>>()?;
    let [n_presses, n_slides] = [(0, 70), (1, 24)].map(|(at, usual)| given.get(at).copied().unwrap_or(usual));
    let sensor = SensorFile::phystac()?.sensor;
    let fem_presses = FemPresses::new(&sensor, &training_places_mm(&sensor))?;
    let gel = FastGel::phystac()?;
    let surfaces = test_surfaces()?;
    let test_presses = solved(n_presses, &|number| fem_presses.test_press(SEED, number))?;
    let slides = solved(n_slides, &|number| fem_presses.slide(SEED, number))?;
    let found = BuiltIn {
        command: format!(
            "cargo run --release -p twintac-surrogate --example built_in {n_presses} {n_slides}"
        ),
        provenance: "simulated",
        sensor: sensor.name.clone(),
        n_presses,
        n_slides,
        test_presses: gel.evaluate(&test_presses, &surfaces)?,
        slides: gel.evaluate(&slides, &surfaces)?,
    };
    std::fs::write(
        "docs/results/built-in.json",
        serde_json::to_string_pretty(&found)? + "\n",
    )?;
    Ok(())
}

/// The first `n` presses of a kind, solved.
fn solved(
    n: u64,
    press: &(dyn Fn(u64) -> Result<FemPress, FemPressError> + Sync),
) -> Result<Vec<FemPress>, FemPressError> {
    let done = AtomicUsize::new(0);
    let one = |number: usize| {
        let solved = press(number as u64)?;
        eprintln!("press {} of {n}", done.fetch_add(1, Ordering::Relaxed) + 1);
        Ok(solved)
    };
    (0..n as usize).into_par_iter().with_max_len(1).map(one).collect()
}
