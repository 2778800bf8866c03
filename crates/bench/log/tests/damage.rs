//! Logs that were cut or damaged, sinks that fail, and bytes that are no log.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

mod common;

use std::io::{self, Write};

use common::{NS_PER_S, bench, description, log, reader};
use proptest::prelude::*;
use twintac_log::{Body, Ending, Event, LogError, LogReader, LogWriter, Message, Sink, presses};

/// Notes after each message how many bytes have been written, as on a disk.
fn log_with_progress(messages: &[Message]) -> (Vec<u8>, Vec<u64>) {
    let mut writer = LogWriter::new(Vec::new(), &description(2)).unwrap();
    let mut progress = Vec::new();
    for message in messages {
        writer.write(message).unwrap();
        progress.push(writer.written_bytes());
    }
    (writer.finish().unwrap(), progress)
}

#[test]
fn a_log_cut_at_any_byte_has_all_that_was_flushed() {
    let messages = bench(5, 2, [5, 10, 3]);
    let (bytes, progress) = log_with_progress(&messages);
    let start = (0..bytes.len())
        .find(|&end| LogReader::new(&bytes[..end], "cut").is_ok())
        .unwrap();
    assert!(start < 8000, "the description is flushed first: {start}");
    for end in start..=bytes.len() {
        let mut reader = reader(&bytes[..end]);
        let back: Vec<Message> = reader.by_ref().map(Result::unwrap).collect();
        assert_eq!(
            back,
            messages[..back.len()],
            "cut at {end}: nothing else than what was written"
        );
        let ending = if end == bytes.len() {
            Ending::Whole
        } else {
            Ending::Cut
        };
        assert_eq!(reader.ending(), Some(ending), "cut at {end}");
        // The latest message that had been handed over when the byte at the cut was written.
        let handed = progress.partition_point(|written| *written <= end as u64);
        let Some(now_ns) = handed.checked_sub(1).map(|last| messages[last].bench_ns) else {
            continue;
        };
        let flushed = messages[..handed]
            .iter()
            .filter(|message| message.bench_ns + NS_PER_S < now_ns)
            .count();
        assert!(back.len() >= flushed, "cut at {end}: {} of {flushed}", back.len());
    }
}

#[test]
fn every_message_is_flushed_within_a_second_of_the_bench() {
    let messages = bench(6, 2, [10, 20, 5]);
    let mut writer = LogWriter::new(Vec::new(), &description(2)).unwrap();
    let mut waiting: Vec<u64> = Vec::new();
    for message in &messages {
        let before = writer.written_bytes();
        writer.write(message).unwrap();
        if writer.written_bytes() > before {
            waiting.clear();
        }
        waiting.push(message.bench_ns);
        assert!(message.bench_ns - waiting[0] < NS_PER_S);
    }
}

#[test]
fn a_damaged_byte_costs_one_chunk_and_leaves_a_gap() {
    let messages = bench(4, 2, [10, 20, 5]);
    let bytes = log(&description(2), &messages);
    // A force among a chunk's messages. Without the checksum any other number would be valid too.
    let time_ns = 2 * NS_PER_S + NS_PER_S / 2 + 1;
    let force_n = (-(time_ns as f64 * 1e-9)).to_le_bytes();
    let place = bytes.windows(8).position(|window| window == force_n).unwrap();
    let mut damaged = bytes;
    damaged[place] ^= 1;
    let mut reader = reader(&damaged);
    let back: Vec<Message> = reader.by_ref().map(Result::unwrap).collect();
    assert_eq!(reader.ending(), Some(Ending::Damaged));
    let gap = back
        .iter()
        .position(|message| matches!(message.body, Body::Event(Event::Gap { .. })))
        .unwrap();
    let Body::Event(Event::Gap {
        stream: None,
        from_ns,
        to_ns,
        ..
    }) = back[gap].body
    else {
        panic!("{:?}", back[gap]);
    };
    assert!(to_ns - from_ns <= NS_PER_S, "{from_ns} to {to_ns}");
    assert!((from_ns..=to_ns).contains(&time_ns));
    let kept = messages
        .iter()
        .filter(|message| message.bench_ns <= from_ns || message.bench_ns >= to_ns);
    let kept: Vec<&Message> = kept.collect();
    let others: Vec<&Message> = back[..gap].iter().chain(&back[gap + 1..]).collect();
    assert_eq!(others, kept);
}

