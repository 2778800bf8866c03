//! Another sensor of the same kind, to which a twin is to be adapted.

use std::collections::BTreeSet;

use twintac_depth_table::DepthTable;
use twintac_recording::Recording;

use crate::bench_fit::{BenchEstimate, LearnedBench, Places};
use crate::{DigitacError, Features, Twin, bench_fit};

/// Another sensor of the same kind, pressed and simulated, with a twin that is to be adapted to it.
#[derive(Clone, Copy, Debug)]
pub struct NewSensor<'a> {
    /// The sensor's presses.
    pub recording: &'a Recording,
    /// The locations of the presses.
    pub places: &'a Places,
    /// The tables for the requests of `places`.
    pub tables: &'a [DepthTable],
    /// The trained twin.
    pub twin: &'a Twin,
    /// The estimate of the test setup on which it was trained.
    pub bench: &'a BenchEstimate,
    /// Excluded taxels, which do not influence values that all taxels share.
    pub left_out: &'a BTreeSet<usize>,
}

impl NewSensor<'_> {
    /// Test setup and barometers as learned.
    pub(super) fn learned(&self) -> LearnedBench<'_> {
        LearnedBench {
            recording: self.recording,
            places: self.places,
            tables: self.tables,
            bench: self.bench,
            gains: self.twin.gains(),
            left_out: self.left_out,
        }
    }

    /// The simulated side of every press, for a test setup.
    pub(super) fn features(&self, bench: &BenchEstimate) -> Result<Vec<Features>, DigitacError> {
        bench_fit::features(self.recording, self.places, self.tables, bench)
    }

    /// An error if no press touches the gel: presses without contact carry no information.
    pub(super) fn refuse_untouched(
        &self,
        features: &[Features],
        presses: impl IntoIterator<Item = usize>,
    ) -> Result<(), DigitacError> {
        let deepest_mm = |press: usize| features[press].depth_mm.iter().copied();
        let depths_mm: Vec<f64> = presses.into_iter().flat_map(deepest_mm).collect();
        let deepest_mm = depths_mm.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if deepest_mm > 0.0 {
            return Ok(());
        }
        Err(DigitacError::TooFew {
            expected: "presses that touch the gel, to adapt with".into(),
            found: match depths_mm.len() {
                0 => "none".into(),
                _ => format!("none: the deepest pose is {:.2} mm above it", -deepest_mm),
            },
        })
    }
}
