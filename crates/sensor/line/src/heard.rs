//! What a line contained.

use crate::row::LineFrame;

/// A frame, or something else on the line.
#[derive(Clone, Debug, PartialEq)]
pub enum Heard {
    /// A frame.
    Frame(LineFrame),
    /// Something else.
    Passed(Passed),
}

/// Something on the line that is not a frame, and is passed over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passed {
    /// A comment, or an empty line.
    Comment,
    /// Text without readings, such as a board's start message, a header, or a console's output.
    Text,
    /// A line or packet with too few or too many numbers, or with something that is not a number.
    /// Its frame is lost.
    Torn,
    /// Its checksum is wrong: its frame is lost.
    Checksum,
    /// A line without an end, or bytes with which no packet begins.
    Endless,
    /// A frame that came before.
    Doubled,
    /// A frame that came after one with a later number.
    Late,
}

impl Passed {
    /// The kind of a line that cannot be read: text, unless at least a third of its bytes are
    /// digits.
    pub(crate) fn of_nothing(line: &str) -> Self {
        if line.is_empty() {
            return Self::Comment;
        }
        let n_digits = line.bytes().filter(u8::is_ascii_digit).count();
        if 3 * n_digits >= line.len() {
            Self::Torn
        } else {
            Self::Text
        }
    }
}

/// Counts of everything on a line so far, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Frames.
    pub frames: u64,
    /// Missing frames, found from frame numbers or times.
    pub lost: u64,
    /// Comments and empty lines.
    pub comments: u64,
    /// Lines of text without readings.
    pub text: u64,
    /// Torn lines or packets.
    pub torn: u64,
    /// Lines or packets with a wrong checksum.
    pub checksum: u64,
    /// Lines without an end, and runs of bytes between packets.
    pub endless: u64,
    /// Repeated frames.
    pub doubled: u64,
    /// Late frames.
    pub late: u64,
    /// Restarts of the board.
    pub restarts: u64,
}

impl Tally {
    pub(crate) fn count(&mut self, passed: Passed) {
        *match passed {
            Passed::Comment => &mut self.comments,
            Passed::Text => &mut self.text,
            Passed::Torn => &mut self.torn,
            Passed::Checksum => &mut self.checksum,
            Passed::Endless => &mut self.endless,
            Passed::Doubled => &mut self.doubled,
            Passed::Late => &mut self.late,
        } += 1;
    }

    /// Counts of everything besides frames, as texts. Empty if there was nothing else.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        let kinds = [
            (self.lost, "missing frames"),
            (self.torn, "torn lines"),
            (self.checksum, "lines with a wrong checksum"),
            (self.endless, "long stretches without a line as described"),
            (self.doubled, "frames that were received twice"),
            (self.late, "frames that were received late and left out"),
            (self.restarts, "restarts of the board"),
        ];
        let some = kinds.into_iter().filter(|(n, _)| *n > 0);
        let mut remarks: Vec<String> = some.map(|(n, what)| format!("{what}: {n}")).collect();
        let others = self.comments + self.text;
        if self.frames == 0 && others > 0 {
            remarks.push(format!(
                "{others} lines were received, none with readings as described"
            ));
        }
        remarks
    }
}
