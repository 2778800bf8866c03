//! A process that is killed while it writes.

#![allow(clippy::unwrap_used)] // also in the helpers of tests
#![cfg(unix)]

mod common;

use std::io::{BufRead, BufReader, Read, Write};
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

/// Not a test: this is the process that is killed. It prints the time of each message after it was
/// handed over.
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
    // Waits to be killed, or for the end of the other test. The log is not finished.
    let _ = std::io::stdin().read(&mut [0]);
}

#[test]
fn a_killed_process_leaves_all_that_is_older_than_a_second() {
    let messages = messages();
    // Disks need time: each thread kills ten processes, one after the other.
    let furthest = std::thread::scope(|scope| {
        let kill_ten = |seed| {
            let mut chance = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
            let mut kill = || killed_at(chance.random_range(0..(SECONDS - 1) * NS_PER_S), &messages);
            (0..10).map(|_| kill()).max()
        };
        let threads: Vec<_> = (0..5).map(|seed| scope.spawn(move || kill_ten(seed))).collect();
        threads
            .into_iter()
            .filter_map(|thread| thread.join().unwrap())
            .max()
    });
    assert!(furthest.unwrap() > messages.len() / 2, "some lived long");
}

/// Kills a process when it prints a time, and checks its log. Returns the number of messages in it.
fn killed_at(kill_ns: u64, messages: &[Message]) -> usize {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bench.mcap");
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "writes_until_it_is_killed", "--ignored", "--nocapture"])
        .env(PATH, &path)
        .stdin(Stdio::piped())
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
    let partial = folder.path().join("bench.mcap.partial");
    let mut reader = LogReader::open(&partial).unwrap();
    let back: Vec<Message> = reader.by_ref().map(Result::unwrap).collect();
    assert_eq!(reader.ending(), Some(Ending::Cut));
    assert_eq!(back, messages[..back.len()]);
    let safe = messages.partition_point(|message| message.bench_ns + NS_PER_S < last_ns);
    assert!(back.len() >= safe, "at {last_ns} ns: {} of {safe}", back.len());
    let whole = recover(&partial).unwrap();
    assert_eq!(whole.path, path);
    let mut recovered: Vec<Message> = LogReader::open(&path).unwrap().map(Result::unwrap).collect();
    let cut = recovered.pop().unwrap().body;
    assert!(
        matches!(cut, Body::Event(Event::Gap { .. })),
        "where it was cut is marked"
    );
    assert!(recovered == back, "all else is as it was");
    back.len()
}
