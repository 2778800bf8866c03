//! A connected sensor, shared by all clients.

use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};

/// Number of latest frames that are kept for clients that ask rarely.
const KEPT: usize = 256;

/// Number of first frames that each client gets, whenever it connects: they show the untouched
/// sensor.
const FIRST: usize = 32;

/// A connected sensor. Its reader hands frames over, and each client gets the frames that it does
/// not have yet.
#[derive(Debug)]
pub struct Desk {
    source: String,
    provenance: String,
    heard: Mutex<Heard>,
}

#[derive(Debug, Default)]
struct Heard {
    first: Vec<Vec<Option<f64>>>,
    /// Number of frames that are no longer kept.
    n_gone: u64,
    /// Absolute pressures of the taxels, kPa.
    frames: VecDeque<Vec<Option<f64>>>,
    remarks: Vec<String>,
}

impl Desk {
    /// A sensor whose frames come from `source`, a text for people; `provenance` is `real` or
    /// `emulated`.
    #[must_use]
    pub fn new(source: &str, provenance: &str) -> Self {
        Self {
            source: source.to_owned(),
            provenance: provenance.to_owned(),
            heard: Mutex::default(),
        }
    }

    /// Hands over a frame: absolute pressures of the taxels, kPa; `None` for a taxel without a
    /// reading.
    pub fn push(&self, pressures_kpa: Vec<Option<f64>>) {
        let mut heard = self.heard.lock().unwrap_or_else(PoisonError::into_inner);
        if heard.first.len() < FIRST {
            heard.first.push(pressures_kpa.clone());
        }
        if heard.frames.len() == KEPT {
            heard.frames.pop_front();
            heard.n_gone += 1;
        }
        heard.frames.push_back(pressures_kpa);
    }

    /// Sets the remarks about the frames so far, one sentence each.
    pub fn set_remarks(&self, remarks: Vec<String>) {
        self.heard.lock().unwrap_or_else(PoisonError::into_inner).remarks = remarks;
    }

    pub(crate) fn source(&self) -> &str {
        &self.source
    }

    pub(crate) fn provenance(&self) -> &str {
        &self.provenance
    }

    /// The kept frames after number `n_seen`, and the remarks; `n_seen` is updated. The first
    /// frames are always included.
    pub(crate) fn since(&self, n_seen: &mut u64) -> (Vec<Vec<Option<f64>>>, Vec<String>) {
        let heard = self.heard.lock().unwrap_or_else(PoisonError::into_inner);
        let n_skipped = n_seen.saturating_sub(heard.n_gone) as usize;
        // First frames that are also among the latest ones come with those.
        let n_first = heard.first.len().min(heard.n_gone as usize);
        let first = heard.first[..n_first].iter().skip(*n_seen as usize);
        *n_seen = heard.n_gone + heard.frames.len() as u64;
        let frames = first.chain(heard.frames.iter().skip(n_skipped));
        (frames.cloned().collect(), heard.remarks.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_client_gets_each_frame_once_and_no_more_than_are_kept() {
        let desk = Desk::new("bench", "emulated");
        let (mut often, mut seldom, mut got) = (0, 0, 0);
        for frame in 0..1000 {
            desk.push(vec![Some(f64::from(frame)), None]);
            if frame % 7 == 6 {
                let (frames, _) = desk.since(&mut often);
                assert_eq!(frames[0], [Some(f64::from(got)), None]);
                got += frames.len() as i32;
            }
        }
        let (frames, _) = desk.since(&mut seldom);
        assert_eq!((frames.len(), seldom), (FIRST + KEPT, 1000));
        assert_eq!(
            [frames[0][0], frames[FIRST - 1][0], frames[FIRST][0]],
            [0.0, 31.0, 744.0].map(Some)
        );
        for n in [0, 5, 31, 32, 40, 255, 256, 257, 290] {
            let desk = Desk::new("bench", "emulated");
            (0..n).for_each(|frame| desk.push(vec![Some(f64::from(frame))]));
            let (frames, _) = desk.since(&mut 0);
            let numbers: Vec<f64> = frames.iter().map(|frame| frame[0].unwrap()).collect();
            assert!(
                numbers.windows(2).all(|pair| pair[0] < pair[1]),
                "{n}: {numbers:?}"
            );
            assert_eq!(
                numbers.len(),
                n.min(KEPT as i32 + (n - KEPT as i32).clamp(0, FIRST as i32)) as usize
            );
        }
        assert!(desk.since(&mut seldom).0.is_empty());
    }
}
