//! A report as a packet. `firmware/lines/packets-8.toml` describes it to the host.
//!
//! Little-endian: u32 sequence, u32 time in µs, f32 pressures in Pa, f32 temperatures in °C, u8
//! fault codes, u8 trouble, u16 number of rescues; then the CRC-16 of CCITT (start value 0xFFFF) of
//! these bytes. The whole is stuffed (COBS), with a zero after it. NaN stands for a missing value.

use crc::{CRC_16_IBM_3740, Crc};

use crate::buffer::Buffer;
use crate::cobs;
use crate::report::Report;

/// The checksum of packets and lines.
pub(crate) const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);

/// Size of a packet of `n` taxels before stuffing, bytes.
const fn raw_bytes(n: usize) -> usize {
    4 + 4 + n * (4 + 4 + 1) + 1 + 2 + 2
}

/// The largest size of a packet of `n` taxels on the line, bytes.
pub(crate) const fn packet_bytes(n: usize) -> usize {
    cobs::stuffed_bytes(raw_bytes(n))
}

/// Size of a packet of 64 taxels before stuffing, bytes.
const MOST_RAW: usize = raw_bytes(64);

pub(crate) fn write<const N: usize, const B: usize>(report: &Report<N>, out: &mut Buffer<B>) {
    const { assert!(raw_bytes(N) <= MOST_RAW, "a sensor has at most 64 taxels") }
    let mut raw = Buffer::<MOST_RAW>::new();
    raw.extend(&report.sequence.to_le_bytes());
    raw.extend(&(report.triggered_us as u32).to_le_bytes()); // rolls over every 71 minutes; the host corrects that
    for taxel in &report.taxels {
        raw.extend(&taxel.pressure_pa.unwrap_or(f32::NAN).to_le_bytes());
    }
    for taxel in &report.taxels {
        raw.extend(&taxel.temperature_c.unwrap_or(f32::NAN).to_le_bytes());
    }
    for taxel in &report.taxels {
        raw.push(taxel.state as u8);
    }
    raw.push(report.trouble as u8);
    raw.extend(&report.rescues.to_le_bytes());
    let checksum = CRC.checksum(raw.as_bytes());
    raw.extend(&checksum.to_le_bytes());
    cobs::stuff(raw.as_bytes(), out);
}
