//! What was on a line.

use crate::row::LineFrame;

/// What was on the line.
#[derive(Clone, Debug, PartialEq)]
pub enum Heard {
    /// A frame.
    Frame(LineFrame),
    /// Something else.
    Passed(Passed),
}

/// What is no frame, and is passed over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passed {
    /// A comment, or an empty line.
    Comment,
    /// Text without readings: what a board says when it starts, its header, a console's remarks.
    Text,
    /// A line or packet with too few numbers or too many, or with something that is none: its frame is lost.
    Torn,
    /// Its checksum is wrong: its frame is lost.
    Checksum,
    /// A line that does not end, or bytes that no packet begins with.
    Endless,
    /// A frame that came before.
    Doubled,
    /// A frame that came after one with a later number.
    Late,
}

impl Passed {
    /// What a line is that cannot be read: text, unless half of it are digits.
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

/// What was on the line so far, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Frames.
    pub frames: u64,
    /// Frames that are missing, by their numbers or by their times.
    pub lost: u64,
    /// Comments and empty lines.
    pub comments: u64,
    /// Lines of text without readings.
    pub text: u64,
    /// Lines or packets that were torn.
    pub torn: u64,
    /// Those whose checksum is wrong.
    pub checksum: u64,
    /// Lines that did not end, and bytes between packets.
    pub endless: u64,
    /// Frames that came twice.
    pub doubled: u64,
    /// Frames that came late.
    pub late: u64,
    /// Times that the board started anew.
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

    /// What was on the line besides frames, how often each; empty if all was well.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        let kinds = [
            (self.lost, "missing frames"),
            (self.torn, "torn lines"),
            (self.checksum, "lines with a wrong checksum"),
            (self.endless, "long stretches without a line as described"),
            (self.doubled, "frames that came twice"),
            (self.late, "frames that came late, and were left out"),
            (self.restarts, "restarts of the board"),
        ];
        let some = kinds.into_iter().filter(|(n, _)| *n > 0);
        let mut remarks: Vec<String> = some.map(|(n, what)| format!("{what}: {n}")).collect();
        let others = self.comments + self.text;
        if self.frames == 0 && others > 0 {
            remarks.push(format!("{others} lines came, and none has readings as described"));
        }
        remarks
    }
}
