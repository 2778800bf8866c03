//! Another sensor of the same kind, before a twin that does not know it yet.

use std::collections::BTreeSet;

use twintac_depth_table::DepthTable;
use twintac_recording::Recording;

use crate::bench_fit::{BenchEstimate, LearnedBench, Places};
use crate::{DigitacError, Features, Twin, bench_fit};

/// Another sensor of the same kind, pressed and simulated, before a twin that does not know it yet.
#[derive(Clone, Copy, Debug)]
pub struct NewSensor<'a> {
    /// Its presses.
    pub recording: &'a Recording,
    /// The places that they press.
    pub places: &'a Places,
    /// What answers the requests of `places`.
    pub tables: &'a [DepthTable],
    /// The twin, as it was learned.
    pub twin: &'a Twin,
    /// What was found of the bench where it was learned.
    pub bench: &'a BenchEstimate,
    /// Taxels that do not count for what all taxels share.
    pub left_out: &'a BTreeSet<usize>,
}

impl NewSensor<'_> {
    /// Bench and barometers as they were learned.
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

    /// The simulated side of every press on a bench.
    pub(super) fn features(&self, bench: &BenchEstimate) -> Result<Vec<Features>, DigitacError> {
        bench_fit::features(self.recording, self.places, self.tables, bench)
    }

    /// Presses that stay in the air tell nothing: some have to touch the gel.
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
