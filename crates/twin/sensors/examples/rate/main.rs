//! Benchmark of the rate at which sensors are stepped: `cargo xtask bench sensors` writes
//! docs/benchmarks/sensors.*
//!
//! With `--rewrite`, nothing is measured: page and picture are written from the stored figures.
//! With `--steps BODY N`, sensors with relaxation and all deviations are only stepped on one
//! thread, for a profiler; BODY is `ball`, `box` or `random-mesh`.

#![allow(clippy::print_stderr)] // a tool for people at a terminal

mod counting;
#[path = "../../../digitac/examples/step_rate/invented.rs"]
mod invented;
mod machine;
mod measure;
mod page;
mod scene;
mod touch_grid;

use std::error::Error;
use std::fs;
use std::path::Path;

use digitac::Variant;
use serde::{Deserialize, Serialize};
use twintac_store::write_whole;

use machine::Machine;
use measure::{Latency, Rate};
use scene::{Kind, N_TAXELS, Scene};
use touch_grid::TouchGrid;

const N_SENSORS: usize = 1024;
const N_THREADS: usize = 2;

/// All figures.
#[derive(Serialize, Deserialize)]
struct Results {
    command: String,
    commit: String,
    provenance: String,
    machine: Machine,
    sensors: usize,
    taxels: usize,
    threads: usize,
    steps: usize,
    rates: Vec<Rate>,
    latencies: Vec<Latency>,
    bytes_per_sensor: f64,
    copied_bytes_per_s: f64,
    /// Poses in, readings and wrenches out.
    moved_bytes_per_reading: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    touch_grid: Option<TouchGrid>,
    /// Why `touch_grid` was not measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    touch_grid_note: Option<String>,
}

impl Results {
    /// Rate of the slowest scene of imperfect sensors, readings a second.
    fn slowest(&self) -> f64 {
        let imperfect = self.rates.iter().filter(|rate| rate.is_imperfect);
        imperfect
            .map(|rate| rate.readings_per_s.median)
            .fold(f64::INFINITY, f64::min)
    }

    /// Bytes that the slowest scene moves, as a fraction of what one core can copy.
    fn part_of_copying(&self) -> f64 {
        self.slowest() * self.moved_bytes_per_reading / self.copied_bytes_per_s
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/benchmarks");
    let figures = folder.join("sensors.json");
    let results = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => measure()?,
        ["--rewrite"] => serde_json::from_str(&fs::read_to_string(&figures)?)?,
        ["--steps", body, n_steps] => return steps(body, n_steps.parse()?),
        _ => return Err("usage: rate [--rewrite | --steps <ball | box | random-mesh> N]".into()),
    };
    let json = serde_json::to_string_pretty(&results)? + "\n";
    write_whole(&figures, json.as_bytes())?;
    write_whole(&folder.join("sensors.md"), page::markdown(&results)?.as_bytes())?;
    let picture = twintac_plot::svg(&page::chart(&results));
    write_whole(&folder.join("sensors.svg"), picture.as_bytes())?;
    eprintln!("wrote docs/benchmarks/sensors.md, sensors.json and sensors.svg");
    Ok(())
}

fn measure() -> Result<Results, Box<dyn Error>> {
    let sizes = [N_SENSORS, N_THREADS];
    let twin = invented::twin(Variant::PressureMemory, N_TAXELS)?;
    let bytes_per_sensor = measure::bytes_per_sensor(&twin, sizes)?;
    let copied_bytes_per_s = measure::copied_per_s();
    let latencies = measure::latencies(&twin)?;
    eprintln!("stepping {N_SENSORS} sensors");
    let rates = measure::rates(&twin, sizes)?;
    for rate in &rates {
        eprintln!(
            "{}, {}: {:.0} readings a second",
            rate.body,
            if rate.is_imperfect { "imperfect" } else { "perfect" },
            rate.readings_per_s.median
        );
    }
    eprintln!("MuJoCo's touch_grid");
    let grid = touch_grid::measure(sizes)?;
    Ok(Results {
        command: "cargo xtask bench sensors".to_owned(),
        commit: machine::commit(),
        provenance: "simulated".to_owned(),
        machine: Machine::now(),
        sensors: N_SENSORS,
        taxels: N_TAXELS,
        threads: N_THREADS,
        steps: measure::N_STEPS,
        rates,
        latencies,
        bytes_per_sensor,
        copied_bytes_per_s,
        moved_bytes_per_reading: scene::N_BYTES_MOVED as f64,
        touch_grid_note: grid.as_ref().err().cloned(),
        touch_grid: grid.ok(),
    })
}

/// Steps sensors with relaxation and all deviations on this thread, without measuring.
fn steps(body: &str, n_steps: usize) -> Result<(), Box<dyn Error>> {
    let kind = match body {
        "ball" => Kind::Ball,
        "box" => Kind::Box,
        "random-mesh" => Kind::RandomMesh,
        _ => return Err(format!("there is no body `{body}`").into()),
    };
    let twin = invented::twin(Variant::PressureMemory, N_TAXELS)?;
    let mut scene = Scene::new(kind, Some(&twin), [N_SENSORS, 1])?;
    for _ in 0..n_steps {
        scene.move_on();
        scene.step();
    }
    eprintln!("sum of all readings and forces: {}", scene.sum());
    Ok(())
}
