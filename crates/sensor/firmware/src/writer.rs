//! Reports as bytes for the line.

use core::fmt::{self, Write};

use crate::buffer::Buffer;
use crate::remarks::{REMARK_BYTES, Remarks};
use crate::report::Report;
use crate::{csv, packet};

/// How reports are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// Lines of text with a checksum, and comments.
    #[default]
    Csv,
    /// Packets with a checksum between zeros, and nothing else.
    Packets,
}

impl Form {
    /// The most bytes that a report of so many taxels has.
    #[must_use]
    pub const fn longest(self, n: usize) -> usize {
        match self {
            Self::Csv => csv::line_bytes(n),
            Self::Packets => packet::packet_bytes(n),
        }
    }
}

/// The most bytes that an answer or a comment has.
const COMMENT_BYTES: usize = 160;

/// The most bytes that a round writes for so many taxels: four answers, a remark and a report.
#[must_use]
pub const fn longest(n: usize) -> usize {
    let (csv, packets) = (Form::Csv.longest(n), Form::Packets.longest(n));
    4 * COMMENT_BYTES + REMARK_BYTES + if csv > packets { csv } else { packets }
}

/// Writes reports in one form or the other.
#[derive(Clone, Copy, Debug, Default)]
pub struct Writer<const N: usize> {
    /// In which.
    pub form: Form,
    remarks: Remarks<N>,
}

impl<const N: usize> Writer<N> {
    /// Adds a report to a buffer; as text, behind a comment if something changed. `hint`: the scale that free air speaks for.
    pub fn write<const B: usize>(&mut self, report: &Report<N>, hint: Option<u16>, out: &mut Buffer<B>) {
        match self.form {
            Form::Csv => {
                self.remarks.write(report, hint, out);
                csv::write(report, out);
            }
            Form::Packets => packet::write(report, out),
        }
    }

    /// Adds a comment to a buffer, if the form has any.
    pub fn comment<const B: usize>(&self, comment: impl fmt::Display, out: &mut Buffer<B>) {
        if self.form == Form::Csv {
            let _ = write!(out, "# {comment}\r\n");
        }
    }
}
