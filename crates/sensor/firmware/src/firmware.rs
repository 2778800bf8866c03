//! The whole firmware of a board: it takes commands, reads a round, and writes the report.

use core::fmt;

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;
use phystac::Clock;
use phystac::recovery::RecoveryError;

use crate::buffer::Buffer;
use crate::command::{Command, CommandError, Commands, Rate};
use crate::node::Node;
use crate::report::Report;
use crate::writer::{Form, Writer, longest};

/// Largest number of answers that wait for the next round.
const MOST_ANSWERS: usize = 4;

/// A node, a writer, and the commands for both. A board's program passes the host's bytes to
/// [`hear`](Self::hear), and sends the bytes that [`round`](Self::round) writes.
#[derive(Debug)]
pub struct Firmware<I2C, D, C, R, const N: usize> {
    node: Node<I2C, D, C, R, N>,
    writer: Writer<N>,
    commands: Commands,
    answers: [Option<Answer>; MOST_ANSWERS],
    is_to_restart: bool,
}

/// An answer to the host, sent as a comment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// The command was executed.
    Done(Command),
    /// What the board is.
    Hello {
        /// Number of taxels.
        n: usize,
        /// Largest possible rate, rounds per second, Hz.
        most_hz: u32,
    },
    /// The command was wrong.
    Wrong(CommandError),
}

impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Done(Command::Rate(Rate::Max)) => f.write_str("rate max"),
            Self::Done(Command::Rate(Rate::Hz(hz))) => write!(f, "rate {hz}"),
            Self::Done(Command::Scale(scale)) => write!(f, "scale {scale}"),
            Self::Done(Command::Form(Form::Csv)) => f.write_str("form csv"),
            Self::Done(Command::Form(Form::Packets)) => f.write_str("form packets"),
            Self::Done(Command::Restart) => f.write_str("restart"),
            Self::Done(Command::Hello) => f.write_str("hello"),
            Self::Hello { n, most_hz } => write!(
                f,
                "twintac-firmware {}: {n} taxels, at most {most_hz} Hz; columns: sequence, us, {n} of Pa, {n} of degC, \
                 {n} codes, trouble, resets",
                env!("CARGO_PKG_VERSION")
            ),
            Self::Wrong(error) => error.fmt(f),
        }
    }
}

impl<I2C, D, C, R, const N: usize> Firmware<I2C, D, C, R, N>
where
    I2C: I2c,
    D: DelayNs + Clone,
    C: Clock + Clone,
    R: FnMut(&mut I2C) -> Result<(), RecoveryError>,
{
    /// The firmware of a node. The first round also sends what the board is.
    pub fn new(node: Node<I2C, D, C, R, N>, form: Form) -> Self {
        let mut firmware = Self {
            node,
            writer: Writer::default(),
            commands: Commands::default(),
            answers: [None; MOST_ANSWERS],
            is_to_restart: false,
        };
        firmware.writer.form = form;
        firmware.greet();
        firmware
    }

    /// Takes a byte from the host. A command takes effect with the next round.
    pub fn hear(&mut self, byte: u8) {
        match self.commands.push(byte) {
            None => {}
            Some(Ok(command)) => self.obey(command),
            Some(Err(error)) => self.answer(Answer::Wrong(error)),
        }
    }

    /// Waits until the next round is due, reads it, and writes its report.
    pub async fn round<const B: usize>(&mut self, out: &mut Buffer<B>) -> Report<N> {
        const {
            assert!(
                B >= longest(N),
                "the buffer holds what a round can write: longest(N)"
            )
        }
        if core::mem::take(&mut self.is_to_restart) {
            self.node.restart().await;
        }
        let report = self.node.round().await;
        for answer in core::mem::take(&mut self.answers).into_iter().flatten() {
            self.writer.comment(answer, out);
        }
        self.writer.write(&report, self.node.hint(), out);
        report
    }

    fn obey(&mut self, command: Command) {
        match command {
            Command::Rate(rate) => self.node.set_rate(rate),
            Command::Scale(scale) => self.node.set_scale(scale),
            Command::Form(form) => self.writer.form = form,
            Command::Restart => self.is_to_restart = true,
            Command::Hello => return self.greet(),
        }
        self.answer(Answer::Done(command));
    }

    fn greet(&mut self) {
        let most_hz = (self.node.most_hz() + 0.5) as u32;
        self.answer(Answer::Hello { n: N, most_hz });
    }

    /// Keeps an answer for the next round. If too many wait, it is dropped.
    fn answer(&mut self, answer: Answer) {
        if let Some(place) = self.answers.iter_mut().find(|place| place.is_none()) {
            *place = Some(answer);
        }
    }
}