/// A disk with room for a limited number of bytes.
#[derive(Default)]
struct Full {
    bytes: Vec<u8>,
    room: usize,
}

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = bytes.len().min(self.room - self.bytes.len());
        if taken == 0 && !bytes.is_empty() {
            return Err(io::Error::from(io::ErrorKind::StorageFull));
        }
        self.bytes.extend(&bytes[..taken]);
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The test keeps the disk.
impl Sink for &mut Full {
    fn sync(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn complete(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn name(&self) -> String {
        "disk".to_owned()
    }
}

fn fill(disk: &mut Full, messages: &[Message]) -> Result<(), LogError> {
    let mut writer = LogWriter::new(disk, &description(2))?;
    for message in messages {
        if let Err(error) = writer.write(message) {
            assert!(matches!(error, LogError::Write { .. }), "{error}");
            // Further messages are refused too.
            for _ in 0..2 {
                let again = writer.write(message).unwrap_err();
                assert!(matches!(again, LogError::Stopped { .. }), "{again}");
            }
            assert!(matches!(writer.finish(), Err(LogError::Stopped { .. })));
            return Err(error);
        }
    }
    writer.finish().map(|_| ())
}

#[test]
fn a_disk_that_is_full_at_any_byte_is_an_error_and_keeps_what_it_has() {
    let messages = bench(3, 2, [4, 6, 3]);
    let whole = log(&description(2), &messages);
    for room in 0..whole.len() {
        let mut disk = Full {
            bytes: Vec::new(),
            room,
        };
        let error = fill(&mut disk, &messages).unwrap_err();
        assert!(matches!(error, LogError::Write { .. }), "room {room}: {error}");
        assert_eq!(disk.bytes, whole[..room], "room {room}");
    }
    let mut disk = Full {
        bytes: Vec::new(),
        room: whole.len(),
    };
    fill(&mut disk, &messages).unwrap();
}

/// Reads everything in every way. Whatever is returned must be valid.
fn read(bytes: &[u8]) {
    let Ok(reader) = LogReader::new(bytes, "any") else {
        return;
    };
    let count = reader.take(1_000_000).count();
    assert!(count <= bytes.len());
    if let Ok(reader) = LogReader::new(bytes, "any")
        && let Ok(back) = presses(reader, "any", &Default::default())
    {
        back.recording.check().unwrap();
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn no_bytes_make_the_reader_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        read(&bytes);
        read(&[b"\x89MCAP0\r\n", &bytes[..]].concat());
    }

    /// Bytes after a valid description, with records of valid kinds and small lengths.
    #[test]
    fn no_records_make_the_reader_panic(
        records in prop::collection::vec((0_u8..17, 0_u64..60, prop::collection::vec(any::<u8>(), 0..60)), 0..30),
    ) {
        let mut bytes = log(&description(1), &[]);
        let end = bytes.len() - 8;
        bytes.truncate(end);
        for (kind, length, content) in records {
            bytes.push(kind);
            bytes.extend(length.to_le_bytes());
            bytes.extend(content);
        }
        read(&bytes);
    }

    #[test]
    fn no_altered_bytes_make_the_reader_panic(
        places in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        strips_checksums in any::<bool>(),
    ) {
        let mut bytes = log(&description(2), &bench(2, 2, [10, 10, 10]));
        if strips_checksums {
            strip_checksums(&mut bytes);
        }
        for (place, byte) in places {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        read(&bytes);
    }
}

/// Switches checksums off, so that altered chunks are read: a checksum of 0 means none.
fn strip_checksums(bytes: &mut [u8]) {
    let mut at = 8;
    while at + 9 < bytes.len() {
        let length = u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap()) as usize;
        if bytes[at] == 6 {
            bytes[at + 9 + 24..at + 9 + 28].fill(0);
        }
        at += 9 + length;
    }
}

#[test]
fn zeros_that_a_file_system_leaves_are_an_end() {
    let messages = bench(3, 2, [10, 20, 5]);
    let mut bytes = log(&description(2), &messages);
    let half = bytes.len() / 2;
    bytes[half..].fill(0);
    let mut reader = reader(&bytes);
    let back: Vec<Message> = reader.by_ref().map(Result::unwrap).collect();
    assert_eq!(reader.ending(), Some(Ending::Cut));
    assert!(back.len() > messages.len() / 4);
    let is_whole = |message: &&Message| messages.contains(message);
    assert!(
        back.iter().filter(is_whole).count() + 1 >= back.len(),
        "but for the gap"
    );
}

/// Bytes, and the size of the largest buffer that was offered for them.
struct Watched<'a> {
    bytes: &'a [u8],
    largest: &'a mut usize,
}

impl io::Read for Watched<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        *self.largest = buffer.len().max(*self.largest);
        self.bytes.read(buffer)
    }
}

#[test]
fn lengths_that_are_lies_cost_no_memory() {
    let mut start = log(&description(1), &[]);
    start.truncate(start.len() - 8 - 20 - 9); // without footer and magic
    for kind in 1..=255_u8 {
        for length in [u64::MAX, 1 << 40, (64 << 20) + 1, 64 << 20, 1 << 20] {
            let bytes = [&start[..], &[kind], &length.to_le_bytes(), &[7; 100]].concat();
            let mut largest = 0;
            let source = Watched {
                bytes: &bytes,
                largest: &mut largest,
            };
            let mut reader = LogReader::new(source, "lie").unwrap();
            assert!(reader.next().is_none());
            assert_eq!(reader.ending(), Some(Ending::Cut));
            drop(reader);
            assert!(
                largest <= 64 << 10,
                "kind {kind}, length {length}: {largest} bytes asked for"
            );
        }
    }
}

