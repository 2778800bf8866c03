//! Readings from a file.

use std::path::Path;
use std::time::Duration;

use super::{Wrench, WrenchSample, WrenchSource};
use crate::{BenchClock, RigError};

const COLUMNS: [&str; 7] = ["time_s", "fx_n", "fy_n", "fz_n", "tx_n_mm", "ty_n_mm", "tz_n_mm"];

/// Plays recorded readings at the pace of the recording.
#[derive(Clone, Debug)]
pub struct Replay {
    rows: Vec<(f64, Wrench)>,
    clock: BenchClock,
    /// Time of the bench clock at which the first row is due, s.
    begun_s: f64,
    played: usize,
}

impl Replay {
    /// Reads a CSV file and begins to play it. See [`Replay::rows`].
    ///
    /// # Errors
    /// A file that cannot be read, and those of [`Replay::rows`].
    pub fn open(path: &Path, clock: BenchClock) -> Result<Self, RigError> {
        let file = path.display().to_string();
        let text = std::fs::read_to_string(path)
            .map_err(|found| RigError::file(&file, format!("cannot be read: {found}")))?;
        Ok(Self::new(Self::rows(&file, &text)?, clock))
    }

    /// Begins to play rows of a time, s, and a reading. The times must increase.
    #[must_use]
    pub fn new(rows: Vec<(f64, Wrench)>, clock: BenchClock) -> Self {
        Self {
            rows,
            begun_s: clock.now_s(),
            clock,
            played: 0,
        }
    }

    /// Reads times, s, and readings from CSV. The header must name the columns `time_s`, `fx_n`,
    /// `fy_n`, `fz_n`, `tx_n_mm`, `ty_n_mm` and `tz_n_mm`, in any order; other columns are allowed.
    /// `file` is the name in errors.
    ///
    /// # Errors
    /// A missing column, a cell that is no finite number, times that do not increase.
    pub fn rows(file: &str, text: &str) -> Result<Vec<(f64, Wrench)>, RigError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut lines = (1..)
            .zip(text.lines())
            .filter(|(_, line)| !line.trim().is_empty());
        let header: Vec<&str> = lines
            .next()
            .map(|(_, line)| line.split(',').map(str::trim).collect())
            .unwrap_or_default();
        let mut places = [0; COLUMNS.len()];
        for (place, column) in places.iter_mut().zip(COLUMNS) {
            *place = header
                .iter()
                .position(|name| *name == column)
                .ok_or_else(|| RigError::file(file, format!("no column `{column}`")))?;
        }
        let mut rows: Vec<(f64, Wrench)> = Vec::new();
        for (number, line) in lines {
            let place = format!("{file}:{number}");
            let cells: Vec<&str> = line.split(',').map(str::trim).collect();
            let mut values = [0.0; COLUMNS.len()];
            for ((value, at), column) in values.iter_mut().zip(places).zip(COLUMNS) {
                let cell = cells.get(at).copied().unwrap_or_default();
                *value = cell
                    .parse()
                    .ok()
                    .filter(|number: &f64| number.is_finite())
                    .ok_or_else(|| {
                        RigError::file(
                            &place,
                            format!("`{column}` is `{cell}`, expected a finite number"),
                        )
                    })?;
            }
            let [time_s, axes @ ..] = values;
            if let Some((before_s, _)) = rows.last().filter(|(before_s, _)| time_s <= *before_s) {
                let problem = format!("`time_s` is {time_s} after {before_s}, expected increasing times");
                return Err(RigError::file(&place, problem));
            }
            rows.push((time_s, Wrench::from_axes(axes)));
        }
        Ok(rows)
    }
}

impl WrenchSource for Replay {
    /// The next row when it is due. Always `None` after the last row.
    fn next_sample(&mut self, within: Duration) -> Result<Option<WrenchSample>, RigError> {
        let now_s = self.clock.now_s();
        let due_s = self.rows.get(self.played).map_or(f64::INFINITY, |(time_s, _)| {
            self.begun_s + time_s - self.rows[0].0
        });
        let wait_s = (due_s - now_s).max(0.0);
        if wait_s > within.as_secs_f64() {
            std::thread::sleep(within);
            return Ok(None);
        }
        std::thread::sleep(Duration::from_secs_f64(wait_s));
        let (time_s, wrench) = self.rows[self.played];
        self.played += 1;
        Ok(Some(WrenchSample {
            stamp: self.clock.stamp(Some(time_s)),
            wrench,
            sequence: None,
            status: 0,
            lost_before: 0,
        }))
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    const TEXT: &str = "time_s,fx_n,fy_n,fz_n,tx_n_mm,ty_n_mm,tz_n_mm,note\n\
        10.0, 0.1,0,-1.5,0,2,0,a\n\n10.02,0.2,0,-1.6,0,2,0,b\n";

    #[test]
    fn rows_come_when_they_are_due() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("press.csv");
        std::fs::write(&path, TEXT).unwrap();
        let clock = BenchClock::start();
        let mut replay = Replay::open(&path, clock).unwrap();
        let first = replay.next_sample(Duration::ZERO).unwrap().unwrap();
        assert_eq!(first.wrench.force_n, DVec3::new(0.1, 0.0, -1.5));
        assert_eq!(first.stamp.source_s, Some(10.0));
        let second = replay.next_sample(Duration::from_secs(60)).unwrap().unwrap();
        let due_s = replay.begun_s + 0.02;
        assert!(second.stamp.bench_s >= due_s - 1e-6 && second.stamp.bench_s <= clock.now_s());
        assert_eq!(second.wrench.torque_n_mm, DVec3::new(0.0, 2.0, 0.0));
        assert_eq!(
            replay.next_sample(Duration::from_millis(1)).unwrap(),
            None,
            "over"
        );
        let in_an_hour = Replay::rows("press.csv", &TEXT.replace("10.02", "3610.0")).unwrap();
        let mut replay = Replay::new(in_an_hour, clock);
        assert!(replay.next_sample(Duration::ZERO).unwrap().is_some());
        assert_eq!(
            replay.next_sample(Duration::from_millis(1)).unwrap(),
            None,
            "not due yet"
        );
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (from, to, words) in [
            ("fy_n", "fy", "press.csv: no column `fy_n`"),
            ("0.2", "x", "press.csv:4: `fx_n` is `x`"),
            ("-1.6,0,2,0,b", "-1.6", "press.csv:4: `tx_n_mm` is ``"),
            ("10.02", "9.0", "press.csv:4: `time_s` is 9 after 10"),
            ("0.2", "nan", "press.csv:4: `fx_n` is `nan`"),
        ] {
            let error = Replay::rows("press.csv", &TEXT.replacen(from, to, 1)).unwrap_err();
            assert!(error.to_string().starts_with(words), "{error}");
        }
        assert!(Replay::rows("empty.csv", "").is_err());
    }
}
