//! Time and memory of importing a large CSV log: `cargo xtask bench import`.

use std::fmt::Write as _;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};
use twintac_recording::Import;

use crate::files;

/// Rows of the log.
const ROWS: u32 = 2_000_000;

/// Rows of one press: down, up, and at rest after it.
const PRESS: u32 = 500;

const TAXELS: usize = 8;

/// The result of an import.
#[derive(Serialize, Deserialize)]
struct Imported {
    rows: usize,
    frames: usize,
    presses: usize,
    wall_s: f64,
    /// Time to split the file's cells at commas and to parse them as numbers, in the same process
    /// and on one thread, s.
    reference_s: f64,
    peak_mib: f64,
}

/// Writes a log, imports it in a process of its own, and prints the result.
pub(crate) fn run(as_json: bool) -> Result<()> {
    let folder = tempfile::tempdir()?;
    let log = folder.path().join("log.csv");
    write_log(&log)?;
    let child = Command::new(std::env::current_exe()?)
        .arg("read-log")
        .arg(&log)
        .output()?;
    ensure!(
        child.status.success(),
        "{}",
        String::from_utf8_lossy(&child.stderr)
    );
    let imported: Imported = serde_json::from_slice(&child.stdout)?;
    let mut out = std::io::stdout().lock();
    if as_json {
        return Ok(writeln!(out, "{}", serde_json::to_string(&imported)?)?);
    }
    let mib = std::fs::metadata(&log)?.len() as f64 / f64::from(1 << 20);
    writeln!(
        out,
        "{} rows of {} columns, {mib:.0} MiB: {} frames of {} presses in {:.2} s, {:.1} times a plain parse; {:.0} MiB of memory at most",
        imported.rows,
        TAXELS + 5,
        imported.frames,
        imported.presses,
        imported.wall_s,
        imported.wall_s / imported.reference_s,
        imported.peak_mib
    )?;
    Ok(())
}

/// Imports a log that [`run`] wrote, and prints the result as one JSON line.
pub(crate) fn print_imported(log: &Path) -> Result<()> {
    let import = Import::parse("log", &description())?;
    let started = Instant::now();
    let (recording, mut summary) = import.read_csv(log)?;
    let wall_s = started.elapsed().as_secs_f64();
    let peak_mib = files::peak_memory_mib()?;
    let file = summary.files.pop().context("a file")?;
    let frames = recording.presses.iter().map(|press| press.time_s.len()).sum();
    drop(recording);
    let started = Instant::now();
    let text = std::fs::read_to_string(log)?;
    let cells = text.lines().skip(1).flat_map(|line| line.split(','));
    let sum: f64 = cells.filter_map(|cell| cell.parse::<f64>().ok()).sum();
    let reference_s = started.elapsed().as_secs_f64();
    ensure!(sum.is_finite(), "the sum of all cells is {sum}");
    let imported = Imported {
        rows: file.rows_read,
        frames,
        presses: file.presses,
        wall_s,
        reference_s,
        peak_mib,
    };
    writeln!(std::io::stdout().lock(), "{}", serde_json::to_string(&imported)?)?;
    Ok(())
}

fn description() -> String {
    let mut text = "sensor = \"large\"\nprovenance = \"simulated\"\nindenter = \"ball\"\ngel_top_mm = 8.5\ntime = { column = \"t\" }\n\
        x = { column = \"x\" }\ny = { column = \"y\" }\nz = { column = \"z\" }\nforce = { column = \"f\" }\nreadings = { unit = \"Pa\" }\n\
        presses = { split = \"return-to-rest\", rest_mm = 3.0, keep_rest_s = 0.2 }\nzero = { above_contact_mm = 0.5, window_s = 0.5 }\ntaxels = [\n"
        .to_owned();
    for taxel in 0..TAXELS {
        text += &format!("  {{ name = \"t{taxel}\", column = \"p{taxel}\" }},\n");
    }
    text + "]\n"
}

fn write_log(log: &PathBuf) -> Result<()> {
    let mut out = BufWriter::new(std::fs::File::create(log)?);
    let names: Vec<String> = (0..TAXELS).map(|taxel| format!("p{taxel}")).collect();
    writeln!(out, "t,x,y,z,f,{}", names.join(","))?;
    let mut line = String::new();
    for row in 0..ROWS {
        let place = row % PRESS;
        // Down to -2 mm and up to 3 mm within the first 400 rows, then at rest.
        let z_mm = (f64::from(place.min(400)) / 200.0 - 1.0).abs() * 5.0 - 2.0;
        let force_n = (-z_mm).max(0.0).powf(1.5);
        line.clear();
        write!(
            line,
            "{:.3},1.25,-3.5,{z_mm:.4},{force_n:.5}",
            f64::from(row) * 0.01
        )?;
        for taxel in 0..TAXELS {
            write!(line, ",{:.1}", 101_325.0 + 900.0 * force_n * (taxel + 1) as f64)?;
        }
        writeln!(out, "{line}")?;
    }
    Ok(out.flush()?)
}
