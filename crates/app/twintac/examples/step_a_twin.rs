//! Steps a twin frame by frame: `cargo run --release --example step_a_twin -- runs/demo/model`.
#![allow(clippy::print_stdout)] // programs print

use std::path::Path;

use twintac::{Error, Press, Twin};

fn main() -> Result<(), Error> {
    let folder = std::env::args().nth(1);
    step(Path::new(folder.as_deref().unwrap_or("runs/demo/model"))).map(drop)
}

/// Presses deeper and deeper at 100 frames a second, and prints the reading of each taxel.
pub fn step(model: &Path) -> Result<Vec<f64>, Error> {
    let twin = Twin::load(model)?;
    let mut pressed = twin.at(&Press::with("cylinder").at_mm(2.0, 1.0).depth_mm(1.0))?;
    let mut readings_kpa = vec![0.0; twin.sensor().taxels().count()];
    for frame in 0..160 {
        let depth_mm = 0.5 - 0.5 * (0.02 * f64::from(frame)).cos();
        pressed.step(0.01, depth_mm, &mut readings_kpa); // the depth comes from your robot or simulator
        println!(
            "{depth_mm:.3} mm, {:.3} N, {readings_kpa:.2?} ± {:.2?} kPa",
            pressed.force_n(),
            pressed.half_width_kpa().unwrap_or_default()
        );
        if let Some((ood_score, true)) = pressed.ood_score() {
            println!("out-of-distribution score: {ood_score:.1}");
        }
    }
    Ok(readings_kpa)
}
