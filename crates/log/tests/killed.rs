//! A process that is killed while it writes.

#![allow(clippy::unwrap_used)] // also in the helpers of tests
#![cfg(unix)]

mod common;

use std::io::{BufRead, BufReader, Write};
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, Stdio};

use common::{NS_PER_S, bench, description};
use rand::{Rng, SeedableRng};
use twintac_log::{Body, Ending, Event, LogFile, LogReader, LogWriter, Message, recover};

const PATH: &str = "TWINTAC_LOG_TO_BE_KILLED";
const SECONDS: u64 = 30;

fn messages() -> Vec<Message> {
    bench(SECONDS, 8, [55, 200, 100])
}

/// Not a test of its own: the process that is killed. It says each message's time before it hands the next one over.
#[test]
#[ignore = "started by the other test"]
fn writes_until_it_is_killed() {
    let path = std::env::var_os(PATH).unwrap();
    let mut writer = LogWriter::new(LogFile::create(Path::new(&path)).unwrap(), &description(8)).unwrap();
    let mut progress = std::io::stderr().lock();
    for message in messages() {
        writer.write(&message).unwrap();
        writeln!(progress, "{}", message.bench_ns).unwrap();
    }
    // Not finished: the log of a bench that is killed never is.
    loop {
        std::thread::park();
    }
}

#[test]
fn a_killed_process_leaves_all_that_is_older_than_a_second() {
    let folder = tempfile::tempdir().unwrap();
    let messages = messages();
    let mut chance = rand_chacha::ChaCha8Rng::seed_from_u64(5);
    let mut furthest = 0;
    for turn in 0..50 {
        let path = folder.path().join(format!("{turn}.mcap"));
        let kill_ns = chance.random_range(0..SECONDS * NS_PER_S);
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "writes_until_it_is_killed", "--ignored", "--nocapture"])
            .env(PATH, &path)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut last_ns = 0;
        for line in BufReader::new(child.stderr.take().unwrap()).lines() {
            last_ns = line.unwrap().parse().unwrap();
            if last_ns >= kill_ns {
                break;
            }
        }
        child.kill().unwrap();
        assert_eq!(child.wait().unwrap().signal(), Some(9), "killed, not ended");
        let partial = folder.path().join(format!("{turn}.mcap.partial"));
        let mut reader = LogReader::open(&partial).unwrap();
        let back: Vec<Message> = reader.by_ref().map(Result::unwrap).collect();
        assert_eq!(reader.ending(), Some(Ending::Cut));
        assert_eq!(back, messages[..back.len()]);
        let safe = messages.partition_point(|message| message.bench_ns + NS_PER_S < last_ns);
        assert!(back.len() >= safe, "at {last_ns} ns: {} of {safe}", back.len());
        furthest = furthest.max(back.len());
        let whole = recover(&partial).unwrap();
        let recovered: Vec<Message> = LogReader::open(&whole.path)
            .unwrap()
            .map(Result::unwrap)
            .collect();
        assert_eq!(recovered, back);
        let is_gap = |message: &Message| matches!(message.body, Body::Event(Event::Gap { .. }));
        assert!(!recovered.iter().any(is_gap));
        std::fs::remove_file(&partial).unwrap();
        std::fs::remove_file(&whole.path).unwrap();
    }
    assert!(furthest > messages.len() / 2, "some lived long");
}
