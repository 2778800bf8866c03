//! Fuzzing of what decodes the bench's wires, its logs and the force sensor's texts: `fuzz/` with
//! libFuzzer, without a nightly compiler.

use std::collections::VecDeque;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};
use serde::{Deserialize, Serialize};

use crate::cargo::cargo;

/// What `cargo fuzz --sanitizer none` compiles with.
const FLAGS: &str = "--cfg fuzzing -Ccodegen-units=1 -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
    -Cllvm-args=-sanitizer-coverage-trace-compares";
/// Largest input, bytes: a log has a head of 5 KiB, frames and datagrams have less than one.
const LARGEST_INPUT: usize = 16 << 10;
/// Largest input that is kept, and most of a target's inputs together, bytes: what is committed
/// stays small.
const LARGEST_KEPT: usize = 8 << 10;
const MOST_KEPT: usize = 48 << 10;
/// Memory of the process, MiB. The harness bounds what is allocated more tightly.
const MOST_MIB: usize = 512;
/// Longest that one input may take, s.
const TIME_OUT_S: usize = 10;

/// What was asked for.
struct Options {
    targets: Vec<String>,
    seconds: u64,
    jobs: usize,
    /// Whether the corpus that was found, minimised, takes the committed one's place.
    keep: bool,
}

/// What came of all targets.
#[derive(Default, Serialize, Deserialize)]
struct Results {
    command: String,
    targets: Vec<Outcome>,
}

/// What came of a target.
#[derive(Clone, Default, Serialize, Deserialize)]
struct Outcome {
    target: String,
    executions: u64,
    seconds: f64,
    corpus: u64,
    edges: u64,
    features: u64,
    peak_mib: u64,
    crashes: usize,
}

/// Fuzzes the targets that `given` names, or all of them, with the options of `cargo xtask fuzz`.
pub fn fuzz(given: &[String]) -> Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .context("the workspace's folder")?;
    let all = all_targets(root)?;
    let options = Options::parse(given, &all)?;
    let programs = build(root)?;
    let work = programs.join("fuzz-work");
    cargo(&[
        "run",
        "--release",
        "--quiet",
        "--package",
        "twintac-fuzz",
        "--example",
        "seeds",
        "--",
        &work.join("seeds").display().to_string(),
    ])?;
    let waiting = Mutex::new(options.targets.iter().collect::<VecDeque<_>>());
    let outcomes = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        let work_off = || -> Result<()> {
            while let Some(target) = pop(&waiting) {
                eprintln!("fuzzing {target} for {} s", options.seconds);
                let outcome = run(root, &programs, &work, target, &options)?;
                if let Ok(mut outcomes) = outcomes.lock() {
                    outcomes.push(outcome);
                }
            }
            Ok(())
        };
        let threads: Vec<_> = (0..options.jobs).map(|_| scope.spawn(work_off)).collect();
        threads.into_iter().try_for_each(|thread| match thread.join() {
            Ok(result) => result,
            Err(_) => bail!("a thread panicked"),
        })
    })?;
    let mut outcomes = outcomes.into_inner().unwrap_or_default();
    outcomes.sort_by_key(|outcome| {
        options
            .targets
            .iter()
            .position(|target| *target == outcome.target)
    });
    eprintln!("{}", table(&outcomes));
    if options.keep {
        record(root, &options, &outcomes, &all)?;
    }
    let crashes: usize = outcomes.iter().map(|outcome| outcome.crashes).sum();
    ensure!(crashes == 0, "{crashes} crashes: see `fuzz/artifacts`");
    Ok(())
}

impl Options {
    fn parse(given: &[String], all: &[String]) -> Result<Self> {
        let mut options = Self {
            targets: Vec::new(),
            seconds: 60,
            jobs: 2,
            keep: false,
        };
        let mut words = given.iter();
        while let Some(word) = words.next() {
            let mut number = || -> Result<u64> {
                let number = words
                    .next()
                    .and_then(|text| text.parse().ok())
                    .filter(|number| *number > 0);
                number.with_context(|| format!("`{word}` wants a number above zero"))
            };
            match word.as_str() {
                "--seconds" => options.seconds = number()?,
                "--jobs" => options.jobs = usize::try_from(number()?)?,
                "--keep" => options.keep = true,
                target if all.iter().any(|known| known == target) => options.targets.push(target.to_owned()),
                other => bail!("there is no fuzz target `{other}`: {}", all.join(", ")),
            }
        }
        if options.targets.is_empty() {
            options.targets = all.to_vec();
        }
        Ok(options)
    }
}

fn pop<'a>(waiting: &Mutex<VecDeque<&'a String>>) -> Option<&'a String> {
    waiting.lock().ok()?.pop_front()
}

/// Names of the harness's programs, in order.
fn all_targets(root: &Path) -> Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(root.join("fuzz/fuzz_targets"))? {
        let path = entry?.path();
        names.extend(path.file_stem().map(|name| name.to_string_lossy().into_owned()));
    }
    names.sort();
    Ok(names)
}

