//! From a source to rows, until enough.

use std::io::{self, ErrorKind, Write};
use std::time::Duration;

use twintac_source::{FrameSource, Reading, SourceError, Tally};

use crate::{About, Format, LiveError, RowWriter, Tare, Taring};

/// When to end by oneself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StopAfter {
    /// After so many frames.
    pub frames: Option<u64>,
    /// After so long, s of the bench's clock, from the first frame on.
    pub seconds: Option<f64>,
}

/// What became of the frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Streamed {
    /// Rows that were written.
    pub rows: u64,
    /// From the first of them to the last, s of the bench's clock.
    pub seconds: f64,
    /// What the source counted meanwhile.
    pub tally: Tally,
}

/// Writes rows until a limit is reached or nobody reads them any more: a pipe whose reader has gone is no error.
///
/// The first [`Taring::FRAMES`] frames make the tare, so nothing may touch the sensor; they are rows as well.
///
/// # Errors
/// Those of [`FrameSource::next`]; [`LiveError::Write`].
pub fn stream_rows(
    source: &mut FrameSource,
    about: &About,
    format: Format,
    limits: StopAfter,
    out: impl Write,
) -> Result<Streamed, LiveError> {
    let mut streamed = Streamed::default();
    let result = write_rows(source, about, format, limits, out, &mut streamed);
    streamed.tally = source.tally();
    match result {
        Err(LiveError::Write(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(streamed),
        Err(LiveError::Source(SourceError::Over)) => Ok(streamed),
        result => result.map(|()| streamed),
    }
}

fn write_rows(
    source: &mut FrameSource,
    about: &About,
    format: Format,
    limits: StopAfter,
    out: impl Write,
    streamed: &mut Streamed,
) -> Result<(), LiveError> {
    const PATIENCE: Duration = Duration::from_secs(1);
    let mut writer = RowWriter::new(out, format, about).map_err(LiveError::Write)?;
    let (mut taring, mut waiting) = (Taring::default(), Vec::new());
    let tare = loop {
        let Some(reading) = source.next(PATIENCE)? else {
            continue;
        };
        let tare = taring.push(&reading.frame);
        waiting.push(reading);
        if let Some(tare) = tare {
            break tare;
        }
    };
    let first_s = waiting[0].bench_s;
    let mut write = |reading: &Reading, tare: &Tare| -> io::Result<bool> {
        let seconds = reading.bench_s - first_s;
        let is_enough = limits.frames.is_some_and(|most| streamed.rows >= most)
            || limits.seconds.is_some_and(|most| seconds >= most);
        if !is_enough {
            writer.write(reading, tare)?;
            streamed.rows += 1;
            streamed.seconds = seconds;
        }
        Ok(is_enough)
    };
    for reading in &waiting {
        if write(reading, &tare).map_err(LiveError::Write)? {
            return Ok(());
        }
    }
    loop {
        let Some(reading) = source.next(PATIENCE)? else {
            continue;
        };
        if write(&reading, &tare).map_err(LiveError::Write)? {
            return Ok(());
        }
    }
}
