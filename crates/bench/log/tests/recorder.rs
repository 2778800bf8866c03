//! The writing thread: slow disks, full disks, and the end.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

mod common;

use std::io::{self, Write};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread::sleep;
use std::time::{Duration, Instant};

use common::{begun, bench, description, event, reader, wrench};
use twintac_log::{
    Body, Event, LogError, LogReader, Message, Recorder, Sink, Stream, export_frames, recover,
};

type Bytes = Arc<Mutex<Vec<u8>>>;

/// A wait that is longer than any delay of a busy machine.
const LATEST: Duration = Duration::from_secs(60);

/// A disk that the test observes, and that waits for the test before each sync if told to.
struct Disk {
    bytes: Bytes,
    gate: Option<Gate>,
}

/// Announces each sync and then waits for the test. Does not wait any more when the test has
/// dropped its end.
struct Gate {
    announce: Sender<()>,
    open: Receiver<io::Result<()>>,
}

impl Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes.lock().unwrap().extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Sink for Disk {
    fn sync(&mut self) -> io::Result<()> {
        match &self.gate {
            Some(gate) => {
                let _ = gate.announce.send(());
                gate.open.recv().unwrap_or(Ok(()))
            }
            None => Ok(()),
        }
    }

    fn complete(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn name(&self) -> String {
        "disk".to_owned()
    }
}

/// A recorder whose disk syncs once for the description, and then whenever the test allows it. The
/// test is told of each sync that begins.
struct Gated {
    recorder: Recorder,
    bytes: Bytes,
    open: Sender<io::Result<()>>,
    syncs: Receiver<()>,
}

fn gated(capacity: usize) -> Gated {
    let bytes = Arc::new(Mutex::new(Vec::new()));
    let (announce, syncs) = channel();
    let (open, opened) = channel();
    open.send(Ok(())).unwrap();
    let disk = Disk {
        bytes: Arc::clone(&bytes),
        gate: Some(Gate {
            announce,
            open: opened,
        }),
    };
    let recorder = Recorder::start(disk, &description(2), capacity).unwrap();
    syncs.recv().unwrap();
    Gated {
        recorder,
        bytes,
        open,
        syncs,
    }
}

fn messages(bytes: &Mutex<Vec<u8>>) -> Vec<Message> {
    reader(&bytes.lock().unwrap()).map(Result::unwrap).collect()
}

#[test]
fn a_file_has_its_name_only_when_it_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bench.mcap");
    let partial = folder.path().join("bench.mcap.partial");
    let recorder = Recorder::create(&path, &description(2)).unwrap();
    assert!(partial.exists() && !path.exists());
    let taken = Recorder::create(&path, &description(2)).unwrap_err();
    assert!(matches!(taken, LogError::Exists { .. }), "{taken}");
    let sent = bench(2, 2, [50, 50, 50]);
    let sender = recorder.sender();
    for message in &sent {
        sender.send(message.clone()).unwrap();
        // A message that cannot be written is an error of its sender, and does not end the log.
        let wrong = sender.send(common::frame(0, 3)).unwrap_err();
        assert!(matches!(wrong, LogError::Invalid { .. }), "{wrong}");
    }
    let recorded = recorder.finish().unwrap();
    assert!(path.exists() && !partial.exists());
    assert_eq!((recorded.messages, recorded.lost), (sent.len() as u64, 0));
    assert_eq!(recorded.bytes, path.metadata().unwrap().len());
    let back: Vec<Message> = LogReader::open(&path).unwrap().map(Result::unwrap).collect();
    assert_eq!(back, sent);
    let late = sender.send(sent[0].clone()).unwrap_err();
    assert_eq!(
        late.to_string(),
        "the log takes no more messages: it was finished"
    );
    let taken = Recorder::create(&path, &description(2)).unwrap_err();
    assert!(matches!(taken, LogError::Exists { .. }), "{taken}");
}

