//! What a classifier sees of a press.

/// Samples of a series.
pub(crate) const N_SAMPLES: usize = 24;
/// Frames count from where the largest reading first exceeds this part of the press's largest, to where it last does.
const IN_CONTACT: f64 = 0.02;
/// Frames at the start whose mean is taken off.
const N_UNTOUCHED: usize = 3;
/// Readings that never exceed this, kPa, are of a press that was not felt.
const SMALLEST_KPA: f64 = 1e-6;

/// What the taxels read during a press, from first to last contact, at equal steps of time. It does not say how long the press took.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Over the largest of all; `[N_SAMPLES][n_taxels]`.
    pub(crate) shares: Vec<Vec<f32>>,
    /// The largest of all, kPa.
    pub(crate) largest_kpa: f32,
}

/// A press of a shape that is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// Which shape, from zero.
    pub class: usize,
    /// What was read.
    pub series: Series,
}

impl Series {
    /// The series of a press, from its readings above whatever constant, kPa; `[n_frames][n_taxels]`. A press starts untouched: its first three frames are
    /// zero. `None` if nothing was felt.
    #[must_use]
    pub fn of(readings_kpa: &[Vec<f64>]) -> Option<Self> {
        let n_taxels = readings_kpa.first()?.len();
        let untouched = &readings_kpa[..N_UNTOUCHED.min(readings_kpa.len())];
        let zero =
            |taxel: usize| untouched.iter().map(|row| row[taxel]).sum::<f64>() / untouched.len() as f64;
        let zero_kpa: Vec<f64> = (0..n_taxels).map(zero).collect();
        let above = |frame: usize, taxel: usize| readings_kpa[frame][taxel] - zero_kpa[taxel];
        let most = |frame: usize| (0..n_taxels).map(|taxel| above(frame, taxel)).fold(0.0, f64::max);
        let frames = 0..readings_kpa.len();
        let largest_kpa = frames.clone().map(most).fold(0.0, f64::max);
        if largest_kpa <= SMALLEST_KPA {
            return None;
        }
        let touches = |frame: &usize| most(*frame) > IN_CONTACT * largest_kpa;
        let first = frames.clone().find(touches)?;
        let last = frames.rev().find(touches)?;
        let sample = |index: usize| {
            let at = first as f64 + (last - first) as f64 * index as f64 / (N_SAMPLES - 1) as f64;
            let (before, share) = (at as usize, at.fract());
            let after = (before + 1).min(last);
            let read =
                |taxel| (above(before, taxel) * (1.0 - share) + above(after, taxel) * share) / largest_kpa;
            (0..n_taxels).map(|taxel| read(taxel) as f32).collect()
        };
        Some(Self {
            shares: (0..N_SAMPLES).map(sample).collect(),
            largest_kpa: largest_kpa as f32,
        })
    }

    pub(crate) fn n_taxels(&self) -> usize {
        self.shares[0].len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_runs_from_first_to_last_contact() {
        let mut readings_kpa = vec![vec![100.0, 50.0]; 10];
        for (frame, row) in readings_kpa.iter_mut().enumerate().take(8).skip(4) {
            row[0] += 2.0 * (frame as f64 - 3.0);
            row[1] -= 1.0;
        }
        let series = Series::of(&readings_kpa).unwrap();
        assert_eq!(series.largest_kpa, 8.0);
        assert_eq!(series.shares[0], [0.25, -0.125]);
        assert_eq!(series.shares[N_SAMPLES - 1], [1.0, -0.125]);
        let middle = &series.shares[N_SAMPLES / 2][0];
        assert!((0.5..0.8).contains(middle), "{middle}");
    }

    #[test]
    fn what_is_not_felt_is_no_series() {
        assert_eq!(Series::of(&[]), None);
        assert_eq!(Series::of(&vec![vec![101.3; 8]; 20]), None);
    }
}
