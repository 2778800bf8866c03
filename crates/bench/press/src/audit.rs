//! Reads a finished log again and finds losses that it does not mark.

use std::path::Path;

use twintac_log::{Body, Event, LogReader, Stream};

use crate::PressError;

/// Content of a log.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Audit {
    /// Tactile frames.
    pub(crate) frames: u64,
    /// Time from the first frame to the last, s.
    pub(crate) frames_s: f64,
    /// Tactile frames, wrenches and poses.
    pub(crate) readings: u64,
    /// Readings that are missing and whose gap is not marked.
    pub(crate) lost_unmarked: u64,
}

/// Reads a log. Tactile frames and poses count as missing where the time between two of them is
/// longer than allowed, s; wrenches where their own clock jumps.
pub(crate) fn audit(path: &Path, frame_gap_s: f64, report_gap_s: f64) -> Result<Audit, PressError> {
    let (mut frames, mut poses, mut wrenches, mut gaps) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for message in LogReader::open(path)? {
        let message = message?;
        let time_ns = message.bench_ns;
        match message.body {
            Body::Tactile(_) => frames.push(time_ns),
            Body::Pose(_) => poses.push(time_ns),
            Body::Wrench(reading) => wrenches.push((time_ns, reading)),
            Body::Event(Event::Gap {
                stream,
                from_ns,
                to_ns,
                ..
            }) => gaps.push((stream, from_ns, to_ns)),
            Body::Event(_) => {}
        }
    }
    let is_marked = |of: Stream, from_ns: u64, to_ns: u64| {
        gaps.iter().any(|(stream, gap_from_ns, gap_to_ns)| {
            stream.is_none_or(|stream| stream == of) && *gap_from_ns <= to_ns && *gap_to_ns >= from_ns
        })
    };
    let mut lost_unmarked = 0;
    for (stream, times_ns, longest_s) in [
        (Stream::Tactile, &frames, frame_gap_s),
        (Stream::Pose, &poses, report_gap_s),
    ] {
        let intervals = times_ns.windows(2).map(|pair| pair[1].saturating_sub(pair[0]));
        let usual_ns = median(intervals.filter(|interval| *interval > 0).collect()).max(1);
        lost_unmarked += times_ns
            .windows(2)
            .map(|pair| (pair, pair[1].saturating_sub(pair[0])))
            .filter(|(_, interval_ns)| *interval_ns as f64 > longest_s * 1e9 + 1e3) // stamps are rounded
            .filter(|(pair, _)| !is_marked(stream, pair[0], pair[1]))
            .map(|(_, interval_ns)| (interval_ns / usual_ns).saturating_sub(1).max(1))
            .sum::<u64>();
    }
    let source_us = |index: usize| Some((wrenches.get(index)?.1.source_s? * 1e6).round() as u64);
    let intervals: Vec<Option<u64>> = (1..wrenches.len())
        .map(|index| Some(source_us(index)?.saturating_sub(source_us(index - 1)?)))
        .collect();
    let usual_us = median(intervals.iter().copied().flatten().collect()).max(1);
    for (pair, interval_us) in wrenches.windows(2).zip(intervals) {
        let missing = interval_us
            .map_or(0, |us| (us + usual_us / 2) / usual_us)
            .saturating_sub(1);
        if missing > u64::from(pair[1].1.lost_before) && !is_marked(Stream::Wrench, pair[0].0, pair[1].0) {
            lost_unmarked += missing;
        }
    }
    let span_ns = frames
        .last()
        .zip(frames.first())
        .map_or(0, |(last, first)| last - first);
    Ok(Audit {
        frames: frames.len() as u64,
        frames_s: span_ns as f64 * 1e-9,
        readings: (frames.len() + poses.len() + wrenches.len()) as u64,
        lost_unmarked,
    })
}

fn median(mut values: Vec<u64>) -> u64 {
    values.sort_unstable();
    values.get(values.len() / 2).copied().unwrap_or(0)
}
