//! The report rate that a line allows.

use crate::writer::Form;

/// Bits of a byte on a UART: one start bit, eight data bits, one stop bit.
const UART_BITS_PER_BYTE: u32 = 10;

/// The size of a report on the line.
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
    /// The budget of a report of `n` taxels; for text, of the longest possible line.
    #[must_use]
    pub const fn of(form: Form, n: usize) -> Self {
        Self {
            bytes: form.longest(n),
        }
    }

    /// Length of a report, bytes.
    #[must_use]
    pub const fn bytes(&self) -> usize {
        self.bytes
    }

    /// Reports per second over a UART of `baud` bits per second.
    #[must_use]
    pub const fn rate_hz(&self, baud: u32) -> u32 {
        baud / (UART_BITS_PER_BYTE * self.bytes as u32)
    }
}
