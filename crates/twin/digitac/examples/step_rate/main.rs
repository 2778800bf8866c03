//! Rate at which a thousand twins are stepped: `cargo xtask bench twin` writes
//! docs/benchmarks/twin.*
//!
//! The ways of stepping the twins are timed in turns, so that other load on the machine affects all
//! of them alike.

#![allow(clippy::print_stderr)] // a tool for people at a terminal

mod invented;

use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::thread;
use std::time::Instant;

use digitac::{Features, Twin, TwinState, Variant};
use serde::Serialize;

const COMMAND: &str = "cargo xtask bench twin";
const N_TWINS: usize = 1000;
const N_TAXELS: usize = 8;
/// Frames of each twin that are timed together.
const N_FRAMES: usize = 100;
/// Number of turns; the median counts.
const N_TURNS: usize = 15;

/// Rates of a variant, in frames of one twin per second.
#[derive(Serialize)]
struct Rates {
    variant: Variant,
    together: f64,
    together_on_all_cores: f64,
    one_by_one: f64,
    whole_presses: f64,
}

#[derive(Serialize)]
struct Benchmark {
    command: &'static str,
    commit: String,
    twins: usize,
    taxels: usize,
    threads: usize,
    /// Load average of the machine at the end. If it is above the number of threads, other work has
    /// lowered the rates.
    load_average: f64,
    rates: Vec<Rates>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let threads = thread::available_parallelism()?.get();
    let rates = Variant::ALL.into_iter().map(|variant| {
        let rates = measure(&invented::twin(variant, N_TAXELS)?, threads);
        eprintln!(
            "{variant}: {N_TWINS} twins stepped {:.0} times a second",
            rates.together / N_TWINS as f64
        );
        Ok(rates)
    });
    let rates = rates.collect::<Result<_, Box<dyn Error>>>()?;
    let benchmark = Benchmark {
        command: COMMAND,
        commit: commit(),
        twins: N_TWINS,
        taxels: N_TAXELS,
        threads,
        load_average: load_average()?,
        rates,
    };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/benchmarks");
    fs::write(
        folder.join("twin.json"),
        serde_json::to_string_pretty(&benchmark)? + "\n",
    )?;
    fs::write(folder.join("twin.md"), page(&benchmark)?)?;
    eprintln!("wrote docs/benchmarks/twin.md and twin.json");
    Ok(())
}

/// Load average over the last minute; available on Linux only.
fn load_average() -> Result<f64, Box<dyn Error>> {
    let text = fs::read_to_string("/proc/loadavg")?;
    Ok(text.split(' ').next().unwrap_or_default().parse()?)
}

/// The checked-out commit, as named by git.
fn commit() -> String {
    let output = Command::new("git")
        .args(["describe", "--always", "--dirty"])
        .output();
    output
        .ok()
        .filter(|output| output.status.success())
        .map_or("unknown".to_owned(), |output| {
            String::from_utf8_lossy(&output.stdout).trim().to_owned()
        })
}

fn measure(twin: &Twin, threads: usize) -> Rates {
    let inputs: Vec<Vec<f64>> = (0..N_FRAMES)
        .map(|frame| {
            (0..N_TWINS)
                .flat_map(|twin| invented::seen(twin, frame, N_TAXELS))
                .collect()
        })
        .collect();
    let presses: Vec<Features> = (0..10)
        .map(|press| invented::features(press, N_FRAMES, N_TAXELS))
        .collect();
    let mut readings_kpa = vec![0.0; N_TWINS * N_TAXELS];
    let mut together = twin.states(N_TWINS);
    let mut alone = vec![twin.state(); N_TWINS];
    let own = N_TWINS.div_ceil(threads);
    let mut parts: Vec<TwinState> = (0..threads)
        .map(|part| twin.states(own.min(N_TWINS - (part * own).min(N_TWINS))))
        .collect();
    let mut seconds = [const { Vec::new() }; 4];
    for _ in 0..N_TURNS {
        let start = Instant::now();
        for seen in &inputs {
            together.step(0.02, black_box(seen), &mut readings_kpa);
        }
        seconds[0].push(start.elapsed().as_secs_f64());

        let start = Instant::now();
        thread::scope(|scope| {
            let rows = readings_kpa.chunks_mut(own * N_TAXELS);
            for (part, (state, readings_kpa)) in parts.iter_mut().zip(rows).enumerate() {
                let inputs = &inputs;
                scope.spawn(move || {
                    let from = part * own * N_TAXELS;
                    for seen in inputs {
                        let seen = &seen[from..from + readings_kpa.len()];
                        state.step(0.02, black_box(seen), readings_kpa);
                    }
                });
            }
        });
        seconds[1].push(start.elapsed().as_secs_f64());

        let start = Instant::now();
        for seen in &inputs {
            let rows = readings_kpa
                .chunks_exact_mut(N_TAXELS)
                .zip(seen.chunks_exact(N_TAXELS));
            for (state, (readings_kpa, seen)) in alone.iter_mut().zip(rows) {
                state.step(0.02, black_box(seen), readings_kpa);
            }
        }
        seconds[2].push(start.elapsed().as_secs_f64());

        let start = Instant::now();
        for _ in 0..N_TWINS / presses.len() {
            for press in &presses {
                black_box(twin.predict(&[press]));
            }
        }
        seconds[3].push(start.elapsed().as_secs_f64());
    }
    let [together, together_on_all_cores, one_by_one, whole_presses] = seconds.map(|mut seconds| {
        seconds.sort_by(f64::total_cmp);
        (N_TWINS * N_FRAMES) as f64 / seconds[N_TURNS / 2]
    });
    Rates {
        variant: twin.variant(),
        together,
        together_on_all_cores,
        one_by_one,
        whole_presses,
    }
}

fn page(benchmark: &Benchmark) -> Result<String, std::fmt::Error> {
    let mut text = format!(
        "# Twins stepped frame by frame\n\nMade by `{}` of {} (simulated data).\n\n\
         {} twins of {} taxels are stepped together with pressures at their ports, on one thread and on {}; as many one by one, on one thread; \
         and as many whole presses are predicted, on one thread. All read the same numbers, to the last bit. Each figure is the median of {N_TURNS} \
         turns that the four take in one run; a frame is one of one twin. Load average at the end: {:.1} (what is above {} was other work, and \
         made all rates lower).\n\n\
         | variant | steps of all {} a second | frames a second: together | on {} threads | one by one | whole presses | together over one by one |\n\
         |---|---:|---:|---:|---:|---:|---:|\n",
        benchmark.command,
        benchmark.commit,
        benchmark.twins,
        benchmark.taxels,
        benchmark.threads,
        benchmark.load_average,
        benchmark.threads,
        benchmark.twins,
        benchmark.threads
    );
    for rates in &benchmark.rates {
        writeln!(
            text,
            "| `{}` | {:.0} | {:.2} million | {:.2} million | {:.2} million | {:.2} million | {:.2} |",
            rates.variant,
            rates.together / benchmark.twins as f64,
            1e-6 * rates.together,
            1e-6 * rates.together_on_all_cores,
            1e-6 * rates.one_by_one,
            1e-6 * rates.whole_presses,
            rates.together / rates.one_by_one
        )?;
    }
    Ok(text)
}
