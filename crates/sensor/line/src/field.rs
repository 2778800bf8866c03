//! Fields of a line or a packet.

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The meaning of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// A taxel's pressure, in the order of the sensor's taxels.
    Pressure,
    /// Temperature: one for each taxel in turn, or one for all.
    Temperature,
    /// The time at which the taxels were read.
    Time,
    /// The frame's number.
    Sequence,
    /// Fault code of each taxel in turn: 0 if it has a reading.
    Fault,
    /// Something else.
    Ignored,
}

/// The type of a number in a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names say it
pub enum Number {
    U8,
    I8,
    U16,
    I16,
    U24,
    I24,
    U32,
    I32,
    U64,
    F32,
    F64,
}

impl Number {
    const ALL: [(&'static str, Self); 11] = [
        ("u8", Self::U8),
        ("i8", Self::I8),
        ("u16", Self::U16),
        ("i16", Self::I16),
        ("u24", Self::U24),
        ("i24", Self::I24),
        ("u32", Self::U32),
        ("i32", Self::I32),
        ("u64", Self::U64),
        ("f32", Self::F32),
        ("f64", Self::F64),
    ];

    /// Its length, bytes.
    #[must_use]
    pub const fn bytes(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U24 | Self::I24 => 3,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::U64 | Self::F64 => 8,
        }
    }

    /// The number in these bytes, least significant byte first.
    pub(crate) fn read(self, bytes: &[u8]) -> f64 {
        let mut whole = [0; 8];
        whole[..bytes.len()].copy_from_slice(bytes);
        let unsigned = u64::from_le_bytes(whole);
        let shift = 64 - 8 * bytes.len() as u32;
        let signed = (unsigned << shift).cast_signed() >> shift;
        match self {
            Self::U8 | Self::U16 | Self::U24 | Self::U32 | Self::U64 => unsigned as f64,
            Self::I8 | Self::I16 | Self::I24 | Self::I32 => signed as f64,
            Self::F32 => f64::from(f32::from_bits(unsigned as u32)),
            Self::F64 => f64::from_bits(unsigned),
        }
    }
}

/// Consecutive numbers of one meaning: `time`, `pressure * 8`, and in a packet `u32 time`,
/// `i16 pressure * 8`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Their type in a packet; `None` in text.
    pub number: Option<Number>,
    /// Their meaning.
    pub meaning: Meaning,
    /// How many there are.
    pub repeats: usize,
}

/// Largest number of numbers in a field.
const MOST_REPEATS: usize = 4096;

impl Field {
    fn parse(text: &str) -> Result<Self, String> {
        let (what, repeats) = match text.split_once('*') {
            None => (text, 1),
            Some((what, repeats)) => (what, repeats.trim().parse().unwrap_or(0)),
        };
        if !(1..=MOST_REPEATS).contains(&repeats) {
            return Err(format!("`{text}`: expected 1 to {MOST_REPEATS} after `*`"));
        }
        let mut words = what.split_whitespace();
        let (first, second) = (words.next().unwrap_or_default(), words.next());
        let (number, meaning) = match second {
            None => (None, first),
            Some(meaning) => {
                let known = Number::ALL.iter().find(|(name, _)| *name == first);
                let (_, number) = known.ok_or_else(|| {
                    let names: Vec<&str> = Number::ALL.iter().map(|(name, _)| *name).collect();
                    format!(
                        "`{text}`: `{first}` is not a type of a number; known are {}",
                        names.join(", ")
                    )
                })?;
                (Some(*number), meaning)
            }
        };
        let meaning = match meaning {
            "pressure" => Meaning::Pressure,
            "temperature" => Meaning::Temperature,
            "time" => Meaning::Time,
            "sequence" => Meaning::Sequence,
            "fault" => Meaning::Fault,
            "ignored" => Meaning::Ignored,
            other => {
                return Err(format!(
                    "`{text}`: `{other}` is not a known meaning; known are pressure, temperature, time, sequence, fault and ignored"
                ));
            }
        };
        if words.next().is_some() {
            return Err(format!(
                "`{text}`: expected a type, a meaning and `* n`, such as `i16 pressure * 8`"
            ));
        }
        Ok(Self {
            number,
            meaning,
            repeats,
        })
    }
}

impl fmt::Display for Field {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(number) = self.number {
            let name = Number::ALL.iter().find(|(_, known)| *known == number);
            write!(f, "{} ", name.map_or("", |(name, _)| name))?;
        }
        f.write_str(match self.meaning {
            Meaning::Pressure => "pressure",
            Meaning::Temperature => "temperature",
            Meaning::Time => "time",
            Meaning::Sequence => "sequence",
            Meaning::Fault => "fault",
            Meaning::Ignored => "ignored",
        })?;
        match self.repeats {
            1 => Ok(()),
            repeats => write!(f, " * {repeats}"),
        }
    }
}

impl Serialize for Field {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Field {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        Self::parse(&text).map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_read_and_written() {
        for text in [
            "time",
            "pressure * 8",
            "u32 time",
            "i24 pressure * 16",
            "u8 ignored",
        ] {
            assert_eq!(Field::parse(text).unwrap().to_string(), text);
        }
        for text in [
            "",
            "presure",
            "u9 time",
            "pressure * 0",
            "pressure * 5000",
            "pressure*x",
            "u8 time now",
        ] {
            assert!(Field::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn numbers_of_every_size_are_read() {
        assert_eq!(Number::I24.read(&[0xFF, 0xFF, 0xFF]), -1.0);
        assert_eq!(Number::U24.read(&[0x40, 0xF3, 0x62]), 6_484_800.0);
        assert_eq!(Number::I8.read(&[0x80]), -128.0);
        assert_eq!(Number::F32.read(&1.5_f32.to_le_bytes()), 1.5);
        assert_eq!(Number::F64.read(&(-2.25_f64).to_le_bytes()), -2.25);
        assert_eq!(Number::U64.read(&[0, 0, 0, 0, 1, 0, 0, 0]), 4_294_967_296.0);
    }
}