/// Whether a loss is reported: the message lies in a marked gap, or after the end of a log that
/// says it was cut.
fn is_said(lost: &Message, back: &[Message], ending: Ending) -> bool {
    let is_in_gap = |message: &Message| {
        let Body::Event(Event::Gap {
            stream,
            from_ns,
            to_ns,
            ..
        }) = &message.body
        else {
            return false;
        };
        stream.is_none_or(|stream| stream == lost.stream()) && (*from_ns..=*to_ns).contains(&lost.bench_ns)
    };
    back.iter().any(is_in_gap)
        || ending == Ending::Cut && back.iter().all(|message| message.bench_ns <= lost.bench_ns)
}

#[test]
fn every_flipped_bit_is_said_and_what_it_loses_has_its_gap() {
    let messages = bench(2, 1, [8, 8, 4]);
    let whole = log(&description(1), &messages);
    let mut endings = [0; 4];
    let mut most_lost = 0;
    for bit in 0..8 * whole.len() {
        let mut bytes = whole.clone();
        bytes[bit / 8] ^= 1 << (bit % 8);
        let Ok(mut reader) = LogReader::new(&bytes[..], "flipped") else {
            endings[0] += 1;
            continue;
        };
        let back: Vec<Message> = reader.by_ref().map(Result::unwrap).collect();
        let ending = reader.ending().unwrap();
        assert_ne!(ending, Ending::Whole, "bit {bit} of byte {}", bit / 8);
        endings[1 + usize::from(ending == Ending::Cut)] += 1;
        let lost: Vec<&Message> = messages
            .iter()
            .filter(|message| !back.contains(message))
            .collect();
        for message in &lost {
            assert!(
                is_said(message, &back, ending),
                "bit {bit}: {message:?} is lost without a word: {back:?}"
            );
        }
        if ending == Ending::Damaged {
            most_lost = most_lost.max(lost.len());
        }
        let strange = |message: &&Message| {
            !messages.contains(message) && !matches!(message.body, Body::Event(Event::Gap { .. }))
        };
        assert_eq!(back.iter().find(strange), None, "bit {bit}");
        // Presses cannot be read if all poses are lost. This is reported too.
        let read = presses(reader_of(&bytes), "flipped", &Default::default());
        assert!(
            read.is_err() || read.is_ok_and(|read| !read.remarks.is_empty()),
            "bit {bit}"
        );
    }
    let [refused, damaged, cut, _] = endings;
    assert!(
        damaged > 10 * cut,
        "{refused} refused, {damaged} damaged, {cut} cut"
    );
    assert!(most_lost < messages.len(), "{most_lost} of {}", messages.len());
}

fn reader_of(bytes: &[u8]) -> LogReader<&[u8]> {
    LogReader::new(bytes, "flipped").unwrap()
}

#[test]
fn a_chunk_that_is_taken_for_something_else_leaves_a_gap() {
    let messages = bench(4, 2, [10, 20, 5]);
    let whole = log(&description(2), &messages);
    let chunks = chunks(&whole);
    for (number, place) in chunks.iter().enumerate() {
        for (what, at, flip) in [
            ("kind", 0, 0x40),
            ("kind", 0, 1),
            ("length", 2, 0x10),
            ("length", 4, 1),
        ] {
            let mut bytes = whole.clone();
            bytes[place + at] ^= flip;
            let mut reader = reader(&bytes);
            let back: Vec<Message> = reader.by_ref().map(Result::unwrap).collect();
            let place = format!("{what} of chunk {number} of {}", chunks.len());
            assert_eq!(reader.ending(), Some(Ending::Damaged), "{place}");
            let lost = messages.iter().filter(|message| !back.contains(message));
            let lost: Vec<&Message> = lost.collect();
            assert!(
                lost.iter()
                    .all(|message| is_said(message, &back, Ending::Damaged)),
                "{place}"
            );
            assert!(
                lost.len() * (chunks.len() - 2) < messages.len(),
                "{place}: one chunk, {}",
                lost.len()
            );
        }
    }
    // The table of frames counts the gap, also the gap after the last chunk.
    let folder = tempfile::tempdir().unwrap();
    let (path, table) = (
        folder.path().join("damaged.mcap"),
        folder.path().join("frames.parquet"),
    );
    let mut bytes = whole.clone();
    bytes[chunks[chunks.len() - 1]] ^= 0x40;
    std::fs::write(&path, bytes).unwrap();
    let exported = twintac_log::export_frames(&path, &table).unwrap();
    assert_eq!((exported.ending, exported.gaps), (Ending::Damaged, 1));
    assert!(exported.frames < 40);
}

/// Where chunks begin.
fn chunks(bytes: &[u8]) -> Vec<usize> {
    let (mut at, mut chunks) = (8, Vec::new());
    while at + 9 < bytes.len() {
        if bytes[at] == 6 {
            chunks.push(at);
        }
        at += 9 + u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap()) as usize;
    }
    chunks
}
