//! From bytes to frames.

use crate::counter::{Counter, Step};
use crate::description::{Description, Form, Framing};
use crate::heard::{Heard, Passed, Tally};
use crate::row::{LineFrame, Row};
use crate::{packet, text};

/// Takes a line's bytes as they come, and says what they are.
#[derive(Clone, Debug)]
pub struct Decoder {
    description: Description,
    n_taxels: usize,
    buffer: Vec<u8>,
    /// Whether the line that comes is too long and waits for its end.
    is_endless: bool,
    /// Whether bytes were passed over since the last packet.
    is_astray: bool,
    /// Whether the first line is still to come: the port may have been opened in its middle.
    is_first: bool,
    row: Row,
    /// Of the last frame's number and those before it, the lowest bit first: whether its frame was there.
    recent: u64,
    /// The row of the last frame.
    last: Row,
    /// Lines of the frame under way, where it has several, and how many.
    lines_under_way: String,
    n_lines: usize,
    sequence: Counter,
    time: Counter,
    tally: Tally,
}

/// How far back a number is a sign that the board started anew, rather than late or doubled.
const LATE: f64 = 64.0;

impl Decoder {
    /// For a sensor of so many taxels.
    ///
    /// # Panics
    /// If the description has another number of pressures: compare [`Description::n_pressures`] before.
    #[must_use]
    pub fn new(description: &Description, n_taxels: usize) -> Self {
        assert_eq!(
            description.n_pressures(),
            n_taxels,
            "pressures of a frame, and taxels"
        );
        let time = description.time;
        Self {
            n_taxels,
            buffer: Vec::new(),
            is_endless: false,
            is_astray: false,
            is_first: true,
            row: Row::default(),
            recent: 0,
            last: Row::default(),
            lines_under_way: String::new(),
            n_lines: 0,
            sequence: Counter::new(Some(description.sequence_wraps_at)),
            time: Counter::new(time.wraps_at.or(time.unit.usual_wrap())),
            tally: Tally::default(),
            description: description.clone(),
        }
    }

    /// What was on the line so far.
    #[must_use]
    pub fn tally(&self) -> Tally {
        self.tally
    }

    /// Takes bytes, in pieces of any size, and says what is on the line.
    pub fn push(&mut self, bytes: &[u8], say: &mut dyn FnMut(Heard)) {
        match (self.description.form, self.description.binary.framing) {
            (Form::Binary, Framing::Sync) => {
                self.buffer.extend_from_slice(bytes);
                self.take_packets(say);
            }
            (Form::Binary, Framing::Cobs) => self.split(bytes, 0, say),
            _ => self.split(bytes, b'\n', say),
        }
    }

    /// Cuts at an end, and bounds what does not end.
    fn split(&mut self, bytes: &[u8], end: u8, say: &mut dyn FnMut(Heard)) {
        for byte in bytes {
            if *byte == end {
                let piece = std::mem::take(&mut self.buffer);
                match std::mem::take(&mut self.is_endless) {
                    true => self.pass(Passed::Endless, say),
                    false => self.take_piece(&piece, say),
                }
                self.is_first = false;
                self.buffer = piece;
                self.buffer.clear();
            } else if self.buffer.len() >= self.longest() {
                self.is_endless = true;
            } else {
                self.buffer.push(*byte);
            }
        }
    }

    /// The most bytes that a piece may have.
    fn longest(&self) -> usize {
        match self.description.form {
            // The stuffing adds one byte for 254, and one.
            Form::Binary => packet::len(&self.description) * 255 / 254 + 2,
            _ => self.description.text.longest,
        }
    }

    fn take_piece(&mut self, piece: &[u8], say: &mut dyn FnMut(Heard)) {
        if self.description.form == Form::Binary {
            if piece.is_empty() {
                return; // zeros in a row are allowed
            }
            self.row.clear();
            let read = match packet::unstuffed(piece) {
                Some(packet) => packet::read(&self.description, &packet, &mut self.row),
                None => Err(Passed::Torn),
            };
            return self.take_row(read, say);
        }
        let line = String::from_utf8_lossy(piece);
        let line = line.trim_matches(|c: char| c.is_whitespace() || c == '\0' || c == '\u{feff}');
        match self.description.text.lines {
            1 => {
                self.row.clear();
                let read = text::read(&self.description, line, &mut self.row);
                self.take_row(read, say);
            }
            lines => self.take_line_of(lines, line, say),
        }
    }

    /// A line of a frame that has several, and ends with an empty one.
    fn take_line_of(&mut self, lines: usize, line: &str, say: &mut dyn FnMut(Heard)) {
        if !line.is_empty() {
            // More lines than there can be are torn, however many.
            self.n_lines = (self.n_lines + 1).min(lines + 1);
            if self.n_lines <= lines {
                self.lines_under_way.push_str(line);
                self.lines_under_way
                    .push_str(match self.description.text.separator.as_str() {
                        "blank" => " ",
                        separator => separator,
                    });
            }
            return;
        }
        let whole = std::mem::take(&mut self.lines_under_way);
        let read = match std::mem::take(&mut self.n_lines) {
            0 => Err(Passed::Comment),
            n if n == lines => {
                self.row.clear();
                text::read(&self.description, &whole, &mut self.row)
            }
            _ => Err(Passed::of_nothing(&whole)),
        };
        self.take_row(read, say);
    }

