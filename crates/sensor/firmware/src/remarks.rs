//! Comments between the lines, for a person at a terminal.

use core::fmt::Write;

use phystac::TaxelState;

use crate::buffer::Buffer;
use crate::report::Report;
use crate::trouble::Trouble;

/// The largest size of a round's comments, bytes.
pub(crate) const REMARK_BYTES: usize = 128;

/// Writes a comment for each change, once: in a round for one taxel or for the bus.
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
    /// Writes a comment, if anything changed. `hint`: the scale at which the taxels read the
    /// pressure of free air, counts per Pa.
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
            return; // the eight taxels' states would all say the same
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
