//! The channels of a file, and the parts of a message that go to each.

use std::collections::BTreeSet;

use super::definition::{
    DEFINITIONS, Definition, FLOAT32_MULTI_ARRAY, FLUID_PRESSURE, OF_LOGS, POSE_SAMPLE, POSE_STAMPED, STRING,
    TACTILE_FRAME, TEMPERATURE, WRENCH_SAMPLE, WRENCH_STAMPED,
};
use super::names::TopicNames;
use super::{sample, standard};
use crate::cdr::Encoder;
use crate::{Body, Stream};

/// The encoding of messages.
pub(crate) const MESSAGE_ENCODING: &str = "cdr";

const EVENTS: usize = 0;
const TACTILE: usize = 1;
const WRENCH: usize = 2;
const POSE: usize = 3;
const WRENCH_STANDARD: usize = 4;
const POSE_STANDARD: usize = 5;
const FIRST_TAXEL: usize = 6;

const FIXED: [(&str, usize); FIRST_TAXEL] = [
    ("/events", STRING),
    ("/tactile/frame", TACTILE_FRAME),
    ("/wrench/sample", WRENCH_SAMPLE),
    ("/robot/pose/sample", POSE_SAMPLE),
    ("/wrench", WRENCH_STAMPED),
    ("/robot/pose", POSE_STAMPED),
];

/// The stream of a channel, if the channel is read back.
pub(crate) fn stream_of(topic: &str, schema: &str) -> Option<Stream> {
    let is_ours = |index: usize| {
        let (name, definition) = FIXED[index];
        name == topic && DEFINITIONS[definition].name == schema
    };
    let places = [TACTILE, WRENCH, POSE, EVENTS];
    places
        .into_iter()
        .position(is_ours)
        .map(|place| Stream::ALL[place])
}

/// The channels of a file, by index.
#[derive(Debug)]
pub(crate) struct Topics {
    /// Topic, and index of the schema in [`DEFINITIONS`].
    pub(crate) channels: Vec<(String, usize)>,
    /// Schemas of the file.
    pub(crate) definitions: &'static [Definition],
    taxels: Vec<String>,
    /// For a file with standard messages only: the label of the array of all pressures.
    label: Option<String>,
}

impl Topics {
    pub(crate) fn new(taxels: &[String]) -> Self {
        let taxels = ros_names(taxels);
        let mut channels: Vec<(String, usize)> = FIXED
            .iter()
            .map(|(name, definition)| ((*name).to_owned(), *definition))
            .collect();
        for taxel in &taxels {
            channels.push((format!("/tactile/{taxel}/pressure"), FLUID_PRESSURE));
            channels.push((format!("/tactile/{taxel}/temperature"), TEMPERATURE));
        }
        Self {
            channels,
            definitions: &DEFINITIONS[..OF_LOGS],
            taxels,
            label: None,
        }
    }

    /// The channels of a file with standard messages only.
    pub(crate) fn standard(taxels: &[String], names: &TopicNames) -> Self {
        let label = format!("pressure_pa: {}", taxels.join(", "));
        let taxels = ros_names(taxels);
        let mut channels = vec![
            (names.events.clone(), STRING),
            (names.tactile.clone(), FLOAT32_MULTI_ARRAY),
            (names.wrench.clone(), WRENCH_STAMPED),
            (names.pose.clone(), POSE_STAMPED),
        ];
        for taxel in &taxels {
            channels.push((names.pressure_of(taxel), FLUID_PRESSURE));
            channels.push((names.temperature_of(taxel), TEMPERATURE));
        }
        Self {
            channels,
            definitions: &DEFINITIONS,
            taxels,
            label: Some(label),
        }
    }

    /// The index of a taxel's pressure channel. Its temperature channel follows.
    fn of_taxel(&self, index: usize) -> usize {
        self.channels.len() - 2 * (self.taxels.len() - index)
    }

    /// Calls `put` for each message to be written, with the index of its channel and the function
    /// that encodes it.
    pub(crate) fn each(
        &self,
        unix_ns: u64,
        body: &Body,
        mut put: impl FnMut(usize, &dyn Fn(&mut Encoder<'_>)),
    ) {
        match body {
            Body::Tactile(frame) => {
                put(TACTILE, &|e| match &self.label {
                    None => sample::put_tactile(e, unix_ns, frame),
                    Some(label) => standard::put_pressures(e, label, frame),
                });
                for (index, (taxel, name)) in frame.taxels.iter().zip(&self.taxels).enumerate() {
                    let pressure = self.of_taxel(index);
                    for (channel, number) in
                        [(pressure, taxel.pressure_pa), (pressure + 1, taxel.temperature_c)]
                    {
                        if let Some(number) = number {
                            put(channel, &|e| standard::put_scalar(e, unix_ns, name, number));
                        }
                    }
                }
            }
            Body::Wrench(reading) => {
                let standard = match self.label {
                    None => {
                        put(WRENCH, &|e| sample::put_wrench(e, unix_ns, reading));
                        WRENCH_STANDARD
                    }
                    Some(_) => WRENCH,
                };
                put(standard, &|e| standard::put_wrench(e, unix_ns, reading));
            }
            Body::Pose(reading) => {
                let standard = match self.label {
                    None => {
                        put(POSE, &|e| sample::put_pose(e, unix_ns, reading));
                        POSE_STANDARD
                    }
                    Some(_) => POSE,
                };
                put(standard, &|e| standard::put_pose(e, unix_ns, reading));
            }
            Body::Event(event) => {
                // Finite numbers and texts can always be JSON.
                let text = serde_json::to_string(event).unwrap_or_default();
                put(EVENTS, &|e| e.string(&text));
            }
        }
    }
}

/// Names that ROS allows in a topic: letters, digits and underscores, without a digit in first
/// place and without duplicates.
fn ros_names(names: &[String]) -> Vec<String> {
    let mut taken = BTreeSet::from(["frame".to_owned()]);
    let fresh = |(index, name): (usize, &String)| {
        let mut fresh: String = name
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
            .collect();
        if !fresh.starts_with(|c: char| c.is_ascii_alphabetic()) {
            fresh.insert_str(0, "taxel_");
        }
        while !taken.insert(fresh.clone()) {
            fresh = format!("{fresh}_{index}");
        }
        fresh
    };
    names.iter().enumerate().map(fresh).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn taxels_have_names_that_ros_takes() {
        let names = ["S0", "inner left", "7", "inner_left", "Mitte/µ", "frame"].map(str::to_owned);
        let expected = [
            "S0",
            "inner_left",
            "taxel_7",
            "inner_left_3",
            "Mitte__",
            "frame_5",
        ];
        assert_eq!(ros_names(&names), expected);
    }

    #[test]
    fn streams_are_told_by_topic_and_schema() {
        let topics = Topics::new(&["S0".to_owned()]);
        let streams: Vec<Option<Stream>> = topics
            .channels
            .iter()
            .map(|(topic, schema)| stream_of(topic, DEFINITIONS[*schema].name))
            .collect();
        let [tactile, wrench, pose, event] = Stream::ALL.map(Some);
        assert_eq!(streams, [event, tactile, wrench, pose, None, None, None, None]);
        assert_eq!(stream_of("/events", "std_msgs/msg/Empty"), None);
    }
}
