//! Requests and records of the raw data transfer (RDT), all big-endian.
//!
//! Source: ATI Industrial Automation, Network Force/Torque Sensor System, manual 9620-05-NET FT,
//! section 10.

use super::Status;
use crate::{Device, RigError};

/// UDP port of the sensor.
pub const PORT: u16 = 49152;
/// Size of a request.
pub const REQUEST_BYTES: usize = 8;
/// Size of a record; a datagram holds one or several.
pub const RECORD_BYTES: usize = 36;
const REQUEST_MARK: u16 = 0x1234;

/// What a request asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u16)]
pub enum Command {
    /// Stop streaming.
    Stop = 0x0000,
    /// Stream one record in a datagram.
    StartRealTime = 0x0002,
    /// Stream several records in a datagram.
    StartBuffered = 0x0003,
    /// Stream in step with other units.
    StartMultiUnit = 0x0004,
    /// Unlatch monitor conditions.
    ResetLatch = 0x0041,
    /// Count the present load as zero.
    Bias = 0x0042,
}

/// A request to the sensor. It is never acknowledged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Request {
    /// What it asks for.
    pub command: Command,
    /// Number of records to send. 0: stream until a stop request.
    pub samples: u32,
}

/// One reading of the sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Record {
    /// Number of the record since the request, counted from 1. The counter wraps around.
    pub rdt_sequence: u32,
    /// Ticks of the sensor's own clock since power-up, 7000 per second. The counter wraps around.
    pub ft_sequence: u32,
    /// Status of the sensor.
    pub status: Status,
    /// Fx, Fy, Fz, Tx, Ty, Tz in counts.
    pub counts: [i32; 6],
}

impl Command {
    const ALL: [Self; 6] = [
        Self::Stop,
        Self::StartRealTime,
        Self::StartBuffered,
        Self::StartMultiUnit,
        Self::ResetLatch,
        Self::Bias,
    ];
}

impl Request {
    /// The request's bytes.
    #[must_use]
    pub fn encode(&self) -> [u8; REQUEST_BYTES] {
        let mut bytes = [0; REQUEST_BYTES];
        bytes[0..2].copy_from_slice(&REQUEST_MARK.to_be_bytes());
        bytes[2..4].copy_from_slice(&(self.command as u16).to_be_bytes());
        bytes[4..8].copy_from_slice(&self.samples.to_be_bytes());
        bytes
    }

    /// The request that a datagram holds.
    ///
    /// # Errors
    /// Another size, another mark, or an unknown command.
    pub fn decode(datagram: &[u8]) -> Result<Self, RigError> {
        let malformed = |field, expected: &str, found: String| {
            RigError::malformed(Device::ForceSensor, field, expected, found)
        };
        let Ok([m0, m1, c0, c1, s0, s1, s2, s3]) = <[u8; REQUEST_BYTES]>::try_from(datagram) else {
            let found = datagram.len().to_string();
            return Err(malformed("request size", "8 bytes", found));
        };
        let mark = u16::from_be_bytes([m0, m1]);
        if mark != REQUEST_MARK {
            return Err(malformed("request mark", "0x1234", format!("{mark:#06x}")));
        }
        let code = u16::from_be_bytes([c0, c1]);
        let Some(command) = Command::ALL.into_iter().find(|command| *command as u16 == code) else {
            let found = format!("{code:#06x}");
            return Err(malformed("request command", "a known command", found));
        };
        Ok(Self {
            command,
            samples: u32::from_be_bytes([s0, s1, s2, s3]),
        })
    }
}

impl Record {
    /// The record's bytes.
    #[must_use]
    pub fn encode(&self) -> [u8; RECORD_BYTES] {
        let mut words = [
            self.rdt_sequence,
            self.ft_sequence,
            self.status.0,
            0,
            0,
            0,
            0,
            0,
            0,
        ];
        for (word, count) in words[3..].iter_mut().zip(self.counts) {
            *word = count.cast_unsigned();
        }
        let mut bytes = [0; RECORD_BYTES];
        for (place, word) in bytes.chunks_exact_mut(4).zip(words) {
            place.copy_from_slice(&word.to_be_bytes());
        }
        bytes
    }

