//! Messages are read as they were written, by this crate and by the format's own library.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

mod common;

use std::collections::BTreeMap;

use common::{bench, description, event, log, reader};
use glam::DVec3;
use twintac_log::{Ending, Event, LogError, LogReader, LogWriter, Stream};

#[test]
fn messages_come_back_bit_for_bit_in_their_order() {
    let description = description(8);
    let mut messages = bench(3, 8, [100, 500, 50]);
    messages.swap(40, 90); // each stream comes from its own thread
    messages.push(event(
        5,
        Event::Gap {
            stream: Some(Stream::Wrench),
            cause: "\"quoted\" µ".to_owned(),
            from_ns: 1,
            to_ns: u64::MAX,
            lost: None,
        },
    ));
    let bytes = log(&description, &messages);
    let mut reader = reader(&bytes);
    assert_eq!(reader.description(), &description);
    let back: Vec<_> = reader.by_ref().map(Result::unwrap).collect();
    assert_eq!(back, messages);
    assert_eq!(reader.ending(), Some(Ending::Whole));
    assert_eq!(bytes, log(&description, &messages), "the same bytes");
}

#[test]
fn the_formats_own_library_finds_the_same() {
    let description = description(2);
    let messages = bench(3, 2, [50, 200, 20]);
    let bytes = log(&description, &messages);
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let mut counts = BTreeMap::new();
    let mut last_ns = 0;
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        *counts.entry(message.channel.topic.clone()).or_insert(0_u64) += 1;
        assert_eq!(message.channel.message_encoding, "cdr");
        assert_eq!(message.channel.schema.as_ref().unwrap().encoding, "ros2msg");
        last_ns = message.log_time;
    }
    let written = |stream| messages.iter().filter(|m| m.stream() == stream).count() as u64;
    let [tactile, wrench, pose, events] =
        [Stream::Tactile, Stream::Wrench, Stream::Pose, Stream::Event].map(written);
    for (topic, count) in [
        ("/events", events),
        ("/tactile/frame", tactile),
        ("/tactile/S0/temperature", tactile),
        ("/tactile/S1/pressure", tactile),
        ("/wrench/sample", wrench),
        ("/wrench", wrench),
        ("/robot/pose/sample", pose),
        ("/robot/pose", pose),
    ] {
        assert_eq!(counts[topic], count, "{topic}");
    }
    assert!(
        counts["/tactile/S0/pressure"] < tactile,
        "saturated ones have none"
    );
    let statistics = summary.stats.as_ref().unwrap();
    assert_eq!(statistics.message_count, counts.values().sum::<u64>());
    assert_eq!(statistics.message_end_time, last_ns);
    assert_eq!(statistics.channel_count, 10);
    assert_eq!(statistics.metadata_count, 1);
    assert_eq!(statistics.chunk_count as usize, summary.chunk_indexes.len());
    for index in &summary.chunk_indexes {
        // A chunk holds at most half a second.
        assert!(index.message_end_time - index.message_start_time < common::NS_PER_S / 2);
        let found = summary.read_message_indexes(&bytes, index).unwrap();
        for (channel, entries) in found {
            for entry in entries {
                let message = summary.seek_message(&bytes, index, &entry).unwrap();
                assert_eq!(
                    (message.log_time, message.channel.id),
                    (entry.log_time, channel.id)
                );
            }
        }
    }
    let metadata = &summary.metadata_indexes[0];
    assert_eq!(metadata.name, "twintac");
    let record = mcap::read::metadata(&bytes, metadata).unwrap();
    assert_eq!(record.metadata["provenance"], "\"emulated\"");
}

