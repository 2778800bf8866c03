//! From bytes to frames.

use crate::counter::{Counter, Step};
use crate::description::{Description, Form, Framing};
use crate::heard::{Heard, Passed, Tally};
use crate::row::{LineFrame, Row};
use crate::{packet, text};

/// Decodes a line's bytes as they arrive.
#[derive(Clone, Debug)]
pub struct Decoder {
    description: Description,
    n_taxels: usize,
    buffer: Vec<u8>,
    /// Whether the current line is too long; its end is awaited.
    is_endless: bool,
    /// Whether bytes were passed over since the last packet.
    is_astray: bool,
    /// Whether no line has ended yet: the port may have been opened in the middle of a line.
    is_first: bool,
    row: Row,
    /// For the last frame's number and the numbers before it, the lowest bit first: whether the
    /// frame arrived.
    recent: u64,
    /// The row of the last frame.
    last: Row,
    /// The lines of the current frame, if a frame has several, and their number.
    lines_under_way: String,
    n_lines: usize,
    sequence: Counter,
    time: Counter,
    tally: Tally,
}

/// A number that is lower by at least this much means that the board restarted. A smaller decrease
/// means a late or a repeated frame.
const LATE: f64 = 64.0;

impl Decoder {
    /// A decoder for a sensor with `n_taxels` taxels.
    ///
    /// # Panics
    /// The description has another number of pressures: check [`Description::n_pressures`] first.
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

    /// Counts of everything on the line so far.
    #[must_use]
    pub fn tally(&self) -> Tally {
        self.tally
    }

    /// Takes bytes, in pieces of any size, and calls `say` for everything that they contain.
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

    /// Splits at an end byte, and limits the length of pieces without an end.
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

    /// The largest length of a piece, bytes.
    fn longest(&self) -> usize {
        match self.description.form {
            // Stuffing adds one byte for each 254, and one more.
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

    /// Takes a line of a frame that has several lines and ends with an empty one.
    fn take_line_of(&mut self, lines: usize, line: &str, say: &mut dyn FnMut(Heard)) {
        if !line.is_empty() {
            // A frame with too many lines is torn, however many there are.
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
        // Without a checksum, the next packet has to begin directly after this one. Otherwise the
        // bytes may be inside of a packet, or the packet may be torn.
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

    /// The frame of the row that was read, given the frames before it.
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
            // A missing frame arrives late; a frame that had arrived is repeated. A larger decrease
            // is a restart of the board.
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
                // A clock in ms may have the same value in two frames.
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

    /// Number of missing frames if a frame is later than the one before by `later`, in the clock's
    /// unit.
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