    fn decode(bytes: &[u8; RECORD_BYTES]) -> Self {
        let word = |index: usize| {
            let at = 4 * index;
            u32::from_be_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
        };
        Self {
            rdt_sequence: word(0),
            ft_sequence: word(1),
            status: Status(word(2)),
            counts: std::array::from_fn(|axis| word(3 + axis).cast_signed()),
        }
    }
}

/// A datagram of records.
#[must_use]
pub fn encode_records(records: &[Record]) -> Vec<u8> {
    records.iter().flat_map(Record::encode).collect()
}

/// The records of a datagram, one or several.
///
/// # Errors
/// A size that is not that of one or several records.
pub fn decode_records(datagram: &[u8]) -> Result<impl Iterator<Item = Record> + '_, RigError> {
    let (records, rest) = datagram.as_chunks::<RECORD_BYTES>();
    if records.is_empty() || !rest.is_empty() {
        let (expected, found) = ("a multiple of 36 bytes", datagram.len());
        return Err(RigError::malformed(
            Device::ForceSensor,
            "datagram size",
            expected,
            found,
        ));
    }
    Ok(records.iter().map(Record::decode))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn requests_are_those_of_the_manual() {
        for (command, bytes) in [
            (Command::StartRealTime, [0x12, 0x34, 0, 2, 0, 0, 0, 0]),
            (Command::StartBuffered, [0x12, 0x34, 0, 3, 0, 0, 0, 0]),
            (Command::Stop, [0x12, 0x34, 0, 0, 0, 0, 0, 0]),
            (Command::Bias, [0x12, 0x34, 0, 0x42, 0, 0, 0, 0]),
            (Command::ResetLatch, [0x12, 0x34, 0, 0x41, 0, 0, 0, 0]),
        ] {
            let request = Request { command, samples: 0 };
            assert_eq!(request.encode(), bytes);
            assert_eq!(Request::decode(&bytes).unwrap(), request);
        }
        let counted = Request {
            command: Command::StartRealTime,
            samples: 0x0102_0304,
        };
        assert_eq!(counted.encode()[4..], [1, 2, 3, 4]);
    }

    #[test]
    fn a_record_is_nine_big_endian_words() {
        let bytes: Vec<u8> = [1, 7000, 0x8001_0000, 1_000_000, 0xffff_ffff, 0, 0x8000_0000, 0, 5]
            .iter()
            .flat_map(|word: &u32| word.to_be_bytes())
            .collect();
        let record = decode_records(&bytes).unwrap().next().unwrap();
        assert_eq!((record.rdt_sequence, record.ft_sequence), (1, 7000));
        assert_eq!(record.status, Status(0x8001_0000));
        assert_eq!(record.counts, [1_000_000, -1, 0, i32::MIN, 0, 5]);
    }

    #[test]
    fn wrong_bytes_are_named() {
        for (bytes, words) in [
            (
                [0x12, 0x35, 0, 2, 0, 0, 0, 0].as_slice(),
                "request mark: expected 0x1234, found 0x1235",
            ),
            (
                &[0x12, 0x34, 0, 9, 0, 0, 0, 0],
                "request command: expected a known command, found 0x0009",
            ),
            (&[0x12, 0x34], "request size: expected 8 bytes, found 2"),
        ] {
            let error = Request::decode(bytes).unwrap_err().to_string();
            assert_eq!(error, format!("force sensor: {words}"));
        }
        for size in [0, 35, 37, 71] {
            assert!(decode_records(&vec![0; size]).is_err(), "{size}");
        }
    }

    proptest! {
        #[test]
        fn records_come_back(
            fields in prop::collection::vec((any::<[u32; 3]>(), any::<[i32; 6]>()), 1..40)
        ) {
            let records: Vec<Record> = fields
                .into_iter()
                .map(|([rdt_sequence, ft_sequence, status], counts)| Record {
                    rdt_sequence,
                    ft_sequence,
                    status: Status(status),
                    counts,
                })
                .collect();
            let bytes = encode_records(&records);
            prop_assert_eq!(decode_records(&bytes).unwrap().collect::<Vec<_>>(), records);
        }
    }
}
