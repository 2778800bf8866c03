//! `twintac stream`: touch as it happens.

use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};
use twintac_live::{Format, Live, Origin, StopAfter, dashboard, stream_rows};
use twintac_source::{Known, Tally};

use super::files::sensor_or_phystac;
use crate::arguments::{RowFormat, Stream};
use crate::progress::say;

pub(super) fn run(arguments: &Stream) -> Result<()> {
    let sensor = sensor_or_phystac(arguments.sensor.as_deref())?;
    let known = Known {
        counts_per_pa: arguments.scale,
        altitude_m: arguments.altitude_m,
    };
    let mut live = Live::open(&origin(arguments), &sensor.sensor, &sensor.text, &known)?;
    for note in &live.notes {
        say(note);
    }
    let format = match arguments.format {
        None => {
            // A terminal that is closed and a program that is ended leave the terminal as it was.
            static STOP: AtomicBool = AtomicBool::new(false);
            ctrlc::set_handler(|| STOP.store(true, Ordering::Relaxed)).context("listening to signals")?;
            return dashboard::run(&mut live.source, live.about, &arguments.out, &STOP)
                .map(|tally| sum_up(&tally))
                .map_err(Into::into);
        }
        Some(RowFormat::Csv) => Format::Csv,
        Some(RowFormat::Jsonl) => Format::JsonLines,
    };
    let limits = StopAfter {
        frames: arguments.frames,
        seconds: arguments.seconds,
    };
    let out = std::io::stdout().lock();
    let streamed = stream_rows(&mut live.source, &live.about, format, limits, out)?;
    sum_up(&streamed.tally);
    Ok(())
}

/// Where the frames come from.
fn origin(arguments: &Stream) -> Origin {
    let line = arguments.line.clone().unwrap_or_default();
    match (
        &arguments.bus,
        &arguments.serial,
        &arguments.udp,
        &arguments.replay,
    ) {
        (Some(bus), ..) => Origin::Bus(bus.clone()),
        (_, Some(port), ..) => Origin::Serial {
            port: port.clone(),
            line,
        },
        (_, _, Some(address), _) => Origin::Udp {
            address: address.clone(),
            line,
        },
        (.., Some(log)) => Origin::Log(log.clone()),
        _ => Origin::Emulated,
    }
}

/// Says what was lost, if anything was.
fn sum_up(tally: &Tally) {
    if tally.missed + tally.failed > 0 {
        let Tally {
            read, missed, failed, ..
        } = tally;
        say(&format!(
            "{read} frames were read; {missed} of them missed; {failed} times none came"
        ));
    }
    for remark in &tally.remarks {
        say(remark);
    }
}