#[test]
fn a_disk_that_does_not_keep_up_is_said_aloud_and_marked() {
    let Gated {
        recorder,
        bytes,
        open,
        syncs,
    } = gated(10);
    let sender = recorder.sender();
    // The second message is half a second of the bench clock later than the first: the thread
    // syncs, and waits for the disk.
    sender.send(wrench(0, 1.0)).unwrap();
    sender.send(wrench(600_000_000, 1.0)).unwrap();
    syncs.recv().unwrap();
    while sender.queued() > 0 {
        // On a busy machine the first message was flushed alone, because no message followed it for
        // long enough.
        open.send(Ok(())).unwrap();
        syncs.recv().unwrap();
    }
    let mut lost = Vec::new();
    for step in 1..=50 {
        let time_ns = 600_000_000 + step * 1000;
        match sender.send(wrench(time_ns, 1.0)) {
            Ok(()) => {}
            Err(LogError::Behind { stream, queued }) => {
                assert_eq!((stream, queued), (Stream::Wrench, 10));
                lost.push(time_ns);
            }
            Err(error) => panic!("{error}"),
        }
    }
    assert_eq!(lost.len(), 40);
    // Events have additional room.
    sender.send(event(600_060_000, begun("p"))).unwrap();
    drop(open);
    let recorded = recorder.finish().unwrap();
    assert_eq!((recorded.messages, recorded.lost), (13, 40));
    let back = messages(&bytes);
    let gaps: Vec<&Event> = back
        .iter()
        .filter_map(|message| match &message.body {
            Body::Event(gap @ Event::Gap { .. }) => Some(gap),
            _ => None,
        })
        .collect();
    let gap = Event::Gap {
        stream: Some(Stream::Wrench),
        cause: "the disk did not keep up".to_owned(),
        from_ns: lost[0],
        to_ns: lost[39],
        lost: Some(40),
    };
    assert_eq!(gaps, [&gap]);
    assert_eq!(back.len(), 14);
}

#[test]
fn a_disk_that_fails_stops_the_log_aloud() {
    let Gated {
        recorder,
        bytes,
        open,
        syncs: _syncs,
    } = gated(100);
    let sender = recorder.sender();
    open.send(Ok(())).unwrap();
    open.send(Err(io::Error::from(io::ErrorKind::StorageFull)))
        .unwrap();
    let begin = Instant::now();
    let mut time_ns = 0;
    let why = loop {
        match sender.send(wrench(time_ns, 1.0)) {
            Ok(()) => time_ns += 400_000_000,
            Err(LogError::Behind { .. }) => {}
            Err(error) => break error.to_string(),
        }
        sleep(Duration::from_millis(1));
        assert!(begin.elapsed() < LATEST, "silence");
    };
    assert!(
        why.starts_with("the log takes no more messages: cannot write disk:"),
        "{why}"
    );
    let error = recorder.finish().unwrap_err();
    assert!(matches!(error, LogError::Write { .. }), "{error}");
    assert!(messages(&bytes).len() >= 2, "what was flushed is there");
}

#[test]
fn what_waits_is_flushed_when_nothing_follows() {
    let bytes = Arc::new(Mutex::new(Vec::new()));
    let disk = Disk {
        bytes: Arc::clone(&bytes),
        gate: None,
    };
    let recorder = Recorder::start(disk, &description(2), 10).unwrap();
    recorder.sender().send(wrench(0, 1.0)).unwrap();
    let begin = Instant::now();
    while messages(&bytes).is_empty() {
        sleep(Duration::from_millis(20));
        assert!(begin.elapsed() < LATEST);
    }
    drop(recorder);
    assert!(
        bytes.lock().unwrap().ends_with(b"\x89MCAP0\r\n"),
        "finished when dropped"
    );
}

#[test]
fn many_threads_send_and_nothing_is_lost_in_silence() {
    let bytes = Arc::new(Mutex::new(Vec::new()));
    let disk = Disk {
        bytes: Arc::clone(&bytes),
        gate: None,
    };
    let recorder = Recorder::start(disk, &description(2), 64).unwrap();
    let threads: Vec<_> = (0..4_u64)
        .map(|thread| {
            let sender = recorder.sender();
            std::thread::spawn(move || {
                let send = |step: u64| sender.send(wrench(4 * step * 1000 + thread, 1.0));
                (0..5000).filter(|step| send(*step).is_ok()).count() as u64
            })
        })
        .collect();
    let taken: u64 = threads.into_iter().map(|thread| thread.join().unwrap()).sum();
    let recorded = recorder.finish().unwrap();
    assert_eq!(
        (recorded.messages, recorded.messages + recorded.lost),
        (taken, 20_000)
    );
    let back = messages(&bytes);
    let wrenches = back.iter().filter(|message| message.stream() == Stream::Wrench);
    assert_eq!(wrenches.count() as u64, taken);
    let lost = back.iter().filter_map(|message| match &message.body {
        Body::Event(Event::Gap { lost, .. }) => *lost,
        _ => None,
    });
    assert_eq!(lost.sum::<u64>(), recorded.lost);
}

