//! The readings of taxels without contact.

use super::collect::{Collected, Span};
use crate::{TaxelReading, TaxelState};

/// Pressure of each taxel, Pa: the mean over `window_ns` before a press, without the times of other
/// presses. `None` for a taxel without a value in this time.
pub(super) fn baseline_pa(
    collected: &Collected,
    place: usize,
    taxels: usize,
    window_ns: u64,
) -> Vec<Option<f64>> {
    let begun_ns = collected.spans[place].from_ns;
    let from_ns = begun_ns.saturating_sub(window_ns);
    // Presses follow each other, so only the last ones can reach into the window.
    let before = || collected.spans[..place].iter().rev();
    let is_untouched = |time_ns: u64| {
        let is_during = |span: &Span| (span.from_ns..=span.to_ns).contains(&time_ns);
        !before().take_while(|span| span.to_ns >= from_ns).any(is_during)
    };
    let frames = &collected.frames;
    let first = frames.partition_point(|(time_ns, _)| *time_ns < from_ns);
    let behind = frames.partition_point(|(time_ns, _)| *time_ns < begun_ns);
    let mut sums = vec![(0.0, 0_u32); taxels];
    for (_, frame) in frames[first..behind]
        .iter()
        .filter(|(time_ns, _)| is_untouched(*time_ns))
    {
        for ((sum_pa, count), taxel) in sums.iter_mut().zip(&frame.taxels) {
            if let Some(pressure_pa) = pressure_pa(taxel) {
                *sum_pa += pressure_pa;
                *count += 1;
            }
        }
    }
    let mean = |(sum_pa, count): (f64, u32)| (count > 0).then(|| sum_pa / f64::from(count));
    sums.into_iter().map(mean).collect()
}

/// A pressure that can be used, Pa.
pub(super) fn pressure_pa(taxel: &TaxelReading) -> Option<f64> {
    let is_good = taxel.state == TaxelState::Good;
    taxel
        .pressure_pa
        .filter(|pressure_pa| is_good && pressure_pa.is_finite())
}
