//! Checksums, which detect torn lines and packets.

use crc::{CRC_8_SMBUS, CRC_16_IBM_3740, CRC_16_MODBUS, CRC_32_ISO_HDLC, Crc};
use serde::{Deserialize, Serialize};

/// A checksum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Checksum {
    /// All bytes combined by exclusive or, as in NMEA 0183.
    Xor8,
    /// All bytes added up, modulo 256.
    Sum8,
    /// CRC-8 of SMBus: polynomial 0x07.
    Crc8,
    /// CRC-16 of CCITT with the start value 0xFFFF: polynomial 0x1021.
    Crc16Ccitt,
    /// CRC-16 of Modbus: polynomial 0x8005, reflected.
    Crc16Modbus,
    /// CRC-32 of Ethernet and zip.
    Crc32,
}

const CRC8: Crc<u8> = Crc::<u8>::new(&CRC_8_SMBUS);
const CCITT: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);
const MODBUS: Crc<u16> = Crc::<u16>::new(&CRC_16_MODBUS);
const CRC32: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

impl Checksum {
    /// Its length, bytes.
    #[must_use]
    pub const fn bytes(self) -> usize {
        match self {
            Self::Xor8 | Self::Sum8 | Self::Crc8 => 1,
            Self::Crc16Ccitt | Self::Crc16Modbus => 2,
            Self::Crc32 => 4,
        }
    }

    /// The checksum of these bytes.
    #[must_use]
    pub fn of(self, bytes: &[u8]) -> u32 {
        match self {
            Self::Xor8 => u32::from(bytes.iter().fold(0, |all, byte| all ^ byte)),
            Self::Sum8 => u32::from(bytes.iter().fold(0, |all: u8, byte| all.wrapping_add(*byte))),
            Self::Crc8 => u32::from(CRC8.checksum(bytes)),
            Self::Crc16Ccitt => u32::from(CCITT.checksum(bytes)),
            Self::Crc16Modbus => u32::from(MODBUS.checksum(bytes)),
            Self::Crc32 => CRC32.checksum(bytes),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The check values in the catalogue of parametrised CRC algorithms, for the digits 1 to 9.
    #[test]
    fn check_values() {
        let digits = b"123456789";
        assert_eq!(Checksum::Crc8.of(digits), 0xF4);
        assert_eq!(Checksum::Crc16Ccitt.of(digits), 0x29B1);
        assert_eq!(Checksum::Crc16Modbus.of(digits), 0x4B37);
        assert_eq!(Checksum::Crc32.of(digits), 0xCBF4_3926);
        assert_eq!(Checksum::Sum8.of(digits), 0xDD);
        assert_eq!(Checksum::Xor8.of(b"GPGLL"), 0x50);
    }
}
