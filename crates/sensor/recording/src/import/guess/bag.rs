//! Guesses the meaning of a bag's topics from their types and fields.

use std::collections::BTreeSet;
use std::path::Path;

use super::column::Column;
use super::roles::Roles;
use crate::RecordingError;
use crate::import::bag::{Bag, BagTopic, ReadBag, Rows, is_numbered_alike, listed, table};
use crate::import::cell::Kind;

/// The columns of topics whose meaning was guessed.
struct Meant {
    taxels: Vec<String>,
    temperatures: Vec<String>,
    place: Option<[String; 3]>,
    turn: Option<[String; 4]>,
    force: Option<String>,
    time: String,
}

/// These columns, with their numbers at the times of the taxels.
pub(super) struct Guessed {
    columns: Vec<Column>,
    meant: Meant,
}

impl Guessed {
    pub(super) fn new(path: &Path, bag: &Bag, read: ReadBag) -> Result<Self, RecordingError> {
        let file = path.display().to_string();
        let meant = Meant::new(bag).ok_or_else(|| RecordingError::Bag {
            file: file.clone(),
            problem: format!(
                "no topic looks like readings of taxels; the bag has {}",
                listed(bag)
            ),
        })?;
        let names = meant.names();
        let asked: Vec<&str> = names.iter().map(String::as_str).collect();
        let bag = read(path, &asked).unwrap_or_else(|| Ok(bag.clone()))?;
        let wanted: BTreeSet<(&str, Kind)> = asked.iter().map(|name| (*name, Kind::Reading)).collect();
        let rows = Rows {
            time: Some(&meant.time),
            first: &meant.taxels[0],
            rotation: None,
            usable: [f64::NEG_INFINITY, f64::INFINITY],
            drops_incomplete: true,
        };
        let table = table(&file, bag, &wanted, &rows)?;
        let column = |name: &String| {
            let mut column = Column::named(name.clone());
            column.unit = unit(name).map(str::to_owned);
            column.numbers = table.column(name, Kind::Reading).to_vec();
            column
        };
        Ok(Self {
            columns: names.iter().map(column).collect(),
            meant,
        })
    }

    pub(super) fn roles(&self) -> Roles<'_> {
        let named = |name: &String| self.columns.iter().find(|column| column.name == *name);
        let all = |names: &[String]| names.iter().filter_map(named).collect::<Vec<&Column>>();
        let meant = &self.meant;
        Roles {
            time: named(&meant.time),
            place: match &meant.place {
                Some(place) => place.each_ref().map(named),
                None => [None; 3],
            },
            turn: meant.turn.as_ref().and_then(|turn| all(turn).try_into().ok()),
            force: meant.force.as_ref().and_then(named),
            press: None,
            taxels: all(&meant.taxels),
            temperatures: all(&meant.temperatures),
        }
    }
}

impl Meant {
    fn new(bag: &Bag) -> Option<Self> {
        let taxels = taxels(bag)?;
        let name = taxels[0].split_once(':')?.0;
        let is_stamped = bag
            .topics
            .iter()
            .any(|topic| topic.name == name && !topic.stamp_ns.is_empty());
        let xyz = ["x", "y", "z"];
        let of = |message: &str, axes: &[&str]| {
            let fields: Vec<String> = axes.iter().map(|axis| format!("{message}.{axis}")).collect();
            columns(bag, &fields)
        };
        let first =
            |messages: [&str; 2], axes: &[&str]| messages.iter().find_map(|message| of(message, axes));
        Some(Self {
            time: format!("{name}:{}", if is_stamped { "stamp" } else { "log_time" }),
            temperatures: of_kind(bag, "sensor_msgs/msg/Temperature", "temperature"),
            place: first(["position", "translation"], &xyz).and_then(|names| names.try_into().ok()),
            turn: first(["orientation", "rotation"], &["x", "y", "z", "w"])
                .and_then(|names| names.try_into().ok()),
            force: first(["force", "wrench.force"], &xyz).and_then(|mut names| names.pop()),
            taxels,
        })
    }

    /// All columns.
    fn names(&self) -> Vec<String> {
        let places = self.place.iter().flatten().chain(self.turn.iter().flatten());
        let readings = self.taxels.iter().chain(&self.temperatures);
        let all = places.chain(&self.force).chain(readings).chain([&self.time]);
        all.cloned().collect()
    }
}

/// The longest array of numbers of a topic; if there is none, all topics of barometers.
fn taxels(bag: &Bag) -> Option<Vec<String>> {
    let arrays = bag.topics.iter().flat_map(|topic| {
        let fields = topic.fields.as_deref().unwrap_or_default();
        let arrays = fields.chunk_by(|one, other| is_numbered_alike(one, other));
        let is_array = |array: &&[String]| array.len() > 1 && !array[0].contains("covariance");
        let named = |array: &[String]| array.iter().map(|field| column(topic, field)).collect::<Vec<_>>();
        arrays.filter(is_array).map(named).collect::<Vec<_>>()
    });
    let longest = arrays.reduce(|longest, next| if next.len() > longest.len() { next } else { longest });
    let barometers = of_kind(bag, "sensor_msgs/msg/FluidPressure", "fluid_pressure");
    longest
        .filter(|array| array.len() >= barometers.len())
        .or(Some(barometers).filter(|barometers| !barometers.is_empty()))
}

/// A field of each topic of a type.
fn of_kind(bag: &Bag, kind: &str, field: &str) -> Vec<String> {
    let topics = bag
        .topics
        .iter()
        .filter(|topic| topic.kind == kind && topic.messages > 0);
    topics.map(|topic| column(topic, field)).collect()
}

/// Columns of the first topic that has all fields. A field may be the end of a longer name.
fn columns(bag: &Bag, fields: &[String]) -> Option<Vec<String>> {
    bag.topics.iter().find_map(|topic| {
        let has = |field: &String| {
            let own = topic.fields.as_deref().unwrap_or_default();
            let ends = own
                .iter()
                .filter(|own| *own == field || own.ends_with(&format!(".{field}")));
            ends.count() == 1
        };
        let all = fields.iter().all(has);
        all.then(|| fields.iter().map(|field| column(topic, field)).collect())
    })
}

fn column(topic: &BagTopic, field: &str) -> String {
    format!("{}:{field}", topic.name)
}

/// The unit of a field of ROS's own messages, which use SI units.
fn unit(column: &str) -> Option<&'static str> {
    let field = column.split_once(':')?.1;
    match field {
        "stamp" | "log_time" => Some("s"),
        "fluid_pressure" => Some("pa"),
        _ if field.starts_with("position.") || field.starts_with("translation.") => Some("m"),
        _ => None,
    }
}
