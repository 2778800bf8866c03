//! From the emulated sensor to a log, with rows and without.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

mod common;

use std::path::Path;
use std::sync::atomic::AtomicBool;

use common::reader;
use twintac_live::{About, Format, StopAfter, TouchRecording, record_frames, stream_rows};
use twintac_log::{Body, Ending, LogReader, TactileFrame};
use twintac_source::FrameSource;

/// The tactile frames of a log, and how it ends.
fn frames(path: &Path) -> (Vec<TactileFrame>, Option<Ending>) {
    let mut reader = LogReader::open(path).unwrap();
    let messages = reader.by_ref().map(|message| message.unwrap().body);
    let frames = messages.filter_map(|body| match body {
        Body::Tactile(frame) => Some(frame),
        _ => None,
    });
    (frames.collect(), reader.ending())
}

/// A source that misses no frame, and a log of it.
fn begin(path: &Path) -> (FrameSource, About, TouchRecording) {
    let (reader, about) = reader(&[]);
    let source = FrameSource::start(reader, 100_000).unwrap();
    let log = TouchRecording::create(path, &about).unwrap();
    (source, about, log)
}

fn first(n_frames: u64) -> StopAfter {
    StopAfter {
        frames: Some(n_frames),
        ..StopAfter::default()
    }
}

#[test]
fn what_is_recorded_is_what_the_rows_say() {
    let folder = tempfile::tempdir().unwrap();
    let (path, alone) = (folder.path().join("rows.mcap"), folder.path().join("alone.mcap"));
    let (mut source, about, mut log) = begin(&path);
    let mut out = Vec::new();
    let streamed = stream_rows(
        &mut source,
        &about,
        Format::Csv,
        first(80),
        &mut out,
        Some(&mut log),
    )
    .unwrap();
    assert_eq!((streamed.rows, log.frames(), log.finish().unwrap()), (80, 80, 80));
    let (found, ending) = frames(&path);
    assert_eq!(ending, Some(Ending::Whole));
    let csv = String::from_utf8(out).unwrap();
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let column = lines
        .next()
        .unwrap()
        .iter()
        .position(|name| *name == "t3_counts")
        .unwrap();
    let counts: Vec<String> = lines.map(|line| line[column].to_owned()).collect();
    let recorded: Vec<String> = found
        .iter()
        .map(|frame| frame.taxels[3].counts.unwrap().to_string())
        .collect();
    assert_eq!(counts, recorded);
    assert!(path.with_extension("parquet").is_file());

    let (mut source, _, mut log) = begin(&alone);
    let streamed = record_frames(&mut source, &mut log, first(80)).unwrap();
    assert_eq!((streamed.rows, log.finish().unwrap()), (80, 80));
    assert_eq!(frames(&alone).0, found);
}

#[test]
fn a_log_ends_when_it_is_asked_to_or_after_its_time() {
    static ASKED: AtomicBool = AtomicBool::new(true);
    let folder = tempfile::tempdir().unwrap();
    let (mut source, _, mut log) = begin(&folder.path().join("asked.mcap"));
    let asked = StopAfter {
        asked: Some(&ASKED),
        ..StopAfter::default()
    };
    assert_eq!(record_frames(&mut source, &mut log, asked).unwrap().rows, 0);
    assert_eq!(log.finish().unwrap(), 0);

    let (mut source, _, mut log) = begin(&folder.path().join("timed.mcap"));
    let timed = StopAfter {
        seconds: Some(1.5),
        ..StopAfter::default()
    };
    let streamed = record_frames(&mut source, &mut log, timed).unwrap();
    assert!((1.45..1.5).contains(&streamed.seconds), "{streamed:?}");
    assert_eq!(log.finish().unwrap(), streamed.rows);
}

#[test]
fn a_log_never_replaces_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    std::fs::write(&path, "kept").unwrap();
    let (_, about) = reader(&[]);
    let problem = TouchRecording::create(&path, &about).unwrap_err().to_string();
    assert!(problem.contains("log.mcap exists already"), "{problem}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "kept");
}
