//! Writes frames of a source as rows or to a log, until a limit is reached.

use std::io::{ErrorKind, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use twintac_log::LogError;
use twintac_source::{FrameSource, Reading, SourceError, Tally};

use crate::{About, Format, LiveError, RowWriter, Tare, Taring, TouchRecording};

/// Longest wait for a frame before the limits are checked.
const PATIENCE: Duration = Duration::from_secs(1);

/// When to end.
#[derive(Clone, Copy, Debug, Default)]
pub struct StopAfter {
    /// After this number of frames.
    pub frames: Option<u64>,
    /// After this time, s of the bench clock, from the first frame on.
    pub seconds: Option<f64>,
    /// When this flag is set.
    pub asked: Option<&'static AtomicBool>,
}

impl StopAfter {
    /// Whether the number of frames or their time has reached a limit.
    fn is_enough(&self, frames: u64, seconds: f64) -> bool {
        self.frames.is_some_and(|most| frames >= most) || self.seconds.is_some_and(|most| seconds >= most)
    }
}

/// Totals of a stream.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Streamed {
    /// Rows that were written, or frames that were handed to the log.
    pub rows: u64,
    /// Time from the first of them to the last, s of the bench clock.
    pub seconds: f64,
    /// A remark for people about temperatures, if there is one.
    pub remark: Option<String>,
    /// The source's counts.
    pub tally: Tally,
}

/// Writes rows until a limit is reached or nobody reads them any more. A pipe whose reader has
/// closed it is no error.
///
/// The first [`Taring::FRAMES`] frames make the tare, so nothing may touch the sensor. They are
/// written as rows too. With a log, the frames of all rows are also recorded.
///
/// # Errors
/// Those of [`FrameSource::next`]; [`LiveError::Write`]; [`LiveError::Log`].
pub fn stream_rows(
    source: &mut FrameSource,
    about: &About,
    format: Format,
    limits: StopAfter,
    out: impl Write,
    log: Option<&mut TouchRecording>,
) -> Result<Streamed, LiveError> {
    let writer = RowWriter::new(out, format, about).map_err(LiveError::Write);
    let mut streamed = Streamed::default();
    let result = writer.and_then(|writer| {
        let rows = Rows {
            writer,
            log,
            limits,
            first_s: 0.0,
            streamed: &mut streamed,
        };
        rows.write_all(source, Taring::new(about.kpa_per_k.clone()))
    });
    ended(result, streamed, source)
}

/// Records frames without writing rows, until a limit is reached. No tare is taken: a log has the
/// readings as the sensor gave them.
///
/// # Errors
/// Those of [`FrameSource::next`]; [`LiveError::Log`]: the log cannot be written. Frames for which
/// the disk was too slow are marked in it.
pub fn record_frames(
    source: &mut FrameSource,
    log: &mut TouchRecording,
    limits: StopAfter,
) -> Result<Streamed, LiveError> {
    let mut streamed = Streamed::default();
    let result = record_all(source, log, limits, &mut streamed);
    ended(result, streamed, source)
}

fn record_all(
    source: &mut FrameSource,
    log: &mut TouchRecording,
    limits: StopAfter,
    streamed: &mut Streamed,
) -> Result<(), LiveError> {
    let mut first_s = None;
    while let Some(reading) = next(source, limits)? {
        let seconds = reading.bench_s - *first_s.get_or_insert(reading.bench_s);
        if limits.is_enough(streamed.rows, seconds) {
            break;
        }
        record(log, &reading)?;
        (streamed.rows, streamed.seconds) = (streamed.rows + 1, seconds);
    }
    Ok(())
}

/// The next frame, unless the end is requested before it comes.
fn next(source: &mut FrameSource, limits: StopAfter) -> Result<Option<Reading>, LiveError> {
    let is_asked = || limits.asked.is_some_and(|asked| asked.load(Ordering::Relaxed));
    while !is_asked() {
        if let Some(reading) = source.next(PATIENCE)? {
            return Ok(Some(reading));
        }
    }
    Ok(None)
}

/// Hands a frame to the log. A frame for which the disk is too slow is marked there, and later ones
/// may be accepted.
fn record(log: &mut TouchRecording, reading: &Reading) -> Result<(), LiveError> {
    match log.push(reading) {
        Err(LiveError::Log(LogError::Behind { .. })) => Ok(()),
        result => result,
    }
}

/// The totals of a stream. The end of the source is no error.
fn ended(
    result: Result<(), LiveError>,
    mut streamed: Streamed,
    source: &FrameSource,
) -> Result<Streamed, LiveError> {
    streamed.tally = source.tally();
    match result {
        Err(LiveError::Write(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(streamed),
        Err(LiveError::Source(SourceError::Over)) => Ok(streamed),
        result => result.map(|()| streamed),
    }
}

/// Rows that are being written.
struct Rows<'a, W> {
    writer: RowWriter<W>,
    log: Option<&'a mut TouchRecording>,
    limits: StopAfter,
    /// Time of the first row.
    first_s: f64,
    streamed: &'a mut Streamed,
}

impl<W: Write> Rows<'_, W> {
    fn write_all(mut self, source: &mut FrameSource, mut taring: Taring) -> Result<(), LiveError> {
        let mut waiting = Vec::new();
        let mut tare = loop {
            let Some(reading) = next(source, self.limits)? else {
                return Ok(());
            };
            let tare = taring.push(&reading);
            waiting.push(reading);
            if let Some(tare) = tare {
                break tare;
            }
        };
        self.first_s = waiting[0].bench_s;
        for reading in &waiting {
            if self.write(reading, &mut tare)? {
                return Ok(());
            }
        }
        while let Some(reading) = next(source, self.limits)? {
            if self.write(&reading, &mut tare)? {
                break;
            }
        }
        Ok(())
    }

    /// Writes a row, unless a limit is reached. Returns whether a limit is reached.
    fn write(&mut self, reading: &Reading, tare: &mut Tare) -> Result<bool, LiveError> {
        let seconds = reading.bench_s - self.first_s;
        let is_enough = self.limits.is_enough(self.streamed.rows, seconds);
        if !is_enough {
            if let Some(log) = &mut self.log {
                record(log, reading)?;
            }
            self.writer.write(reading, tare).map_err(LiveError::Write)?;
            self.streamed.rows += 1;
            self.streamed.seconds = seconds;
            if self.streamed.remark.is_none() {
                self.streamed.remark = tare.remark();
            }
        }
        Ok(is_enough)
    }
}
