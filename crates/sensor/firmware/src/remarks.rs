//! What a person at a terminal is told between the lines.

use core::fmt::Write;

use phystac::TaxelState;

use crate::buffer::Buffer;
use crate::report::Report;
use crate::trouble::Trouble;

/// The most bytes that a round's remarks have.
pub(crate) const REMARK_BYTES: usize = 128;

/// Says once what changed: in each round of one taxel, or of the bus.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Remarks<const N: usize> {
    states: [TaxelState; N],
    trouble: Trouble,
    hint: Option<u16>,
}

impl<const N: usize> Default for Remarks<N> {
    fn default() -> Self {
        Self {
            states: [TaxelState::Good; N],
            trouble: Trouble::None,
            hint: None,
        }
    }
}

impl<const N: usize> Remarks<N> {
    /// A comment, if anything changed. `hint`: the scale that free air speaks for.
    pub(crate) fn write<const B: usize>(
        &mut self,
        report: &Report<N>,
        hint: Option<u16>,
        out: &mut Buffer<B>,
    ) {
        if report.trouble != self.trouble {
            self.trouble = report.trouble;
            let _ = write!(out, "# {} ({} resets)\r\n", report.trouble, report.rescues);
            return;
        }
        if report.trouble != Trouble::None {
            return; // the taxels' states say the same eight times
        }
        for (index, (said, taxel)) in self.states.iter_mut().zip(&report.taxels).enumerate() {
            if *said != taxel.state {
                *said = taxel.state;
                let _ = write!(out, "# taxel {index}: {}\r\n", taxel.state);
                return;
            }
        }
        if hint != self.hint {
            self.hint = hint;
            if let Some(scale) = hint {
                let _ = write!(
                    out,
                    "# free air would be {scale} counts per Pa: send `scale {scale}` if you agree\r\n"
                );
            }
        }
    }
}