#[test]
fn every_checksum_holds_by_the_formats_own_library() {
    let bytes = log(&description(2), &bench(2, 2, [20, 20, 20]));
    let options = mcap::sans_io::LinearReaderOptions::default()
        .with_validate_chunk_crcs(true)
        .with_validate_data_section_crc(true)
        .with_validate_summary_section_crc(true);
    let mut reader = mcap::sans_io::LinearReader::new_with_options(options);
    let mut rest = &bytes[..];
    let mut checksums = Vec::new();
    while let Some(event) = reader.next_event() {
        match event.unwrap() {
            mcap::sans_io::LinearReadEvent::ReadRequest(wanted) => {
                let given = wanted.min(rest.len());
                reader.insert(given).copy_from_slice(&rest[..given]);
                reader.notify_read(given);
                rest = &rest[given..];
            }
            // The checksums of the footer and of the data are last in their records. A checksum of
            // 0 would mean none.
            mcap::sans_io::LinearReadEvent::Record { data, opcode } => {
                if [mcap::records::op::DATA_END, mcap::records::op::FOOTER].contains(&opcode) {
                    checksums.push(data[data.len() - 4..].to_vec());
                }
            }
        }
    }
    assert!(rest.is_empty());
    assert_eq!(checksums.len(), 2);
    assert!(!checksums.contains(&vec![0; 4]));
    // The summary's checksum covers the bytes from its first record to the checksum itself, which
    // is in the footer, before the final magic.
    let end = bytes.len() - 8 - 4;
    let start = u64::from_le_bytes(bytes[end - 16..end - 8].try_into().unwrap()) as usize;
    assert_eq!(
        crc32fast::hash(&bytes[start..end]).to_le_bytes(),
        bytes[end..end + 4]
    );
}

#[test]
fn a_log_without_messages_is_whole() {
    let bytes = log(&description(0), &[]);
    assert!(mcap::Summary::read(&bytes).unwrap().is_some());
    let mut reader = reader(&bytes);
    assert!(reader.next().is_none());
    assert_eq!(reader.ending(), Some(Ending::Whole));
}

#[test]
fn what_cannot_be_written_is_refused_and_the_next_message_is_not() {
    let description = description(2);
    let mut writer = LogWriter::new(Vec::new(), &description).unwrap();
    let tare = Event::Tare {
        force_n: DVec3::new(f64::NAN, 0.0, 0.0),
        torque_n_mm: DVec3::ZERO,
    };
    for (message, words) in [
        (common::frame(0, 3), "tactile frame: has 3 taxels, expected 2"),
        (event(0, tare), "event: a number is not finite"),
        (
            common::pose(u64::MAX, 0.0),
            "bench_ns: the time is beyond 64 bits",
        ),
    ] {
        assert_eq!(writer.write(&message).unwrap_err().to_string(), words);
    }
    let late = twintac_log::Message::at_s(1.5, common::frame(0, 2).body);
    assert_eq!(late.bench_ns, 1_500_000_000);
    writer.write(&late).unwrap();
    assert_eq!(reader(&writer.finish().unwrap()).count(), 1);
}

#[test]
fn descriptions_that_contradict_themselves_are_refused() {
    let base = description(2);
    let mut doubled = base.clone();
    doubled.taxels[1] = "S0".to_owned();
    let mut turned = base.clone();
    turned.base_from_gel.rotation.w = 2.0;
    let mut scaled = base.clone();
    scaled.transfer.as_mut().unwrap().pa_per_count = f64::NAN;
    let mut nowhere = base.clone();
    nowhere.tool_from_indenter.position_mm.x = f64::INFINITY;
    let mut aimless = base.clone();
    aimless.force_axis = DVec3::ZERO;
    for (description, field) in [
        (doubled, "taxels"),
        (turned, "base_from_gel"),
        (scaled, "transfer"),
        (nowhere, "tool_from_indenter"),
        (aimless, "force_axis"),
    ] {
        let error = LogWriter::new(Vec::new(), &description).unwrap_err();
        assert!(
            matches!(error, LogError::Invalid { what, .. } if what == field),
            "{error}"
        );
    }
}

#[test]
fn other_files_are_refused_by_what_is_wrong() {
    let problem = |bytes: &[u8]| LogReader::new(bytes, "x.mcap").unwrap_err().to_string();
    let intro = "x.mcap is not a readable log: ";
    assert_eq!(problem(b""), format!("{intro}it does not start as an MCAP file"));
    assert_eq!(
        problem(b"PAR1 and more"),
        format!("{intro}it does not start as an MCAP file")
    );
    let foreign = {
        let mut writer = mcap::Writer::new(std::io::Cursor::new(Vec::new())).unwrap();
        writer.finish().unwrap();
        writer.into_inner().into_inner()
    };
    assert_eq!(
        problem(&foreign),
        format!("{intro}it has no description at its start")
    );
    let bytes = log(&description(1), &[]);
    assert_eq!(
        problem(&bytes[..200]),
        format!("{intro}it ends before its description")
    );
    let version = bytes
        .windows(11)
        .position(|window| window == b"log_version")
        .unwrap();
    let mut newer = bytes.clone();
    newer[version + 15] = b'9';
    assert_eq!(
        problem(&newer),
        format!("{intro}its log version is 9, expected 1")
    );
}
