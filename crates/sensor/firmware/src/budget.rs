//! How many reports a second a line carries.

use crate::writer::Form;

/// Bits of a byte on a UART: a start, eight, a stop.
const UART_BITS_PER_BYTE: u32 = 10;

/// What a report costs on the line.
///
/// ```
/// use twintac_firmware::{Form, LineBudget};
///
/// let packets = LineBudget::of(Form::Packets, 8);
/// assert_eq!(packets.bytes(), 87);
/// assert_eq!(packets.rate_hz(115_200), 132);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineBudget {
    bytes: usize,
}

impl LineBudget {
    /// Of a report of so many taxels; of text, the longest that there can be.
    #[must_use]
    pub const fn of(form: Form, n: usize) -> Self {
        Self {
            bytes: form.longest(n),
        }
    }

    /// Bytes of a report.
    #[must_use]
    pub const fn bytes(&self) -> usize {
        self.bytes
    }

    /// Reports a second over a UART of so many bits a second.
    #[must_use]
    pub const fn rate_hz(&self, baud: u32) -> u32 {
        baud / (UART_BITS_PER_BYTE * self.bytes as u32)
    }
}
