//! `twintac stream`: shows or records a sensor's frames live.

use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result, bail};
use twintac_live::{About, Format, Live, StopAfter, TouchRecording, dashboard, record_frames, stream_rows};
use twintac_source::Tally;

use super::files::sensor_or_phystac;
use crate::arguments::{RowFormat, Stream};
use crate::progress::say;

pub(super) fn run(arguments: &Stream) -> Result<()> {
    if arguments.temperature.is_some() && arguments.format.is_none() && arguments.log.is_some() {
        bail!(
            "--temperature is for rows and the dashboard: a log has the uncompensated readings; leave it out, or add --format"
        );
    }
    let sensor = sensor_or_phystac(arguments.sensor.as_deref())?;
    let origin = arguments.wire.origin().context("no source was named")?;
    let mut live = Live::open(&origin, &sensor.sensor, &sensor.text, &arguments.wire.known())?;
    for note in &live.notes {
        say(note);
    }
    if let Some(file) = &arguments.temperature {
        live.compensate(file)?;
    }
    let Some(written) = Written::of(arguments, &live.about)? else {
        let tally = dashboard::run(&mut live.source, live.about, &arguments.out, ended()?)?;
        sum_up(&tally);
        return Ok(());
    };
    let limits = StopAfter {
        frames: arguments.frames,
        seconds: arguments.seconds,
        asked: written.log().is_some().then(ended).transpose()?,
    };
    let (source, about) = (&mut live.source, &live.about);
    let (streamed, log) = match written {
        Written::Log(mut log) => (record_frames(source, &mut log, limits), Some(log)),
        Written::Rows(format, mut log) => {
            let out = std::io::stdout().lock();
            (stream_rows(source, about, format, limits, out, log.as_mut()), log)
        }
    };
    // The recording is finished, whatever ended the stream.
    let n_recorded = log.as_ref().map(TouchRecording::frames);
    if let Some(log) = log {
        let path = log.path().display().to_string();
        say(&format!("{path} has {} frames", log.finish()?));
    }
    let streamed = streamed?;
    let n_lost = n_recorded.map_or(0, |n_recorded| streamed.rows.saturating_sub(n_recorded));
    if n_lost > 0 {
        say(&format!(
            "{n_lost} frames are not in the log: the disk was too slow"
        ));
    }
    sum_up(&streamed.tally);
    streamed.remark.iter().for_each(|remark| say(remark));
    Ok(())
}

/// Where the frames of a stream are written.
enum Written {
    Log(TouchRecording),
    Rows(Format, Option<TouchRecording>),
}

impl Written {
    /// The requested outputs; `None` for the dashboard.
    fn of(arguments: &Stream, about: &About) -> Result<Option<Self>> {
        let log = arguments.log.as_deref();
        let log = log.map(|path| TouchRecording::create(path, about)).transpose()?;
        let format = arguments.format.map(|format| match format {
            RowFormat::Csv => Format::Csv,
            RowFormat::Jsonl => Format::JsonLines,
        });
        Ok(match (format, log) {
            (Some(format), log) => Some(Self::Rows(format, log)),
            (None, log) => log.map(Self::Log),
        })
    }

    fn log(&self) -> Option<&TouchRecording> {
        match self {
            Self::Log(log) => Some(log),
            Self::Rows(_, log) => log.as_ref(),
        }
    }
}

/// Set when the program has to end, so that the terminal is restored and the log is finished.
fn ended() -> Result<&'static AtomicBool> {
    static ENDED: AtomicBool = AtomicBool::new(false);
    ctrlc::set_handler(|| ENDED.store(true, Ordering::Relaxed)).context("listening to signals")?;
    Ok(&ENDED)
}

/// Prints what was lost, if anything was.
fn sum_up(tally: &Tally) {
    if tally.missed + tally.failed > 0 {
        let Tally {
            read, missed, failed, ..
        } = tally;
        say(&format!(
            "{read} frames were read, {missed} were missed, {failed} reads failed"
        ));
    }
    for remark in &tally.remarks {
        say(remark);
    }
}