/// Builds the harness; the folder of its programs.
fn build(root: &Path) -> Result<PathBuf> {
    let rustc = Command::new("rustc")
        .arg("-vV")
        .output()
        .context("starting rustc")?;
    let about = String::from_utf8_lossy(&rustc.stdout).into_owned();
    let host = about
        .lines()
        .find_map(|line| line.strip_prefix("host: "))
        .context("rustc does not say its host")?;
    let folder = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("fuzz/target"), PathBuf::from);
    let status = Command::new("cargo")
        .args(["build", "--release", "--bins", "--manifest-path"])
        .arg(root.join("fuzz/Cargo.toml"))
        .args(["--target", host]) // so that build scripts are compiled without the flags
        .env("RUSTFLAGS", FLAGS)
        .env("CARGO_TARGET_DIR", &folder)
        .status()
        .context("starting cargo")?;
    ensure!(
        status.success(),
        "the fuzz targets could not be built; libFuzzer needs a C++ compiler"
    );
    Ok(folder.join(host).join("release"))
}

/// Runs one target, and lets its corpus be kept.
fn run(root: &Path, programs: &Path, work: &Path, target: &str, options: &Options) -> Result<Outcome> {
    let committed = root.join("fuzz/corpus").join(target);
    let (corpus, artifacts) = (
        work.join("corpus").join(target),
        root.join("fuzz/artifacts").join(target),
    );
    for folder in [&corpus, &artifacts, &committed] {
        fs::create_dir_all(folder)?;
    }
    let before = broken(&artifacts)?;
    let seeds = work.join("seeds").join(target);
    let begun = Instant::now();
    let output = Command::new(programs.join(target))
        .args([
            format!("-max_total_time={}", options.seconds),
            format!("-max_len={LARGEST_INPUT}"),
            format!("-rss_limit_mb={MOST_MIB}"),
            format!("-malloc_limit_mb={MOST_MIB}"),
            format!("-timeout={TIME_OUT_S}"),
            format!("-artifact_prefix={}/", artifacts.display()),
            "-print_final_stats=1".to_owned(),
        ])
        .args([&corpus, &committed, &seeds])
        .stdin(Stdio::null())
        .output()
        .with_context(|| format!("starting {target}"))?;
    let talk = String::from_utf8_lossy(&output.stderr).into_owned();
    fs::write(work.join(format!("{target}.txt")), &talk)?;
    let mut outcome = read_talk(&talk);
    outcome.target = target.to_owned();
    outcome.seconds = begun.elapsed().as_secs_f64().round();
    outcome.crashes = broken(&artifacts)?.saturating_sub(before);
    if outcome.crashes == 0 && !output.status.success() {
        bail!("{target} ended with {}:\n{talk}", output.status);
    }
    if options.keep {
        minimise(programs, work, target, &[&committed, &corpus, &seeds], &committed)?;
    }
    Ok(outcome)
}

/// Inputs in a folder that broke something. Slow ones are there as well, and may have been slow
/// because the machine was busy.
fn broken(artifacts: &Path) -> Result<usize> {
    let mut count = 0;
    for entry in fs::read_dir(artifacts)? {
        let name = entry?.file_name();
        count += usize::from(!name.to_string_lossy().starts_with("slow-unit-"));
    }
    Ok(count)
}

/// Puts the smallest inputs that reach all code that was reached, however often, into `kept`; as
/// many as there is room for.
fn minimise(programs: &Path, work: &Path, target: &str, from: &[&PathBuf], kept: &Path) -> Result<()> {
    let merged = work.join("merged").join(target);
    if merged.exists() {
        fs::remove_dir_all(&merged)?;
    }
    fs::create_dir_all(&merged)?;
    let output = Command::new(programs.join(target))
        .args(["-set_cover_merge=1", "-use_counters=0"])
        .arg(format!("-max_len={LARGEST_KEPT}"))
        .arg(&merged)
        .args(from)
        .stdin(Stdio::null())
        .output()?;
    ensure!(
        output.status.success(),
        "the corpus of {target} could not be minimised"
    );
    for entry in fs::read_dir(kept)? {
        fs::remove_file(entry?.path())?;
    }
    let mut inputs = Vec::new();
    for entry in fs::read_dir(&merged)? {
        let path = entry?.path();
        inputs.push((fs::read(&path)?, path));
    }
    inputs.sort_by(|(one, _), (other, _)| (one.len(), one).cmp(&(other.len(), other)));
    let mut n_bytes = 0;
    for (input, path) in inputs {
        n_bytes += input.len();
        if n_bytes > MOST_KEPT {
            break;
        }
        fs::write(kept.join(path.file_name().unwrap_or_default()), input)?;
    }
    Ok(())
}

