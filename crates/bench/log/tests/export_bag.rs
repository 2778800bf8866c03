//! Exports a log as a bag of standard messages, and reads it back through an import description.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

#[path = "bag/mod.rs"]
mod bag;
mod common;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use bag::{has, import};
use common::{NS_PER_S, begun, description, ended, event, frame, log, pose, wrench};
use glam::DVec3;
use twintac_log::{Ending, LogReader, Message, ReadOptions, TopicNames, export_bag, read_bag, read_presses};

/// The meaning of the bag of a log: the poses are those of the tool, 40 mm behind the tip, in the
/// robot's frame.
const BENCH: &str = r#"
sensor = "phystac"
provenance = "emulated"
indenter = "sphere"
gel_top_mm = 0.0
x = { column = "/arm/pose:position.x", unit = "m", offset = -300.0 }
y = { column = "/arm/pose:position.y", unit = "m", offset = -20.0 }
z = { column = "/arm/pose:position.z", unit = "m" }
rotation = { columns = ["/arm/pose:orientation.x", "/arm/pose:orientation.y", "/arm/pose:orientation.z", "/arm/pose:orientation.w"], upright = [1.0, 0.0, 0.0, 0.0] }
contact = { z_mm = 90.0 }
force = { column = "/wrench:force.z", unit = "N", scale = -1.0 }
readings = { unit = "Pa" }
taxels = [{ name = "S0", column = "/touch:data.0" }, { name = "S1", column = "/touch:data.1" }]
presses = { split = "return-to-rest", rest_mm = 97.0 }
zero = { above_contact_mm = 1.0, window_s = 0.5 }
"#;

/// One press of 2 s with a second of rest before and after it. All streams have the same times.
fn messages() -> Vec<Message> {
    let mut messages = Vec::new();
    for step in 0..400_u64 {
        let time_ns = step * NS_PER_S / 100;
        let down_mm = match step {
            100..=199 => (step - 99) as f64 * 0.1,
            200..=298 => (299 - step) as f64 * 0.1,
            _ => 0.0,
        };
        messages.push(frame(time_ns, 2));
        messages.push(wrench(time_ns, (down_mm - 7.0).max(0.0)));
        messages.push(pose(time_ns, 7.0 - down_mm));
    }
    messages.insert(3 * 90, event(NS_PER_S * 9 / 10, begun("p")));
    messages.push(event(NS_PER_S * 4, ended("p")));
    messages
}

fn names() -> TopicNames {
    let mut names = TopicNames::default();
    for (topic, name) in [
        ("tactile", "/touch"),
        ("pose", "/arm/pose"),
        ("pressure", "/baro/{taxel}"),
    ] {
        names.rename(topic, name).unwrap();
    }
    names
}

/// A log and the bag exported from it, in a folder.
fn exported(folder: &Path) -> (PathBuf, PathBuf) {
    let (own, bag) = (folder.join("own.mcap"), folder.join("p.mcap"));
    std::fs::write(&own, log(&description(2), &messages())).unwrap();
    let exported = export_bag(&own, &bag, &names()).unwrap();
    assert_eq!((exported.frames, exported.gaps), (400, 0));
    assert_eq!((exported.last_s, exported.ending), (3.99, Ending::Whole));
    (own, bag)
}

#[test]
fn an_exported_log_comes_back_through_an_import_with_the_same_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let (own, bag) = exported(folder.path());
    let expected = read_presses(&own, &ReadOptions::default()).unwrap().recording;
    let expected = &expected.presses[0];
    let of_barometers = BENCH.replace("/touch:data.1", "/baro/S1:fluid_pressure");
    for description in [BENCH, &of_barometers] {
        let (recording, summary) = import(&bag, description).unwrap();
        assert_eq!(recording.presses.len(), 1, "{}", summary.files[0]);
        let press = &recording.presses[0];
        assert_eq!((&*press.name, &*press.mounting), ("p#1", "p.mcap"));
        let mut n_compared = 0;
        for (frame, time_s) in press.time_s.iter().enumerate() {
            let is_same = |other: &f64| (other - time_s).abs() < 1e-6;
            let Some(other) = expected.time_s.iter().position(is_same) else {
                continue;
            };
            n_compared += 1;
            let [pose, expected_pose] =
                [(press, frame), (expected, other)].map(|(p, f)| p.gel_from_indenter[f]);
            assert!(pose.position_mm.distance(expected_pose.position_mm) < 1e-9);
            assert!((pose.rotation * DVec3::X).distance(expected_pose.rotation * DVec3::X) < 1e-9);
            let [force_n, expected_n] =
                [(press, frame), (expected, other)].map(|(p, f)| p.force_n.as_ref().unwrap()[f]);
            assert!((force_n - expected_n).abs() < 1e-12);
            assert_eq!(press.valid[frame], expected.valid[other]);
            for taxel in 0..2 {
                // Counts of 1/32 Pa, which fit into 32 bits.
                let pa = expected.taxels_raw[other][taxel] / 32.0;
                if press.valid[frame][taxel] {
                    assert_eq!(press.taxels_raw[frame][taxel], pa);
                }
            }
        }
        assert!(n_compared > 300, "{n_compared}");
        // Every seventh frame lacks the pressure of the first taxel.
        assert_eq!(summary.files[0].missing_readings, 58);
    }
}

