//! Makes two report pages from invented data:
//! `cargo run -p twintac-report --release --example invented_report [folder]`.

mod invented;

use std::path::Path;

use twintac_report::page;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "runs/invented".into());
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    for (name, results) in [("moving", invented::moving()), ("static", invented::resting())] {
        page(&results.report()).write(&folder.join(format!("{name}.html")))?;
    }
    Ok(())
}