/// What libFuzzer says at its end, and in its last line of figures.
fn read_talk(talk: &str) -> Outcome {
    let mut outcome = Outcome::default();
    for line in talk.lines() {
        let mut words = line.split_whitespace();
        while let Some(word) = words.next() {
            let place = match word {
                "stat::number_of_executed_units:" => &mut outcome.executions,
                "stat::peak_rss_mb:" => &mut outcome.peak_mib,
                "cov:" => &mut outcome.edges,
                "ft:" => &mut outcome.features,
                "corp:" => &mut outcome.corpus,
                _ => continue,
            };
            let number = words.next().and_then(|text| text.split('/').next()?.parse().ok());
            *place = number.unwrap_or(*place);
        }
    }
    outcome
}

fn table(outcomes: &[Outcome]) -> String {
    let mut text = String::from(
        "| target | executions | s | inputs in the corpus | edges | features | peak memory, MiB | crashes |\n\
         |---|---:|---:|---:|---:|---:|---:|---:|\n",
    );
    for outcome in outcomes {
        let Outcome {
            target,
            executions,
            seconds,
            corpus,
            edges,
            features,
            peak_mib,
            crashes,
        } = outcome;
        let _ = writeln!(
            text,
            "| `{target}` | {executions} | {seconds:.0} | {corpus} | {edges} | {features} | {peak_mib} | {crashes} |"
        );
    }
    text
}

/// Writes the figures down.
fn record(root: &Path, options: &Options, outcomes: &[Outcome], all: &[String]) -> Result<()> {
    let command = format!(
        "cargo xtask fuzz [target…] --seconds {} --jobs {} --keep",
        options.seconds, options.jobs
    );
    let results = root.join("docs/benchmarks");
    // Targets that were not fuzzed this time keep their rows.
    let earlier: Results = match fs::read(results.join("fuzz.json")) {
        Ok(bytes) => serde_json::from_slice(&bytes).context("docs/benchmarks/fuzz.json")?,
        Err(_) => Results::default(),
    };
    let targets: Vec<Outcome> = all
        .iter()
        .filter_map(|target| {
            let mut rows = outcomes.iter().chain(&earlier.targets);
            rows.find(|outcome| outcome.target == *target).cloned()
        })
        .collect();
    let table = table(&targets);
    let figures = serde_json::to_string_pretty(&Results {
        command: command.clone(),
        targets,
    })?;
    let page = format!(
        "# Fuzzing\n\nMade by `{command}`; each row is of its target's latest run.\n\nEach target is a kind of bytes that comes from a wire or a file, and what must hold for them \
         (`crates/app/fuzz`): what decodes encodes again, nothing grows beyond its bound, nothing panics. libFuzzer looks for inputs that \
         reach new code; an input may take {TIME_OUT_S} s, and allocate 16 MiB at once and 64 MiB in all. Edges are branches \
         of the compiled code that inputs reached, features those with how often.\n\n{table}\n\
         Small inputs that reach these edges are in `fuzz/corpus`, and a test of `crates/app/fuzz` runs them without a fuzzer. \
         Fuzzing needs a C++ compiler (`apt-get install g++`), but no nightly Rust. With cargo-fuzz: `cargo fuzz run --sanitizer none <target>`.\n"
    );
    for (name, text) in [("fuzz.json", figures + "\n"), ("fuzz.md", page)] {
        let path = results.join(name);
        let partial = path.with_extension("tmp");
        fs::write(&partial, text)?;
        fs::rename(&partial, &path)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_figures_count() {
        let talk = "#2\tINITED cov: 10 ft: 11 corp: 1/1b exec/s: 0 rss: 30Mb\n\
            #9\tDONE   cov: 12 ft: 34 corp: 5/67b lim: 4 exec/s: 4 rss: 31Mb\n\
            stat::number_of_executed_units: 9\nstat::peak_rss_mb:              31\n";
        let outcome = read_talk(talk);
        assert_eq!((outcome.edges, outcome.features, outcome.corpus), (12, 34, 5));
        assert_eq!((outcome.executions, outcome.peak_mib), (9, 31));
    }

    #[test]
    fn targets_are_asked_for_by_name() {
        let all = ["one".to_owned(), "two".to_owned()];
        let parse = |words: &[&str]| {
            let words: Vec<String> = words.iter().map(|word| (*word).to_owned()).collect();
            Options::parse(&words, &all)
        };
        let options = parse(&["two", "--seconds", "5", "--keep"]).unwrap();
        assert_eq!(
            (options.targets.as_slice(), options.seconds, options.keep),
            (&all[1..], 5, true)
        );
        assert_eq!(parse(&[]).unwrap().targets, all);
        for wrong in [
            &["three"][..],
            &["--seconds"],
            &["--seconds", "0"],
            &["--jobs", "x"],
        ] {
            assert!(parse(wrong).is_err(), "{wrong:?}");
        }
    }
}
