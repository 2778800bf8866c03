//! A report from invented data, to look at: `cargo run -p twintac-report --release --example gallery [folder]`.

#![allow(clippy::unwrap_used)] // an example that fails says where

mod invented;

use std::path::Path;

use twintac_report::page;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "runs/gallery".into());
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    page(&invented::moving()).write(&folder.join("moving.html"))?;
    page(&invented::resting()).write(&folder.join("static.html"))?;
    let drawing = invented::drawing();
    drawing.write(&folder.join("sensor.svg"))?;
    drawing.write(&folder.join("sensor.png"))?;
    Ok(())
}
