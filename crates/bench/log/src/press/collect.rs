//! A log's messages, sorted by kind.

use std::io::Read;

use glam::DVec3;
use twintac_recording::Control;
use twintac_shape::Pose;

use super::options::ReadOptions;
use super::track::Track;
use crate::{
    Body, Description, Event, LogError, LogReader, PoseReading, Stream, TactileFrame, WrenchReading,
};

/// Everything from which presses are made.
pub(super) struct Collected {
    /// Times, ns, increasing, with frames.
    pub(super) frames: Vec<(u64, TactileFrame)>,
    /// Force of the indenter on the gel along -z, N.
    pub(super) force_n: Track<f64>,
    /// Pose of the indenter in the gel's frame.
    pub(super) poses: Track<Pose>,
    pub(super) spans: Vec<Span>,
    pub(super) remarks: Vec<String>,
}

/// A press, as its events delimit it.
pub(super) struct Span {
    /// Unique in the log.
    pub(super) name: String,
    pub(super) indenter: String,
    pub(super) control: Control,
    pub(super) from_ns: u64,
    /// The last time that belongs to the press.
    pub(super) to_ns: u64,
}

impl Collected {
    pub(super) fn of<R: Read>(reader: &mut LogReader<R>, options: &ReadOptions) -> Result<Self, LogError> {
        let description = reader.description().clone();
        let (mut frames, mut wrenches, mut poses, mut events) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for message in reader {
            let message = message?;
            let time_ns = message.bench_ns;
            match message.body {
                Body::Tactile(frame) => frames.push((time_ns, frame)),
                Body::Wrench(reading) => wrenches.push((time_ns, reading)),
                Body::Pose(reading) => poses.push((time_ns, reading)),
                Body::Event(event) => events.push((time_ns, event)),
            }
        }
        // Each stream comes from its own thread. Within a stream the messages are in order of time,
        // but the whole log is not.
        frames.sort_by_key(|(time_ns, _)| *time_ns);
        frames.dedup_by_key(|(time_ns, _)| *time_ns);
        events.sort_by_key(|(time_ns, _)| *time_ns);
        let longest_ns = options.longest_interpolated_ms.saturating_mul(1_000_000);
        let mut collected = Self {
            frames,
            force_n: Track::new(forces(&wrenches, &events, &description), longest_ns),
            poses: Track::new(gel_from_indenter(&poses, &description), longest_ns),
            spans: Vec::new(),
            remarks: Vec::new(),
        };
        for (time_ns, event) in events {
            collected.note(time_ns, event);
        }
        if let Some(open) = collected.open() {
            let remark = format!("press `{}` has no end: it lasts to the end of the log", open.name);
            collected.remarks.push(remark);
        }
        Ok(collected)
    }

    /// The press that has not ended.
    fn open(&mut self) -> Option<&mut Span> {
        self.spans.last_mut().filter(|span| span.to_ns == u64::MAX)
    }

    fn note(&mut self, time_ns: u64, event: Event) {
        match event {
            Event::PressBegun {
                name,
                indenter,
                control,
            } => {
                if let Some(open) = self.open() {
                    open.to_ns = time_ns.saturating_sub(1);
                    let remark = format!("press `{}` did not end before `{name}` began", open.name);
                    self.remarks.push(remark);
                }
                self.spans.push(Span {
                    name: self.unique(name),
                    indenter,
                    control,
                    from_ns: time_ns,
                    to_ns: u64::MAX,
                });
            }
            Event::PressEnded { name } => match self.open() {
                Some(open) => open.to_ns = time_ns,
                None => self
                    .remarks
                    .push(format!("press `{name}` ends without a beginning")),
            },
            Event::Gap {
                stream,
                cause,
                from_ns,
                to_ns,
                lost,
            } => {
                if stream.is_none_or(|stream| stream == Stream::Wrench) {
                    self.force_n.break_between(from_ns, to_ns);
                }
                if stream.is_none_or(|stream| stream == Stream::Pose) {
                    self.poses.break_between(from_ns, to_ns);
                }
                let what = stream.map_or("all streams".to_owned(), |stream| stream.to_string());
                let count = lost.map_or(String::new(), |lost| format!(", {lost} messages"));
                let (from_s, to_s) = (from_ns as f64 * 1e-9, to_ns as f64 * 1e-9);
                self.remarks.push(format!(
                    "gap in {what} from {from_s:.3} to {to_s:.3} s{count}: {cause}"
                ));
            }
            Event::Stopped { cause } => {
                let at_s = time_ns as f64 * 1e-9;
                self.remarks
                    .push(format!("the test setup stopped at {at_s:.3} s: {cause}"));
            }
            Event::Tare { .. } | Event::Note { .. } => {}
        }
    }

    fn unique(&self, name: String) -> String {
        let is_taken = |name: &str| self.spans.iter().any(|span| span.name == name);
        if !is_taken(&name) {
            return name;
        }
        let numbered = (2..).map(|number| format!("{name} ({number})"));
        numbered.into_iter().find(|name| !is_taken(name)).unwrap_or(name)
    }
}

/// Forces along the axis of the description, after subtracting the last tare. Readings that are NaN
/// count as missing.
fn forces(
    wrenches: &[(u64, WrenchReading)],
    events: &[(u64, Event)],
    description: &Description,
) -> Vec<(u64, f64, bool)> {
    let tares: Vec<(u64, DVec3)> = events
        .iter()
        .filter_map(|(time_ns, event)| match event {
            Event::Tare { force_n, .. } => Some((*time_ns, *force_n)),
            _ => None,
        })
        .collect();
    let force = |(time_ns, reading): &(u64, WrenchReading)| {
        let behind = tares.partition_point(|(at_ns, _)| at_ns <= time_ns);
        let tare_n = behind.checked_sub(1).map_or(DVec3::ZERO, |last| tares[last].1);
        let force_n = (reading.force_n - tare_n).dot(description.force_axis);
        (*time_ns, force_n, reading.lost_before > 0)
    };
    let mut is_after_loss = false;
    let mut forces = Vec::new();
    for (time_ns, force_n, lost) in wrenches.iter().map(force) {
        is_after_loss |= lost;
        if force_n.is_finite() {
            forces.push((time_ns, force_n, std::mem::take(&mut is_after_loss)));
        } else {
            is_after_loss = true;
        }
    }
    forces
}

/// Poses of the indenter in the gel's frame. Poses that are NaN count as missing.
fn gel_from_indenter(poses: &[(u64, PoseReading)], description: &Description) -> Vec<(u64, Pose, bool)> {
    let gel = &description.base_from_gel;
    let indenter = &description.tool_from_indenter;
    let mut is_after_loss = false;
    let mut placed = Vec::new();
    for (time_ns, reading) in poses {
        let base_from_tool = Pose {
            position_mm: reading.position_mm,
            rotation: reading.base_from_tool.normalize(),
        };
        let tip_mm = base_from_tool.transform_point(indenter.position_mm);
        let rotation = gel.rotation.inverse() * base_from_tool.rotation * indenter.rotation;
        let pose = Pose {
            position_mm: gel.inverse_transform_point(tip_mm),
            rotation: rotation.normalize(),
        };
        if pose.position_mm.is_finite() && pose.rotation.is_finite() {
            placed.push((*time_ns, pose, std::mem::take(&mut is_after_loss)));
        } else {
            is_after_loss = true;
        }
    }
    placed
}
