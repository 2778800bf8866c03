//! Commands of the host, one for each line.

use core::fmt;
use core::str;

use crate::writer::Form;

/// Length of the longest command, bytes.
const LONGEST: usize = 32;

/// A command of the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// `rate 50` or `rate max`: rounds per second.
    Rate(Rate),
    /// `scale 32`: counts per Pa, for chips whose scale is unknown.
    Scale(u16),
    /// `form csv` or `form packets`: the format of reports.
    Form(Form),
    /// `restart`: starts all chips anew, and tries isolated channels at once.
    Restart,
    /// `hello`: asks what the board is. The answer is a comment.
    Hello,
}

/// Rounds per second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rate {
    /// As many as possible.
    Max,
    /// This many, 1 to 1000.
    Hz(u16),
}

/// Why a line is not a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommandError {
    /// It is longer than any command.
    TooLong,
    /// The command or its argument is unknown.
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

/// Takes the bytes that the host sends, one by one.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Commands {
    line: [u8; LONGEST],
    /// Number of bytes of the line so far; a number above [`LONGEST`] means that the line is too
    /// long.
    len: usize,
}

impl Commands {
    /// Takes a byte. At the end of a line that is not empty, returns the command or an error.
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