    fn take_packets(&mut self, say: &mut dyn FnMut(Heard)) {
        let sync = self.description.binary.sync.clone();
        let whole = sync.len() + packet::len(&self.description);
        // Without a checksum, what tells a packet from such bytes inside of one, and a whole one from a torn one, is that the next begins right behind.
        let has_checksum = self.description.binary.checksum.is_some();
        let behind = if has_checksum { 0 } else { sync.len() };
        let mut at = 0;
        while self.buffer.len() - at >= whole + behind {
            let here = &self.buffer[at..];
            if !here.starts_with(&sync) {
                at += 1;
                if !std::mem::replace(&mut self.is_astray, true) {
                    self.pass(Passed::Endless, say);
                }
                continue;
            }
            self.row.clear();
            let read = packet::read(&self.description, &here[sync.len()..whole], &mut self.row);
            let is_followed = has_checksum || here[whole..].starts_with(&sync);
            match read {
                Ok(()) if is_followed => {
                    at += whole;
                    self.is_astray = false;
                    self.take_row(Ok(()), say);
                }
                Ok(()) => {
                    at += 1;
                    self.pass(Passed::Torn, say);
                }
                Err(passed) => {
                    at += 1;
                    self.pass(passed, say);
                }
            }
        }
        self.buffer.drain(..at);
    }

    fn take_row(&mut self, read: Result<(), Passed>, say: &mut dyn FnMut(Heard)) {
        let has_all = self.row.pressures.len() == self.n_taxels;
        match read.and(if has_all { Ok(()) } else { Err(Passed::Torn) }) {
            // The port may have been opened in the middle of a line.
            Err(Passed::Torn) if self.is_first => self.pass(Passed::Text, say),
            Err(passed) => self.pass(passed, say),
            Ok(()) => match self.place() {
                Err(passed) => self.pass(passed, say),
                Ok(frame) => {
                    self.tally.frames += 1;
                    self.tally.lost = self.tally.lost.saturating_add(frame.lost_before); // numbers may jump far
                    say(Heard::Frame(frame));
                }
            },
        }
    }

    /// The frame of the row that was read, after the ones before it.
    fn place(&mut self) -> Result<LineFrame, Passed> {
        let (numbered, timed) = (self.description.has_sequence(), self.description.has_time());
        if numbered && self.row.sequence.is_none() || timed && self.row.time.is_none() {
            return Err(Passed::Torn);
        }
        let sequence = self.row.sequence.map(|count| (count, self.sequence.look(count)));
        let time = self.row.time.map(|count| (count, self.time.look(count)));
        let step = sequence.map(|(_, (step, _))| step);
        let (mut lost_before, mut is_restarted) = (0, false);
        match step {
            Some(Step::On(by)) => lost_before = (by as u64).saturating_sub(1),
            Some(Step::Same) => return Err(Passed::Doubled),
            // One that is missing is late; one that was there is doubled. What goes back further is a board that starts anew.
            Some(Step::Back(by)) if by < LATE => {
                return Err(if self.recent >> by as u32 & 1 == 0 {
                    Passed::Late
                } else {
                    Passed::Doubled
                });
            }
            Some(Step::Back(_)) => is_restarted = true,
            Some(Step::First) => {}
            None => match time.map(|(_, (step, _))| step) {
                // A clock of ms may stand still from one frame to the next.
                Some(Step::Same) if self.row == self.last => return Err(Passed::Doubled),
                Some(Step::Back(_)) => is_restarted = true,
                Some(Step::On(by)) => lost_before = self.missing(by),
                Some(Step::Same | Step::First) | None => {}
            },
        }
        if is_restarted {
            self.tally.restarts += 1;
            self.sequence.restart();
            self.time.restart();
            self.recent = 0;
            return self.place();
        }
        if let Some((count, (step, whole))) = sequence {
            self.sequence.take(count, whole);
            let by = if let Step::On(by) = step { by } else { LATE };
            self.recent = if by < LATE { self.recent << by as u32 } else { 0 } | 1;
        }
        if let Some((count, (_, whole))) = time {
            self.time.take(count, whole);
        }
        self.last.clone_from(&self.row);
        Ok(LineFrame {
            sequence: sequence.map(|(_, (_, whole))| whole as u64),
            time_s: time.map(|(_, (_, whole))| whole * self.description.time.unit.seconds()),
            pressures_kpa: self.row.pressures_kpa(&self.description),
            temperatures_c: self.row.temperatures_c(&self.description),
            faults: self.row.faults(&self.description),
            lost_before,
        })
    }

    /// Frames that are missing where one is so much later than the one before, in the clock's unit.
    fn missing(&self, later: f64) -> u64 {
        let Some(rate_hz) = self.description.rate_hz else {
            return 0;
        };
        let periods = later * self.description.time.unit.seconds() * rate_hz;
        (periods.round() as u64).saturating_sub(1)
    }

    fn pass(&mut self, passed: Passed, say: &mut dyn FnMut(Heard)) {
        self.tally.count(passed);
        say(Heard::Passed(passed));
    }
}
