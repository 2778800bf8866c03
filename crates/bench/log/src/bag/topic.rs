//! The messages of one topic, as columns.

use std::collections::BTreeMap;

use twintac_recording::BagTopic;

use super::definition::Kind;
use super::fields::{Path, descend, find, names, take};
use crate::cdr::Decoder;
use crate::mcap::Schema;

/// The encodings of messages and of definitions in ROS 2.
const MESSAGES: &str = "cdr";
const DEFINITIONS: &str = "ros2msg";

/// Names of the fields with the time of measurement.
const STAMPS: [[&str; 2]; 2] = [["header", "stamp"], ["", "stamp"]];

const NS_PER_S: i64 = 1_000_000_000;

/// A topic, and how its messages are decoded.
#[derive(Debug)]
pub(super) struct Topic {
    pub(super) read: BagTopic,
    kind: Option<Kind>,
    /// Whether any of its fields is requested.
    is_wanted: bool,
    /// Requested fields that may exist, with their paths.
    wanted: Vec<(String, Path)>,
    /// Paths of the seconds and nanoseconds of the time of measurement.
    stamp: Option<[Path; 2]>,
    /// Number of messages that do not have the structure of their type.
    n_wrong: u64,
}

impl Topic {
    /// A topic with the requested fields.
    pub(super) fn new(name: &str, encoding: &str, schema: &Schema, fields: Option<&[&str]>) -> Self {
        let kind = kind(encoding, schema);
        let (kind, problem) = match kind {
            Ok(kind) => (Some(kind), None),
            Err(problem) => (None, Some(problem)),
        };
        let path = |field: &&str| Some(((*field).to_owned(), find(kind.as_ref()?, field)?));
        let wanted: Vec<(String, Path)> = fields.unwrap_or_default().iter().filter_map(path).collect();
        let columns = wanted.iter().map(|(field, _)| (field.clone(), Vec::new()));
        Self {
            read: BagTopic {
                name: name.to_owned(),
                kind: schema.name.clone(),
                messages: 0,
                fields: problem.map_or(Ok(Vec::new()), Err),
                numbers: Vec::new(),
                log_ns: Vec::new(),
                stamp_ns: Vec::new(),
                columns: columns.collect(),
            },
            is_wanted: fields.is_some(),
            stamp: kind.as_ref().and_then(stamp),
            kind,
            wanted,
            n_wrong: 0,
        }
    }

    /// Decodes a message.
    pub(super) fn push(&mut self, log_ns: u64, message: &[u8]) {
        self.read.messages += 1;
        let Some(kind) = &self.kind else { return };
        if self.read.messages == 1 {
            let names = Decoder::of_others(message).and_then(|mut d| names(kind, &mut d));
            self.read.fields = Ok(names.unwrap_or_default());
        }
        if !self.is_wanted {
            return;
        }
        let stamp = self.stamp.iter().flatten();
        let paths = self.wanted.iter().map(|(_, path)| path).chain(stamp);
        let wanted: Vec<(&[usize], usize)> = paths.map(Vec::as_slice).zip(0..).collect();
        let mut numbers = vec![None; wanted.len()];
        let taken = Decoder::of_others(message).and_then(|mut d| take(kind, &mut d, &wanted, &mut numbers));
        if taken.is_none() {
            self.n_wrong += 1;
            return;
        }
        for ((field, _), number) in self.wanted.iter().zip(&numbers) {
            if let Some(column) = self.read.columns.get_mut(field) {
                column.push(number.unwrap_or(f64::NAN));
            }
        }
        if let [seconds, nanoseconds] = numbers[self.wanted.len()..] {
            let whole = |number: Option<f64>| number.unwrap_or(0.0) as i64;
            self.read.stamp_ns.push(
                whole(seconds)
                    .saturating_mul(NS_PER_S)
                    .saturating_add(whole(nanoseconds)),
            );
        }
        self.read.numbers.push(self.read.messages);
        self.read.log_ns.push(i64::try_from(log_ns).unwrap_or(i64::MAX));
    }

    /// The topic without fields that no message has, and a remark for people.
    pub(super) fn finish(mut self) -> (BagTopic, Option<String>) {
        let is_there = |column: &[f64]| column.iter().any(|number| !number.is_nan());
        let is_named = |field: &str| match &self.read.fields {
            Ok(fields) => fields
                .iter()
                .any(|name| name == field || name.ends_with(&format!(".{field}"))),
            Err(_) => false,
        };
        self.read
            .columns
            .retain(|field, column| is_there(column) || is_named(field));
        let BagTopic {
            name, kind, messages, ..
        } = &self.read;
        let note = (self.n_wrong > 0).then(|| {
            format!(
                "{} of {messages} messages of {name} do not match their type {kind} and are left out",
                self.n_wrong
            )
        });
        (self.read, note)
    }
}

/// The structure of the messages, or why they cannot be read.
fn kind(encoding: &str, schema: &Schema) -> Result<Kind, String> {
    if encoding != MESSAGES {
        return Err(format!(
            "its messages are `{encoding}`, expected `{MESSAGES}` of ROS 2"
        ));
    }
    if schema.encoding != DEFINITIONS {
        return Err(format!(
            "its definition is `{}`, expected `{DEFINITIONS}`",
            schema.encoding
        ));
    }
    if schema.text.is_empty() {
        return Err("its definition is not in the bag".to_owned());
    }
    Kind::of_message(&schema.name, &schema.text)
}

/// The paths of seconds and nanoseconds of the time of measurement.
fn stamp(kind: &Kind) -> Option<[Path; 2]> {
    STAMPS.iter().find_map(|before| {
        let at = |part: &str| {
            let names = before.iter().copied().filter(|name| !name.is_empty());
            descend(kind, &names.chain([part]).collect::<Vec<&str>>())
        };
        Some([at("sec")?, at("nanosec")?])
    })
}

/// The requested fields of each topic, by its name.
pub(super) fn by_topic<'a>(columns: &[&'a str]) -> BTreeMap<&'a str, Vec<&'a str>> {
    let mut fields = BTreeMap::<&str, Vec<&str>>::new();
    for (topic, field) in columns.iter().filter_map(|column| column.split_once(':')) {
        fields.entry(topic).or_default().push(field);
    }
    fields
}
