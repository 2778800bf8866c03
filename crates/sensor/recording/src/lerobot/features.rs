//! The features of a frame of an episode.

use serde_json::{Value, json};

use super::columns::{LeRobotColumn, LeRobotValues};
use super::episode::Episode;
use crate::{Press, Recording};

/// Names of a pose's numbers.
const POSE: [&str; 7] = ["x_mm", "y_mm", "z_mm", "qx", "qy", "qz", "qw"];

/// The type in which a feature's numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Single,
    Whole,
    Flag,
}

/// The numbers of a feature, from an episode, its index, and the index of a frame.
type Numbers = Box<dyn Fn(&Episode, usize, usize) -> Vec<f64>>;

/// One feature of every frame.
pub(super) struct Feature {
    pub(super) name: String,
    kind: Kind,
    /// Names of its numbers; empty for a single number without a name.
    names: Vec<String>,
    value: Numbers,
    /// Which of its numbers are usable. `None`: all are.
    usable: Option<fn(&Press, usize) -> &[bool]>,
}

/// The features of a recording, in the order of columns.
pub(super) fn features(recording: &Recording) -> Vec<Feature> {
    let mut features = vec![
        Feature {
            name: "observation.state".to_owned(),
            kind: Kind::Single,
            names: POSE.map(str::to_owned).to_vec(),
            value: Box::new(|episode, _, frame| pose(episode.press, frame)),
            usable: None,
        },
        Feature {
            name: "observation.tactile".to_owned(),
            kind: Kind::Single,
            names: recording
                .taxels
                .iter()
                .map(|taxel| format!("{taxel}_kpa"))
                .collect(),
            value: Box::new(|episode, _, frame| episode.press.taxels_kpa[frame].clone()),
            usable: Some(|press, frame| &press.valid[frame]),
        },
    ];
    if recording.presses.iter().all(|press| press.force_n.is_some()) {
        features.push(Feature {
            name: "observation.force".to_owned(),
            kind: Kind::Single,
            names: vec!["force_n".to_owned()],
            value: Box::new(|episode, _, frame| {
                let force_n = episode.press.force_n.as_ref();
                vec![force_n.expect("all presses have a force")[frame]]
            }),
            usable: None,
        });
    }
    features.push(Feature {
        name: "action".to_owned(),
        kind: Kind::Single,
        names: POSE.map(str::to_owned).to_vec(),
        value: Box::new(|episode, _, frame| {
            let last = episode.press.time_s.len() - 1;
            pose(episode.press, (frame + 1).min(last))
        }),
        usable: None,
    });
    features.push(Feature {
        name: "tactile_valid".to_owned(),
        kind: Kind::Flag,
        names: recording
            .taxels
            .iter()
            .map(|taxel| format!("{taxel}_valid"))
            .collect(),
        value: Box::new(|episode, _, frame| {
            let flags = episode.press.valid[frame].iter();
            flags.map(|flag| f64::from(u8::from(*flag))).collect()
        }),
        usable: None,
    });
    features.push(Feature {
        name: "timestamp".to_owned(),
        kind: Kind::Single,
        names: Vec::new(),
        value: Box::new(|episode, _, frame| {
            let time_s = &episode.press.time_s;
            vec![time_s[frame] - time_s[0]]
        }),
        usable: None,
    });
    features.extend([
        whole("frame_index", |_, _, frame| frame),
        whole("episode_index", |_, index, _| index),
        whole("index", |episode, _, frame| episode.first + frame),
        whole("task_index", |episode, _, _| episode.task),
    ]);
    features
}

fn whole(name: &str, value: impl Fn(&Episode, usize, usize) -> usize + 'static) -> Feature {
    Feature {
        name: name.to_owned(),
        kind: Kind::Whole,
        names: Vec::new(),
        value: Box::new(move |episode, index, frame| vec![value(episode, index, frame) as f64]),
        usable: None,
    }
}

fn pose(press: &Press, frame: usize) -> Vec<f64> {
    let pose = &press.gel_from_indenter[frame];
    let place_mm = pose.position_mm.to_array();
    place_mm.into_iter().chain(pose.rotation.to_array()).collect()
}

impl Feature {
    /// Its numbers in every frame of an episode with this index.
    pub(super) fn rows<'a>(
        &'a self,
        episode: &'a Episode,
        index: usize,
    ) -> impl Iterator<Item = Vec<f64>> + 'a {
        (0..episode.press.time_s.len()).map(move |frame| (self.value)(episode, index, frame))
    }

    /// Its numbers with NaN for unusable ones, for statistics.
    pub(super) fn usable_rows<'a>(
        &'a self,
        episode: &'a Episode,
        index: usize,
    ) -> impl Iterator<Item = Vec<f64>> + 'a {
        let rows = self.rows(episode, index).enumerate();
        rows.map(|(frame, mut row)| {
            if let Some(usable) = self.usable {
                let flags = row.iter_mut().zip(usable(episode.press, frame));
                flags
                    .filter(|(_, usable)| !**usable)
                    .for_each(|(number, _)| *number = f64::NAN);
            }
            row
        })
    }

    /// Number of numbers in a frame.
    fn width(&self) -> usize {
        self.names.len().max(1)
    }

    /// Size in a frame, bytes.
    pub(super) fn bytes(&self) -> u64 {
        let of_one = match self.kind {
            Kind::Single => 4,
            Kind::Whole => 8,
            Kind::Flag => 1,
        };
        of_one * self.width() as u64
    }

    /// Its entry in `info.json`.
    pub(super) fn info(&self) -> Value {
        let names = (!self.names.is_empty()).then_some(&self.names);
        json!({"dtype": self.dtype(), "shape": [self.width()], "names": names})
    }

    /// NumPy's name of the type of its numbers.
    pub(super) fn dtype(&self) -> &'static str {
        match self.kind {
            Kind::Single => "float32",
            Kind::Whole => "int64",
            Kind::Flag => "bool",
        }
    }

    /// The names of its numbers, as text.
    pub(super) fn names(&self) -> String {
        self.names.join(", ")
    }

    /// Its column: lists if it has more than one number.
    pub(super) fn column(&self, rows: impl Iterator<Item = Vec<f64>>) -> LeRobotColumn {
        let typed = |numbers: Vec<f64>| match self.kind {
            Kind::Single => LeRobotValues::Single(numbers.into_iter().map(|number| number as f32).collect()),
            Kind::Whole => LeRobotValues::Whole(numbers.into_iter().map(|number| number as i64).collect()),
            Kind::Flag => LeRobotValues::Flag(numbers.into_iter().map(|number| number > 0.0).collect()),
        };
        if self.width() > 1 {
            return LeRobotColumn::lists(&self.name, rows.map(typed));
        }
        LeRobotColumn::single(&self.name, typed(rows.flatten().collect()))
    }
}
