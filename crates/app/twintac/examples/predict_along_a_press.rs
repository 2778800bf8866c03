//! Predicts the readings along a press by a trained twin:
//! `cargo run --release --example predict_along_a_press -- runs/demo/model`.
#![allow(clippy::print_stdout)] // programs print

use std::path::Path;

use twintac::{Error, Prediction, Press, Twin};

fn main() -> Result<(), Error> {
    let folder = std::env::args().nth(1);
    predict(Path::new(folder.as_deref().unwrap_or("runs/demo/model"))).map(drop)
}

/// Prints time, depth, force and all readings of each frame, as comma-separated columns.
pub fn predict(model: &Path) -> Result<Prediction, Error> {
    let twin = Twin::load(model)?;
    let press = Press::with("cylinder").at_mm(2.0, 1.0).depth_mm(1.0).hold_s(0.5);
    let predicted = twin.predict(&press)?;
    let taxels: Vec<&str> = twin.sensor().taxels().collect();
    println!("time_s,depth_mm,force_n,{}", taxels.join(","));
    for (frame, readings_kpa) in predicted.readings_kpa.iter().enumerate() {
        let readings: Vec<String> = readings_kpa.iter().map(|kpa| format!("{kpa:.3}")).collect();
        println!(
            "{:.3},{:.3},{:.3},{}",
            predicted.time_s[frame],
            predicted.depth_mm[frame],
            predicted.force_n[frame],
            readings.join(",")
        );
    }
    Ok(predicted)
}
