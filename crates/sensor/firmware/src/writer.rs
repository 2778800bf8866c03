//! Reports as bytes for the line.

use core::fmt::{self, Write};

use crate::buffer::Buffer;
use crate::remarks::{REMARK_BYTES, Remarks};
use crate::report::Report;
use crate::{csv, packet};

/// The format of reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// Lines of text with a checksum, and comments.
    #[default]
    Csv,
    /// Packets with a checksum, separated by zeros, and nothing else.
    Packets,
}

impl Form {
    /// The largest size of a report of `n` taxels, bytes.
    #[must_use]
    pub const fn longest(self, n: usize) -> usize {
        match self {
            Self::Csv => csv::line_bytes(n),
            Self::Packets => packet::packet_bytes(n),
        }
    }
}

/// The largest size of an answer or a comment, bytes.
const COMMENT_BYTES: usize = 160;

/// The largest number of bytes that a round writes for `n` taxels: four answers, a comment and a
/// report.
#[must_use]
pub const fn longest(n: usize) -> usize {
    let (csv, packets) = (Form::Csv.longest(n), Form::Packets.longest(n));
    4 * COMMENT_BYTES + REMARK_BYTES + if csv > packets { csv } else { packets }
}

/// Writes reports in one of the formats.
#[derive(Clone, Copy, Debug, Default)]
pub struct Writer<const N: usize> {
    /// The format.
    pub form: Form,
    remarks: Remarks<N>,
}

impl<const N: usize> Writer<N> {
    /// Appends a report to a buffer; as text, after a comment if something changed. `hint`: the
    /// scale at which the taxels read the pressure of free air, counts per Pa.
    pub fn write<const B: usize>(&mut self, report: &Report<N>, hint: Option<u16>, out: &mut Buffer<B>) {
        match self.form {
            Form::Csv => {
                self.remarks.write(report, hint, out);
                csv::write(report, out);
            }
            Form::Packets => packet::write(report, out),
        }
    }

    /// Appends a comment to a buffer, if the format has comments.
    pub fn comment<const B: usize>(&self, comment: impl fmt::Display, out: &mut Buffer<B>) {
        if self.form == Form::Csv {
            let _ = write!(out, "# {comment}\r\n");
        }
    }
}
