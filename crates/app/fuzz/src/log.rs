//! Recorded logs: the container, its messages, and the presses made from them.

use twintac_log::{Body, Description, Event, LogError, LogReader, LogWriter, Message, ReadOptions, presses};

use crate::seeds::{MESSAGE, START_UNIX_NS, log_start};

/// Bytes of a record's kind and length.
const FRAMING_BYTES: usize = 9;

/// Checks the bytes of a file.
pub(crate) fn file(bytes: &[u8]) {
    let Some((description, messages)) = read(bytes) else {
        return;
    };
    let n_most = 1 + 2 * (bytes.len() / FRAMING_BYTES);
    assert!(messages.len() <= n_most, "a message has bytes, and so has damage");
    cut(bytes, &messages);
    let whole = write(&description, &messages);
    let (described, again) = read(&whole).unwrap();
    assert_eq!(described, description);
    assert_eq!(write(&description, &again), whole, "what was read comes back");
    let read = presses(
        LogReader::new(bytes, "log").unwrap(),
        "log",
        &ReadOptions::default(),
    );
    match read {
        Ok(read) => assert_eq!(read.recording.taxels, description.taxels),
        Err(LogError::NoPoses { .. } | LogError::NotALog { .. }) => {}
        Err(other) => panic!("{other}"),
    }
}

/// Checks that a cut file has the messages before the cut.
fn cut(bytes: &[u8], messages: &[Message]) {
    let at = usize::from(*bytes.last().unwrap()) * bytes.len() / 256;
    let Some((_, mut before)) = read(&bytes[..at]) else {
        return;
    };
    // Damage at the end reads as a gap up to the end of the file.
    before.pop_if(|last| matches!(last.body, Body::Event(Event::Gap { stream: None, .. })));
    assert!(before.len() <= messages.len());
    let same = |(one, other): (&Message, &Message)| format!("{one:?}") == format!("{other:?}"); // compared as text, because NaN is not equal to NaN
    assert!(before.iter().zip(messages).all(same));
}

/// Puts a valid container around messages. Each message consists of a channel, a length, a time
/// step, and its bytes.
pub(crate) fn messages(bytes: &[u8]) {
    let mut whole = log_start();
    let (mut rest, mut time_ns) = (bytes, START_UNIX_NS);
    while let Some(([channel, length, steps], after)) = rest.split_first_chunk() {
        let (data, after) = after.split_at(usize::from(*length).min(after.len()));
        rest = after;
        time_ns += u64::from(*steps) * 1_000_000;
        let content_bytes = (22 + data.len()) as u64;
        whole.push(MESSAGE);
        whole.extend(content_bytes.to_le_bytes());
        whole.extend((1 + u16::from(channel % 4)).to_le_bytes());
        whole.extend([0; 4]);
        whole.extend(time_ns.to_le_bytes());
        whole.extend(time_ns.to_le_bytes());
        whole.extend(data);
    }
    file(&whole);
}

/// The readable part of a log; `None` if the bytes are no log.
fn read(bytes: &[u8]) -> Option<(Description, Vec<Message>)> {
    let mut reader = LogReader::new(bytes, "log").ok()?;
    let messages = reader.by_ref().map_while(Result::ok).collect();
    assert!(reader.ending().is_some());
    assert!(reader.next().is_none(), "the end is the end");
    Some((reader.description().clone(), messages))
}

/// A log with these messages, written as for a recovered file.
fn write(description: &Description, messages: &[Message]) -> Vec<u8> {
    let mut writer = LogWriter::new(Vec::new(), description).unwrap();
    for message in messages {
        writer.write(message).unwrap();
    }
    writer.finish().unwrap()
}
