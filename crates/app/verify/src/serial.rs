//! Frames over a serial line for minutes, a thousand of sixteen taxels a second, through a
//! pseudo-terminal: `cargo xtask bench serial`.

#![allow(clippy::print_stderr)] // a tool for people at a terminal

use std::io::Write;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow, ensure};
use serde::{Deserialize, Serialize};
use serialport::{SerialPort, TTYPort};
use twintac_line::{Checksum, Description};
use twintac_source::{FrameSource, LineSource, SerialLine, SourceError};

use crate::files::write_whole;

/// Folder of the results.
const RESULTS: &str = "docs/benchmarks";
const TAXELS: usize = 16;
const RATE_HZ: f64 = 1000.0;
/// Tolerance of a pressure, Pa. The line carries whole Pa; only rounding is accepted.
const LAST_DIGIT_PA: f64 = 1e-6;
/// A frame counts as late beyond this delay, s.
const LATE_S: f64 = 0.02;

#[derive(clap::Args)]
pub(crate) struct Options {
    /// Duration, s
    #[arg(long, default_value_t = 600)]
    seconds: u64,
}

/// The results.
#[derive(Serialize, Deserialize)]
struct Results {
    command: String,
    provenance: String,
    taxels: usize,
    rate_hz: f64,
    seconds: f64,
    sent: u64,
    heard: u64,
    /// Missing frames that the reader marked.
    lost_marked: u64,
    /// Missing frames without a mark.
    lost_unmarked: u64,
    /// Frames with other values than were sent.
    wrong: u64,
    /// Delay of frames relative to the quickest frame, ms.
    latency_median_ms: f64,
    latency_99_ms: f64,
    latency_worst_ms: f64,
}

pub(crate) fn run(options: &Options) -> Result<()> {
    let (mut board, computer) = TTYPort::pair().context("making a pseudo-terminal")?;
    let path = computer.name().context("a pseudo-terminal without a name")?;
    let text = format!(
        "form = \"text\"\nfields = [\"sequence\", \"time\", \"pressure * {TAXELS}\"]\ntext.checksum = \"crc8\"\ntime.unit = \"us\"\npressure.unit = \"Pa\"\nserial.baud = 2000000"
    );
    let line = Description::parse("bench", &text)?;
    let start = Instant::now();
    let clock = Box::new(move || start.elapsed().as_micros() as u64);
    let source = LineSource::new(SerialLine::open(&path, &line)?, &line, TAXELS, clock)?;
    let mut source = FrameSource::start(source, FrameSource::USUAL_CAPACITY)?;
    let n_sent = options.seconds * RATE_HZ as u64;
    let writer = std::thread::spawn(move || -> std::io::Result<TTYPort> {
        for frame in 0..n_sent {
            let due = Duration::from_secs_f64(frame as f64 / RATE_HZ);
            std::thread::sleep(due.saturating_sub(start.elapsed()));
            board.write_all(sent(frame, start.elapsed().as_micros() as u64).as_bytes())?;
        }
        Ok(board)
    });
    let (mut heard, mut wrong, mut latencies_s) = (0, 0, Vec::new());
    let (mut said, mut n_numbered) = (0, 0);
    while n_numbered < n_sent {
        let reading = match source.next(Duration::from_millis(500)) {
            Ok(Some(reading)) => reading,
            Ok(None) => continue,
            Err(SourceError::Wire { problem }) => {
                eprintln!("{problem}");
                break;
            }
            Err(error) => return Err(error.into()),
        };
        heard += 1;
        n_numbered = reading.sequence + 1;
        let is_right = (0..TAXELS).all(|taxel| {
            let sent_pa = f64::from(pressure_pa(reading.sequence, taxel));
            let heard_pa = reading.frame.taxels.get(taxel).and_then(|of| of.pressure_pa);
            heard_pa.is_some_and(|heard_pa| (heard_pa - sent_pa).abs() < LAST_DIGIT_PA)
        });
        wrong += u64::from(!is_right);
        latencies_s.push(start.elapsed().as_secs_f64() - reading.frame.triggered_us as f64 * 1e-6);
        if start.elapsed().as_secs() / 60 > said {
            said = start.elapsed().as_secs() / 60;
            eprintln!("{said} min: {heard} frames");
        }
    }
    // Numbers of frames count missing frames too.
    let lost_marked = n_numbered - heard;
    drop(writer.join().map_err(|_| anyhow!("the board's thread died"))??);
    drop(computer);
    latencies_s.sort_by(f64::total_cmp);
    ensure!(!latencies_s.is_empty(), "no frame came");
    let at = |part: f64| 1e3 * latencies_s[((latencies_s.len() - 1) as f64 * part) as usize];
    let results = Results {
        command: format!("cargo xtask bench serial --seconds {}", options.seconds),
        provenance: "emulated".to_owned(),
        taxels: TAXELS,
        rate_hz: RATE_HZ,
        seconds: options.seconds as f64,
        sent: n_sent,
        heard,
        lost_marked,
        lost_unmarked: n_sent - n_numbered.min(n_sent),
        wrong,
        latency_median_ms: at(0.5),
        latency_99_ms: at(0.99),
        latency_worst_ms: at(1.0),
    };
    let late = latencies_s
        .iter()
        .filter(|latency_s| **latency_s > LATE_S)
        .count();
    eprintln!(
        "{heard} of {n_sent} frames; {lost_marked} missing and marked; {wrong} wrong; {late} later than {} ms",
        1e3 * LATE_S
    );
    let folder = Path::new(RESULTS);
    write_whole(
        &folder.join("serial.json"),
        (serde_json::to_string_pretty(&results)? + "\n").as_bytes(),
    )?;
    write_whole(&folder.join("serial.md"), page(&results).as_bytes())
}

/// The pressure of a taxel in a frame, Pa; it differs from frame to frame.
fn pressure_pa(frame: u64, taxel: usize) -> u32 {
    100_000 + (frame * 31 + taxel as u64 * 7) as u32 % 50_000
}

/// The line that the board writes for a frame.
fn sent(frame: u64, now_us: u64) -> String {
    let pressures: Vec<String> = (0..TAXELS)
        .map(|taxel| pressure_pa(frame, taxel).to_string())
        .collect();
    // A 32-bit counter that overflows within the hour.
    let body = format!(
        "{frame},{},{}",
        (now_us + 4_290_000_000) as u32,
        pressures.join(",")
    );
    format!("{body}*{:02x}\r\n", Checksum::Crc8.of(body.as_bytes()))
}

fn page(results: &Results) -> String {
    let Results {
        command,
        taxels,
        rate_hz,
        seconds,
        sent,
        heard,
        lost_marked,
        lost_unmarked,
        wrong,
        latency_median_ms,
        latency_99_ms,
        latency_worst_ms,
        ..
    } = results;
    format!(
        "# Frames over a serial line\n\nWritten by `{command}`: {rate_hz} frames of {taxels} taxels a second for {seconds} s, as lines with a number, a 32-bit clock that rolls over and a checksum, through a \
         pseudo-terminal. Emulated.\n\n| | |\n|---|---|\n| sent | {sent} |\n| received | {heard} |\n| missing and marked | {lost_marked} |\n| missing and not marked | {lost_unmarked} |\n| wrong | {wrong} |\n| delay \
         relative to the fastest frame, median | {latency_median_ms:.2} ms |\n| 99th percentile | {latency_99_ms:.2} ms |\n| largest | {latency_worst_ms:.1} ms |\n"
    )
}
