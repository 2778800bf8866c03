//! Measures how many messages a second a recorder writes, and the longest time of handing one over.
//!
//! `cargo run --release -p twintac-log --example throughput -- <folder>` writes one minute of a
//! test setup (8 taxels at 100 Hz, a force sensor at 7 kHz, a robot at 100 Hz) into the folder as
//! fast as the disk accepts it, with two syncs for each second.

#![allow(clippy::print_stdout)] // its results

use std::collections::BTreeMap;
use std::error::Error;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use glam::{DQuat, DVec3};
use twintac_log::{
    Body, Description, LogReader, Message, PoseReading, Recorder, TactileFrame, TaxelReading, TaxelState,
    WrenchReading,
};
use twintac_recording::Provenance;
use twintac_shape::Pose;

const SECONDS: u64 = 60;
const NS_PER_S: u64 = 1_000_000_000;
/// Rate of the force sensor, Hz. The other devices send a message with every seventieth of its
/// readings.
const RATE_HZ: u64 = 7000;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).ok_or("expected a folder")?;
    let path = PathBuf::from(folder).join("throughput.mcap");
    let recorder = Recorder::create(&path, &description())?;
    let sender = recorder.sender();
    let (begin, mut longest) = (Instant::now(), Duration::ZERO);
    for step in 0..SECONDS * RATE_HZ {
        let bench_ns = step * NS_PER_S / RATE_HZ;
        let bodies = if step % 70 == 0 {
            vec![wrench(), tactile(), pose()]
        } else {
            vec![wrench()]
        };
        for body in bodies {
            while sender.queued() > Recorder::USUAL_CAPACITY / 2 {
                std::thread::sleep(Duration::from_micros(100));
            }
            let before = Instant::now();
            sender.send(Message { bench_ns, body })?;
            longest = longest.max(before.elapsed());
        }
    }
    let recorded = recorder.finish()?;
    let seconds = begin.elapsed().as_secs_f64();
    let megabytes = recorded.bytes as f64 / 1e6;
    println!(
        "written: {} messages, {megabytes:.1} MB, in {seconds:.2} s: {:.0} messages/s, {:.1} times as fast as the bench",
        recorded.messages,
        recorded.messages as f64 / seconds,
        SECONDS as f64 / seconds
    );
    println!("longest hand-over: {:.0} µs", longest.as_secs_f64() * 1e6);
    let begin = Instant::now();
    let count = LogReader::open(&path)?.filter(Result::is_ok).count();
    let rate = count as f64 / begin.elapsed().as_secs_f64();
    println!("read: {count} messages, {rate:.0} messages/s");
    std::fs::remove_file(path)?;
    Ok(())
}

fn description() -> Description {
    Description {
        sensor: "phystac".to_owned(),
        sensor_toml: String::new(),
        provenance: Provenance::Emulated,
        taxels: (0..8).map(|taxel| format!("S{taxel}")).collect(),
        transfer: None,
        base_from_gel: Pose::IDENTITY,
        tool_from_indenter: Pose::IDENTITY,
        force_axis: DVec3::NEG_Z,
        start_unix_ns: 0,
        versions: BTreeMap::new(),
    }
}

fn tactile() -> Body {
    let taxel = TaxelReading {
        state: TaxelState::Good,
        read_us: 0,
        counts: Some(3_242_400),
        pressure_pa: Some(101_325.0),
        temperature_c: Some(25.0),
    };
    Body::Tactile(TactileFrame {
        triggered_us: 0,
        taxels: vec![taxel; 8],
    })
}

fn wrench() -> Body {
    Body::Wrench(WrenchReading {
        source_s: Some(0.0),
        sequence: Some(0),
        status: 0,
        lost_before: 0,
        force_n: DVec3::ZERO,
        torque_n_mm: DVec3::ZERO,
    })
}

fn pose() -> Body {
    Body::Pose(PoseReading {
        source_s: None,
        position_mm: DVec3::ZERO,
        base_from_tool: DQuat::IDENTITY,
    })
}