#[test]
fn topics_have_the_names_and_types_that_were_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let (_, bag) = exported(folder.path());
    let bytes = std::fs::read(&bag).unwrap();
    let mut found = BTreeMap::new();
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        let schema = message.channel.schema.as_ref().unwrap();
        assert_eq!(
            (&*schema.encoding, &*message.channel.message_encoding),
            ("ros2msg", "cdr")
        );
        *found
            .entry((message.channel.topic.clone(), schema.name.clone()))
            .or_insert(0) += 1;
    }
    let expected = [
        ("/arm/pose", "geometry_msgs/msg/PoseStamped", 400),
        ("/baro/S0", "sensor_msgs/msg/FluidPressure", 342),
        ("/baro/S1", "sensor_msgs/msg/FluidPressure", 400),
        ("/events", "std_msgs/msg/String", 2),
        ("/tactile/S0/temperature", "sensor_msgs/msg/Temperature", 400),
        ("/tactile/S1/temperature", "sensor_msgs/msg/Temperature", 400),
        ("/touch", "std_msgs/msg/Float32MultiArray", 400),
        ("/wrench", "geometry_msgs/msg/WrenchStamped", 400),
    ];
    let expected = expected.map(|(topic, kind, count)| ((topic.to_owned(), kind.to_owned()), count));
    assert_eq!(found, BTreeMap::from(expected));
    let problem = LogReader::open(&bag).unwrap_err().to_string();
    has(&problem, &["is not a readable log"]);
}

#[test]
fn numbers_keep_where_they_come_from() {
    let folder = tempfile::tempdir().unwrap();
    let (own, bag) = exported(folder.path());
    let real = BENCH.replace("\"emulated\"", "\"real\"");
    let of_log = real
        .replace("/touch:data.", "/tactile/frame:pressure_pa.")
        .replace("/arm/", "/robot/");
    for (path, description) in [(&bag, &real), (&own, &of_log)] {
        let problem = import(path, description).unwrap_err().to_string();
        has(
            &problem,
            &[
                "the file says that its numbers are emulated",
                "provenance = \"real\"",
            ],
        );
    }
    // A log is a bag, too.
    let (recording, _) = import(&own, &of_log.replace("\"real\"", "\"emulated\"")).unwrap();
    assert_eq!(recording.presses.len(), 1);
    let said = read_bag(&bag, &[]).unwrap().unwrap().provenance;
    assert_eq!(said.map(|said| said.to_string()).as_deref(), Some("emulated"));
}

#[test]
fn nothing_is_replaced_and_no_two_topics_are_one() {
    let folder = tempfile::tempdir().unwrap();
    let (own, bag) = exported(folder.path());
    let problem = export_bag(&own, &bag, &names()).unwrap_err().to_string();
    has(&problem, &["p.mcap", "exists already"]);
    let mut twice = names();
    twice.rename("wrench", "/touch").unwrap();
    let other = folder.path().join("other.mcap");
    let problem = export_bag(&own, &other, &twice).unwrap_err().to_string();
    has(&problem, &["two are called `/touch`"]);
    assert!(!other.exists());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn a_log_that_was_cut_is_exported_up_to_there() {
    let folder = tempfile::tempdir().unwrap();
    let (own, bag) = exported(folder.path());
    let whole = std::fs::read(&own).unwrap();
    std::fs::write(&own, &whole[..whole.len() / 2]).unwrap();
    std::fs::remove_file(&bag).unwrap();
    let exported = export_bag(&own, &bag, &TopicNames::default()).unwrap();
    assert_eq!(exported.ending, Ending::Cut);
    let found = read_bag(&bag, &[]).unwrap().unwrap();
    assert!(found.notes.is_empty(), "{:?}", found.notes);
    let tactile = found
        .topics
        .iter()
        .find(|topic| topic.name == "/tactile")
        .unwrap();
    assert!(tactile.messages == exported.frames && (50..350).contains(&exported.frames));
}
