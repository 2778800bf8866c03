//! Finds place and depth of presses on a strip of taxels by its trained twin: `cargo run --release --example locate_on_a_strip -- RUN`.
//!
//! `RUN` is the folder of `twintac reproduce --sensor sensors/strip4-gel-d.toml …`: the presses that its twin `training/held-out` never saw are
//! located, frame by frame on the way down. The twin presses a lattice of places along the strip beforehand, at the recordings' speed.
#![allow(clippy::print_stdout)] // programs print

use std::path::Path;

use twintac::{Inverse, InverseSettings, Press, ReadingTable, Recording, TableModel, Twin};

/// Nodes along the strip and over depth: least, distance, number.
const ALONG_MM: (f64, f64, usize) = (-1.0, 1.0, 22);
const DEPTH_MM: (f64, f64, usize) = (0.0, 0.1, 23);

/// Speed of the recorded presses, mm/s.
const SPEED_MM_S: f64 = 0.98;

/// Frames of less depth are not judged, mm.
const LEAST_MM: f64 = 0.3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let run = std::env::args().nth(1).ok_or("the folder of a run")?;
    let folder = Path::new(&run).join("training/held-out");
    let twin = Twin::load(&folder)?;
    let record: serde_json::Value = serde_json::from_slice(&std::fs::read(folder.join("twin.json"))?)?;
    let recording = Recording::read_parquet(&Path::new(&run).join("recordings/presses.parquet"))?;
    let presses = &recording.presses;
    let largest_kpa = presses.iter().flat_map(|press| press.taxels_kpa.iter().flatten());
    let settings = InverseSettings {
        noise_kpa: 0.005 * largest_kpa.copied().fold(0.0, f64::max),
        n_steps: 3,
        ..InverseSettings::default()
    };
    let inverse = Inverse::new(TableModel::new(vec![table(&twin)?]), settings)?;
    let (mut places_mm, mut depths_percent) = (Vec::new(), Vec::new());
    let held_out = record["split"]["test"].as_array().ok_or("no held-out presses")?;
    for press in held_out
        .iter()
        .filter_map(|number| presses.get(number.as_u64()? as usize))
    {
        let mut tracker = inverse.start();
        let top_mm = twin
            .sensor()
            .file()
            .sensor
            .gel
            .solid
            .bounds_mm(&Default::default())
            .1
            .z;
        let (mut before_s, mut before_mm) = (press.time_s[0], f64::NEG_INFINITY);
        for (frame, time_s) in press.time_s.iter().enumerate() {
            let at_mm = press.gel_from_indenter[frame].position_mm;
            let depth_mm = top_mm - at_mm.z;
            let contact = tracker.update(time_s - before_s, &press.taxels_kpa[frame]);
            let is_on_the_way = depth_mm > before_mm + 0.01 && depth_mm > LEAST_MM;
            (before_s, before_mm) = (*time_s, depth_mm);
            if let (true, Some(contact)) = (is_on_the_way, contact) {
                places_mm.push((contact.place_mm.x - at_mm.x).abs());
                depths_percent.push(100.0 * (contact.depth_mm / depth_mm - 1.0).abs());
            }
        }
    }
    println!("real: {} frames of {} presses", places_mm.len(), held_out.len());
    println!(
        "place along the strip: {:.3} mm, depth: {:.2} % (medians)",
        median(places_mm),
        median(depths_percent)
    );
    Ok(())
}

/// What the twin reads at the nodes, on the way down.
fn table(twin: &Twin) -> Result<ReadingTable, twintac::Error> {
    let n_taxels = twin.sensor().taxels().count();
    let [along, depth] = [ALONG_MM, DEPTH_MM];
    let n_nodes = along.2 * depth.2;
    let (mut readings_kpa, mut force_n) = (vec![vec![0.0; n_taxels]; n_nodes], vec![0.0; n_nodes]);
    for column in 0..along.2 {
        let x_mm = along.0 + along.1 * column as f64;
        let deepest_mm = depth.1 * (depth.2 - 1) as f64;
        let mut pressed = twin.at(&Press::with("tip").at_mm(x_mm, 0.0).depth_mm(deepest_mm))?;
        for row in 0..depth.2 {
            let node = row * along.2 + column;
            pressed.step(
                depth.1 / SPEED_MM_S,
                depth.1 * row as f64,
                &mut readings_kpa[node],
            );
            force_n[node] = pressed.force_n();
        }
    }
    Ok(ReadingTable {
        first_mm: [along.0, 0.0, depth.0],
        step_mm: [along.1, 1.0, depth.1],
        n: [along.2, 1, depth.2],
        readings_kpa,
        force_n,
    })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
