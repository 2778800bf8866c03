//! Recordings that are killed at random moments.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

use anyhow::{Context, Result};
use rand::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};

use super::lab_bench::{LabBench, read};

/// Longest time from the start to the kill, s: within the second press.
const LATEST_S: f64 = 9.0;

/// The state after the kills.
#[derive(Serialize, Deserialize)]
pub(crate) struct Kills {
    /// Number of recordings that were killed.
    pub(crate) kills: usize,
    /// Number of these that were killed during a press.
    pub(crate) while_recording: usize,
    /// Number of logs that were left.
    pub(crate) logs: usize,
    /// The logs that cannot be opened, with the reason.
    pub(crate) unreadable: Vec<String>,
    /// Time from the last message in the log to the kill, s, of recordings that were killed during
    /// a press.
    pub(crate) missing_s: Vec<f64>,
}

impl Kills {
    pub(crate) fn longest_missing_s(&self) -> f64 {
        self.missing_s.iter().copied().fold(0.0, f64::max)
    }

    pub(crate) fn is_sound(&self) -> bool {
        self.unreadable.is_empty() && self.longest_missing_s() <= 1.0
    }
}

/// Makes `count` recordings, and kills each at a random time; `seed` determines the times.
pub(crate) fn run(bench: &LabBench, count: usize, seed: u64) -> Result<Kills> {
    let mut chance = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    let mut kills = Kills {
        kills: count,
        while_recording: 0,
        logs: 0,
        unreadable: Vec::new(),
        missing_s: Vec::new(),
    };
    for number in 0..count {
        bench.clear()?;
        let mut process = bench.command(None).spawn().context("starting twintac")?;
        std::thread::sleep(Duration::from_secs_f64(chance.random_range(0.2..LATEST_S)));
        let killed_ns = unix_ns(SystemTime::now())?;
        process.kill()?;
        process.wait()?;
        for log in bench.log_files()? {
            kills.logs += 1;
            let is_cut = log.extension().is_some_and(|extension| extension == "partial");
            match read(&log) {
                Err(error) => kills.unreadable.push(format!("{}: {error:#}", log.display())),
                Ok(reading) if is_cut => {
                    kills.while_recording += 1;
                    // If a recording was killed before its first message, the missing time starts
                    // when its file was created.
                    let begun_ns = unix_ns(std::fs::metadata(&log)?.created()?)?;
                    let last_ns = reading.last_unix_ns.unwrap_or(begun_ns);
                    kills
                        .missing_s
                        .push(killed_ns.saturating_sub(last_ns) as f64 * 1e-9);
                }
                Ok(_) => {}
            }
        }
        eprintln!(
            "kill {}: {:.2} s missing at most, {} unreadable",
            number + 1,
            kills.longest_missing_s(),
            kills.unreadable.len()
        );
    }
    Ok(kills)
}

/// Wall-clock time, ns since 1970.
fn unix_ns(time: SystemTime) -> Result<u64> {
    Ok(time.duration_since(UNIX_EPOCH)?.as_nanos() as u64) // fits until the year 2554
}