#[test]
fn what_was_taken_while_the_log_is_finished_is_in_it() {
    for _ in 0..20 {
        let disk = Disk {
            bytes: Arc::default(),
            gate: None,
        };
        let recorder = Recorder::start(disk, &description(2), 64).unwrap();
        let threads: Vec<_> = (0..3_u64)
            .map(|thread| {
                let sender = recorder.sender();
                std::thread::spawn(move || {
                    let mut taken = 0;
                    for step in 0.. {
                        match sender.send(wrench(4 * step * 1000 + thread, 1.0)) {
                            Ok(()) => taken += 1,
                            Err(LogError::Behind { .. }) => {}
                            Err(_) => break,
                        }
                    }
                    taken
                })
            })
            .collect();
        sleep(Duration::from_millis(5));
        let recorded = recorder.finish().unwrap();
        let taken: u64 = threads.into_iter().map(|thread| thread.join().unwrap()).sum();
        assert_eq!(recorded.messages, taken);
    }
}

#[test]
fn recovering_makes_a_whole_file_and_keeps_the_old_one() {
    let folder = tempfile::tempdir().unwrap();
    let sent = bench(3, 2, [50, 50, 50]);
    let whole = common::log(&description(2), &sent);
    let cut = folder.path().join("bench.mcap.partial");
    std::fs::write(&cut, &whole[..whole.len() / 2]).unwrap();
    let recovered = recover(&cut).unwrap();
    assert_eq!(recovered.path, folder.path().join("bench.mcap"));
    assert_eq!(recovered.ending, twintac_log::Ending::Cut);
    let bytes = std::fs::read(&recovered.path).unwrap();
    assert!(mcap::Summary::read(&bytes).unwrap().is_some());
    let mut back: Vec<Message> = reader(&bytes).map(Result::unwrap).collect();
    let cut = back.pop().unwrap();
    assert!(
        matches!(cut.body, Body::Event(Event::Gap { stream: None, .. })),
        "{cut:?}"
    );
    assert_eq!(back, sent[..back.len()]);
    assert!(back.len() as u64 == recovered.messages && back.len() > sent.len() / 4);
    let cut = folder.path().join("bench.mcap.partial");
    assert!(matches!(recover(&cut).unwrap_err(), LogError::Exists { .. }));
    // A log that is complete gives the same bytes again, under another name.
    let path = folder.path().join("old.mcap");
    std::fs::write(&path, &whole).unwrap();
    let again = recover(&path).unwrap();
    assert_eq!(again.path, folder.path().join("old.recovered.mcap"));
    assert_eq!(std::fs::read(&again.path).unwrap(), whole);
    let nothing = folder.path().join("nothing.mcap.partial");
    std::fs::write(&nothing, "").unwrap();
    assert!(matches!(recover(&nothing).unwrap_err(), LogError::NotALog { .. }));
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().count(),
        5,
        "nothing half-written"
    );
}

#[test]
fn a_cut_log_becomes_a_table_of_what_was_flushed() {
    let folder = tempfile::tempdir().unwrap();
    let sent = bench(3, 2, [50, 50, 50]);
    let whole = common::log(&description(2), &sent);
    let (log, table) = (
        folder.path().join("bench.mcap"),
        folder.path().join("bench.parquet"),
    );
    let frames = |messages: &[Message]| {
        let tactile = messages
            .iter()
            .filter(|message| message.stream() == Stream::Tactile);
        tactile.count() as u64
    };
    std::fs::write(&log, &whole).unwrap();
    let all = export_frames(&log, &table).unwrap();
    assert_eq!(
        (all.frames, all.ending),
        (frames(&sent), twintac_log::Ending::Whole)
    );
    assert!(std::fs::read(&table).unwrap().ends_with(b"PAR1"));
    std::fs::write(&log, &whole[..whole.len() / 2]).unwrap();
    let some = export_frames(&log, &table).unwrap();
    let back: Vec<Message> = reader(&whole[..whole.len() / 2]).map(Result::unwrap).collect();
    assert_eq!(
        (some.frames, some.ending),
        (frames(&back), twintac_log::Ending::Cut)
    );
    assert!(some.frames > 0 && some.frames < all.frames);
}
