//! What the host may ask, a line each.

use core::fmt;
use core::str;

use crate::writer::Form;

/// The most bytes that a command has.
const LONGEST: usize = 32;

/// Something that the host asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// `rate 50` or `rate max`: rounds a second.
    Rate(Rate),
    /// `scale 32`: counts per Pa, of chips that only count.
    Scale(u16),
    /// `form csv` or `form packets`: how reports are written.
    Form(Form),
    /// `restart`: all chips are switched on anew, and channels that are kept closed are looked into at once.
    Restart,
    /// `hello`: what the board is, as a comment.
    Hello,
}

/// Rounds a second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rate {
    /// As many as there can be.
    Max,
    /// So many, 1 to 1000.
    Hz(u16),
}

/// Why a line is no command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommandError {
    /// It is longer than any.
    TooLong,
    /// It is none that is known, or what stands behind it is none that it takes.
    Unknown,
}

impl fmt::Display for CommandError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TooLong => "a command was too long",
            Self::Unknown => {
                "unknown command; known: rate 1..1000|max, scale COUNTS, form csv|packets, restart, hello"
            }
        })
    }
}

impl core::error::Error for CommandError {}

impl Command {
    fn parse(line: &[u8]) -> Result<Self, CommandError> {
        let text = str::from_utf8(line).map_err(|_| CommandError::Unknown)?;
        let mut words = text.split_ascii_whitespace();
        let command = match (words.next(), words.next()) {
            (Some("rate"), Some("max")) => Self::Rate(Rate::Max),
            (Some("rate"), Some(rate)) => match rate.parse() {
                Ok(hz @ 1..=1000) => Self::Rate(Rate::Hz(hz)),
                _ => return Err(CommandError::Unknown),
            },
            (Some("scale"), Some(scale)) => match scale.parse() {
                Ok(scale @ 1..) => Self::Scale(scale),
                _ => return Err(CommandError::Unknown),
            },
            (Some("form"), Some("csv")) => Self::Form(Form::Csv),
            (Some("form"), Some("packets")) => Self::Form(Form::Packets),
            (Some("restart"), None) => Self::Restart,
            (Some("hello"), None) => Self::Hello,
            _ => return Err(CommandError::Unknown),
        };
        match words.next() {
            None => Ok(command),
            Some(_) => Err(CommandError::Unknown),
        }
    }
}

/// Takes what the host sends, byte by byte.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Commands {
    line: [u8; LONGEST],
    /// Bytes of the line so far; above [`LONGEST`] it is too long.
    len: usize,
}

impl Commands {
    /// Takes a byte: a command or why there is none, at the end of a line that is not empty.
    pub(crate) fn push(&mut self, byte: u8) -> Option<Result<Command, CommandError>> {
        if !matches!(byte, b'\r' | b'\n') {
            if let Some(place) = self.line.get_mut(self.len) {
                *place = byte;
            }
            self.len = self.len.saturating_add(1).min(LONGEST + 1);
            return None;
        }
        let len = core::mem::take(&mut self.len);
        match self.line.get(..len) {
            None => Some(Err(CommandError::TooLong)),
            Some(line) if line.trim_ascii().is_empty() => None,
            Some(line) => Some(Command::parse(line)),
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::vec::Vec;

    use proptest::prelude::*;

    use super::*;

    fn heard(bytes: &[u8]) -> Vec<Result<Command, CommandError>> {
        let mut commands = Commands::default();
        bytes.iter().filter_map(|byte| commands.push(*byte)).collect()
    }

    #[test]
    fn lines_are_commands() {
        assert_eq!(
            heard(b"rate 50\r\n\n scale 32\nform packets\rform csv\nrestart\nhello\nrate max\n"),
            [
                Ok(Command::Rate(Rate::Hz(50))),
                Ok(Command::Scale(32)),
                Ok(Command::Form(Form::Packets)),
                Ok(Command::Form(Form::Csv)),
                Ok(Command::Restart),
                Ok(Command::Hello),
                Ok(Command::Rate(Rate::Max)),
            ]
        );
        for line in [
            "rate 0",
            "rate 1001",
            "rate",
            "rate 5 6",
            "scale 0",
            "scale -1",
            "form",
            "restart now",
            "\u{e9}",
            "x",
        ] {
            let line = [line.as_bytes(), b"\n"].concat();
            assert_eq!(heard(&line), [Err(CommandError::Unknown)]);
        }
        let long = [&[b'x'; 500][..], b"\nrestart\n"].concat();
        assert_eq!(heard(&long), [Err(CommandError::TooLong), Ok(Command::Restart)]);
    }

    proptest! {
        #[test]
        fn noise_hides_no_command_behind_it(mut noise: Vec<u8>) {
            noise.extend(b"\nrate 7\n");
            let heard = heard(&noise);
            prop_assert_eq!(heard.last(), Some(&Ok(Command::Rate(Rate::Hz(7)))));
        }
    }
}
