//! Evaluates contact estimation on FEM solutions of presses on PhysTac's gel that were not used for
//! training the surrogate: `cargo run --release -p twintac-inverse --example evaluate`.
//!
//! The sensor's seven indenters press upright at random locations, to random depths, at random yaw
//! angles, in five steps that are held. Readings are those of the FEM solution, with noise. Solved
//! presses are stored in `runs/inverse`; the result is written to `docs/results/inverse.json`.

#![allow(clippy::print_stdout)] // a program

mod held;
mod presses;
mod summary;

use std::error::Error;
use std::time::Instant;

use twintac_fast::{FastGel, training_places_mm};
use twintac_inverse::{Inverse, InverseSettings, KnownShape};
use twintac_sensor::SensorFile;

use held::{Evaluator, Watched};
use summary::{Evaluation, summary};

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let sensor = SensorFile::phystac()?.sensor;
    let gel = FastGel::phystac()?;
    let known = |indenter: &twintac_sensor::Indenter| KnownShape {
        name: indenter.name.clone(),
        shape: indenter.shape.clone(),
    };
    let shapes: Vec<KnownShape> = sensor.indenters.iter().map(known).collect();
    let places_mm = training_places_mm(&sensor);
    let presses = presses::solved(&sensor, &shapes, &places_mm)?;
    let settings = InverseSettings::default();
    let start = Instant::now();
    let inverse = Inverse::of_fast_gel(&gel, &shapes, &sensor.surfaces, settings)?;
    let prepared_s = start.elapsed().as_secs_f64();
    let mut evaluator = Evaluator::new(&sensor, &gel, &places_mm)?;
    let (mut told, mut given): (Vec<Watched>, Vec<Watched>) = (Vec::new(), Vec::new());
    for (number, press) in presses.iter().enumerate() {
        told.extend(evaluator.watch(number, press, &inverse, press.shape)?);
        let own = std::slice::from_ref(&shapes[press.shape]);
        let alone = Inverse::of_fast_gel(&gel, own, &sensor.surfaces, settings)?;
        let found = evaluator.watch(number, press, &alone, 0)?.into_iter();
        given.extend(found.map(|found| Watched {
            shape: press.shape,
            told: press.shape,
            ..found
        }));
    }
    let evaluation = Evaluation {
        command: "cargo run --release -p twintac-inverse --example evaluate".into(),
        provenance: "simulated".into(),
        sensor: sensor.name.clone(),
        settings,
        n_presses: presses.len(),
        prepared_s,
        shapes_to_tell: summary(&shapes, &told),
        shape_given: summary(&shapes, &given),
        microseconds_a_frame: evaluator.microseconds(),
    };
    let json = serde_json::to_string_pretty(&evaluation)?;
    println!("{json}");
    std::fs::write("docs/results/inverse.json", json + "\n")?;
    Ok(())
}
