//! Bags of other programs, read through an import description.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

mod bag;

use bag::{ARRAY, Cdr, InFolder, MS, Made, START_NS, has, stamped};
use glam::{DQuat, DVec3};
use mcap::{Compression, WriteOptions};
use proptest::prelude::*;
use twintac_log::read_bag;
use twintac_recording::{Recording, guess_bag_import};

/// The meaning of the bags: poses of the arm in m, its wrench in N, two taxels in Pa.
const BENCH: &str = r#"
sensor = "pair"
provenance = "real"
indenter = "tip"
gel_top_mm = 8.5
x = { column = "/arm/pose:position.x", unit = "m", offset = -300.0 }
z = { column = "/arm/pose:pose.position.z", unit = "m" }
contact = { z_mm = 10.0 }
force = { column = "/ft:force.z", unit = "N", scale = -1.0 }
readings = { unit = "Pa" }
taxels = [{ name = "t0", column = "/tactile:data.0" }, { name = "t1", column = "/tactile:data.1" }]
presses = { split = "return-to-rest", rest_mm = 14.0, tolerance_mm = 0.05 }
zero = { above_contact_mm = 1.0, window_s = 0.5 }
"#;

/// Depth of the tip over time: twice to 2 mm at 4 mm/s, with rests at 4 mm above the gel between
/// them.
fn depth_mm(after_ns: u64) -> f64 {
    let s = (after_ns as f64 * 1e-9) % 4.0;
    (4.0 * (s - 0.5)).min(4.0 * (3.5 - s)).clamp(0.0, 6.0) - 4.0
}

fn pose(after_ns: u64) -> Cdr {
    let numbers = [0.3, 0.0, (10.0 - depth_mm(after_ns)) / 1000.0, 0.0, 0.0, 0.0, 1.0];
    Cdr::default().header(START_NS + after_ns).f64s(&numbers)
}

/// 3 N per mm.
fn wrench(after_ns: u64) -> Cdr {
    let force_n = 3.0 * depth_mm(after_ns).max(0.0);
    Cdr::default()
        .header(START_NS + after_ns)
        .f64s(&[0.1, 0.2, -force_n, 0.0, 0.0, 0.0])
}

/// 5 kPa per mm on the first taxel, a tenth of it on the second.
fn tactile(after_ns: u64) -> Cdr {
    let pa = 5000.0 * depth_mm(after_ns).max(0.0);
    let numbers = [101_325.0 + pa, 100_000.0 + 0.1 * pa].map(|pa| pa as f32);
    Cdr::default().floats(&numbers)
}

const SECONDS: u64 = 8;

/// Times at a rate, ns after the start.
fn times(hz: u64, first_ns: u64) -> impl Iterator<Item = u64> {
    (0..SECONDS * hz).map(move |step| step * 1_000_000_000 / hz + first_ns)
}

/// A bag of two presses: taxels at 100 Hz, poses at 125 Hz, wrenches at 500 Hz, and a topic of
/// another kind.
fn bench(compression: Option<Compression>) -> Made {
    bench_with(compression, tactile, wrench)
}

fn bench_with(
    compression: Option<Compression>,
    tactile: impl Fn(u64) -> Cdr,
    wrench: impl Fn(u64) -> Cdr,
) -> Made {
    let mut made = Made::new(compression);
    made.topic("/tactile", "std_msgs/msg/Float32MultiArray", ARRAY);
    made.topic(
        "/arm/pose",
        "geometry_msgs/msg/PoseStamped",
        &stamped("geometry_msgs/Pose pose\n"),
    );
    made.topic(
        "/ft",
        "geometry_msgs/msg/WrenchStamped",
        &stamped("geometry_msgs/Wrench wrench\n"),
    );
    made.topic_in("/camera", "foxglove.Image", "{}", "jsonschema", "json");
    let mut messages: Vec<(u64, &str, Cdr)> = Vec::new();
    messages.extend(times(100, 5 * MS).map(|at| (at, "/tactile", tactile(at))));
    messages.extend(times(125, 0).map(|at| (at, "/arm/pose", pose(at))));
    messages.extend(times(500, 0).map(|at| (at, "/ft", wrench(at))));
    messages.extend([1, 2, 3].map(|at| (at, "/camera", Cdr::default().u32(0))));
    messages.sort_by_key(|(at, ..)| *at);
    for (at, topic, cdr) in messages {
        made.add(topic, at, cdr);
    }
    made
}

fn near(one: f64, other: f64, within: f64) {
    assert!((one - other).abs() <= within, "{one} is not {other}");
}

/// Checks that every frame has the values of the press at its time.
fn is_as_pressed(recording: &Recording) {
    assert_eq!(recording.taxels, ["t0", "t1"]);
    assert_eq!(recording.presses.len(), 2);
    for press in &recording.presses {
        let force_n = press.force_n.as_ref().unwrap();
        let mut deepest_mm = 0.0_f64;
        for (frame, pose) in press.gel_from_indenter.iter().enumerate() {
            // Times count from the first tactile message.
            let after_ns = (1e9 * press.time_s[frame]).round() as u64 + 5 * MS;
            let depth_mm = depth_mm(after_ns);
            // Between two poses the motion turns.
            near(8.5 - pose.position_mm.z, depth_mm, 0.02);
            near(pose.position_mm.x, 0.0, 1e-9);
            near(force_n[frame], 3.0 * depth_mm.max(0.0), 0.01);
            let kpa = &press.taxels_kpa[frame];
            near(kpa[0], 5.0 * depth_mm.max(0.0), 1e-4);
            near(kpa[1], 0.5 * depth_mm.max(0.0), 1e-4);
            assert_eq!(press.valid[frame], [true, true]);
            deepest_mm = deepest_mm.max(8.5 - pose.position_mm.z);
        }
        near(deepest_mm, 2.0, 0.02);
    }
}

#[test]
fn presses_come_back_from_topics_of_three_rates() {
    let file = bench(None).file();
    let (recording, summary) = file.import(BENCH).unwrap();
    is_as_pressed(&recording);
    assert_eq!(recording.presses[0].name, "bag#1");
    assert_eq!(recording.presses[0].mounting, "bag.mcap");
    assert_eq!(recording.provenance.to_string(), "real");
    let found = &summary.files[0];
    assert_eq!((found.rows_read, found.presses), (800, 2));
    assert_eq!(found.unread_columns, ["/camera"]);
    // The last pose comes 8 ms before the end, the last frame 5 ms before it.
    assert_eq!(found.warnings.len(), 1, "{found}");
    has(
        &found.warnings[0],
        &[
            "1 messages of /tactile",
            "/arm/pose",
            "at most 20 ms apart, and are left out",
        ],
    );
}

#[test]
fn compressed_chunks_are_read() {
    let plain = bench(None).file();
    let expected = plain.import(BENCH).unwrap();
    for compression in [Compression::Zstd, Compression::Lz4] {
        let file = bench(Some(compression)).file();
        let bytes = |file: &InFolder| std::fs::metadata(file.path()).unwrap().len();
        assert!(bytes(&file) < bytes(&plain));
        assert_eq!(file.import(BENCH).unwrap(), expected);
    }
}

/// The middle of a chunk of a file.
fn middle_of_chunk(bytes: &[u8], number: usize) -> usize {
    const MAGIC_BYTES: usize = 8;
    const FRAMING_BYTES: usize = 9;
    const CHUNK: u8 = 6;
    let (mut at, mut chunks) = (MAGIC_BYTES, 0);
    loop {
        let length = u64::from_le_bytes(bytes[at + 1..at + FRAMING_BYTES].try_into().unwrap()) as usize;
        chunks += usize::from(bytes[at] == CHUNK);
        if chunks == number {
            return at + FRAMING_BYTES + length / 2;
        }
        at += FRAMING_BYTES + length;
    }
}

#[test]
fn a_bag_that_was_cut_or_damaged_is_read_as_far_as_it_is_whole() {
    for compression in [None, Some(Compression::Zstd), Some(Compression::Lz4)] {
        let whole = bench(compression).bytes();
        let file = InFolder::new("cut.mcap", &whole[..whole.len() * 45 / 100]);
        let (recording, summary) = file.import(BENCH).unwrap();
        assert_eq!(recording.presses.len(), 1);
        let found = &summary.files[0];
        has(
            &found.to_string(),
            &["cut.mcap: 1 presses", "is truncated; it is read up to that point"],
        );
        let mut damaged = whole.clone();
        damaged[middle_of_chunk(&whole, 20)] ^= 0x55;
        let file = InFolder::new("damaged.mcap", &damaged);
        let (recording, summary) = file.import(BENCH).unwrap();
        assert_eq!(recording.presses.len(), 2);
        has(&summary.files[0].to_string(), &["damaged in 1 places"]);
    }
}

#[test]
fn a_topic_that_is_not_there_lists_those_that_are() {
    let file = bench(None).file();
    let problem = file.problem(&BENCH.replace("/tactile:", "/touch:"));
    has(
        &problem,
        &[
            "bag.mcap: column `/touch:data.0` is of an unknown topic",
            "/tactile (std_msgs/msg/Float32MultiArray, 800 messages)",
            "/arm/pose (geometry_msgs/msg/PoseStamped, 1000 messages)",
            "/camera (foxglove.Image, 3 messages, cannot be read: its messages are `json`",
        ],
    );
    let problem = file.problem(&BENCH.replace("\"/ft:force.z\"", "\"fz\""));
    has(
        &problem,
        &["`fz` is not a column of a bag, which is `/topic:field`", "/ft ("],
    );
    let problem = file.problem(&BENCH.replace("/ft:force.z", "/camera:width"));
    has(
        &problem,
        &["`/camera:width` is of a topic that cannot be read", "json"],
    );
}

#[test]
fn a_field_that_is_not_there_lists_those_that_are() {
    let file = bench(None).file();
    let problem = file.problem(&BENCH.replace("data.1", "data.2"));
    has(
        &problem,
        &[
            "`/tactile:data.2` is in none of the 800 messages of type std_msgs/msg/Float32MultiArray",
            "layout.dim.0.size",
            "data.0, data.1",
        ],
    );
    // `x` is the end of two names.
    for field in ["fz", "x", "force"] {
        let problem = file.problem(&BENCH.replace("force.z", field));
        has(
            &problem,
            &[
                &format!("`/ft:{field}`"),
                "wrench.force.x, wrench.force.y, wrench.force.z",
            ],
        );
    }
    let problem = file.problem(&BENCH.replace("gel_top", "time = { column = \"/tactile:stamp\" }\ngel_top"));
    has(&problem, &["`/tactile:stamp`", "have no header; use `log_time`"]);
}

#[test]
fn recordings_in_other_containers_say_what_to_do() {
    for (name, bytes, remedy) in [
        ("bag.db3", &b"SQLite format 3\0...."[..], "ros2 bag convert"),
        ("bag.mcap", b"SQLite format 3\0....", "ros2 bag convert"),
        ("old.bag", b"#ROSBAG V2.0\n", "rosbags-convert"),
        ("bag.mcap.zstd", b"\x28\xB5\x2F\xFD....", "zstd -d"),
        ("run.csv", b"time,z\n1,2\n", "name the column of the time"),
    ] {
        let file = InFolder::new(name, bytes);
        has(&file.problem(BENCH), &[name, remedy]);
    }
    let folder = InFolder::new("metadata.yaml", b"rosbag2_bagfile_information:\n");
    let problem = bag::import(folder.path().parent().unwrap(), BENCH).unwrap_err();
    has(&problem.to_string(), &["folder of a bag", "*.mcap"]);
    let empty = Made::new(None).file();
    has(&empty.problem(BENCH), &["the bag has no topics"]);
}

#[test]
fn times_that_fall_are_refused_with_the_message_and_what_to_do() {
    // The clock of the wrench is set back by 2 s for one message.
    let set_back = |after_ns: u64| match after_ns {
        4_000_000_000 => Cdr::default()
            .header(START_NS + after_ns - 2_000_000_000)
            .f64s(&[0.0; 6]),
        _ => wrench(after_ns),
    };
    let file = bench_with(None, tactile, set_back).file();
    let problem = file.problem(BENCH);
    has(
        &problem,
        &[
            "bag.mcap:2001: column `/ft:stamp`",
            "expected times not to fall",
            "/tactile:log_time",
        ],
    );
    // The recorder's own clock is not set back.
    let by_log = BENCH.replace("gel_top", "time = { column = \"/tactile:log_time\" }\ngel_top");
    assert_eq!(file.import(&by_log).unwrap().0.presses.len(), 2);

    let mut made = bench(None);
    made.add("/tactile", 7_000 * MS, tactile(7_000 * MS));
    let problem = made.file().problem(BENCH);
    has(
        &problem,
        &[
            "bag.mcap:801: column `/tactile:log_time` is 6.9",
            "expected times to increase",
        ],
    );
}

#[test]
fn clocks_that_differ_are_an_error_unless_the_recorder_is_asked() {
    // Stamps count from power-up of the sensor.
    let uptime = |after_ns: u64| {
        let force_n = 3.0 * depth_mm(after_ns).max(0.0);
        Cdr::default()
            .header(after_ns + 1)
            .f64s(&[0.0, 0.0, -force_n, 0.0, 0.0, 0.0])
    };
    let file = bench_with(None, tactile, uptime).file();
    has(
        &file.problem(BENCH),
        &[
            "no message of /tactile lies between two of /ft",
            "/tactile:log_time",
        ],
    );
    let by_log = BENCH.replace("gel_top", "time = { column = \"/tactile:log_time\" }\ngel_top");
    let (recording, _) = file.import(&by_log).unwrap();
    near(recording.presses[0].time_s[0], START_NS as f64 * 1e-9, 1.0);
    // Drivers that leave their headers empty give no time.
    let unstamped = |after_ns: u64| {
        let force_n = 3.0 * depth_mm(after_ns).max(0.0);
        Cdr::default()
            .header(0)
            .f64s(&[0.0, 0.0, -force_n, 0.0, 0.0, 0.0])
    };
    let (recording, _) = bench_with(None, tactile, unstamped).file().import(BENCH).unwrap();
    is_as_pressed(&recording);
}

#[test]
fn what_is_missing_in_a_message_is_a_missing_reading() {
    let with_gaps = |after_ns: u64| match after_ns {
        // Within the first press.
        2_005_000_000 => Cdr::default().floats(&[f32::NAN, 100_900.0]),
        2_015_000_000 => Cdr::default().floats(&[110_000.0]),
        _ => tactile(after_ns),
    };
    let file = bench_with(None, with_gaps, wrench).file();
    let (recording, summary) = file.import(BENCH).unwrap();
    assert_eq!(summary.files[0].missing_readings, 2);
    let press = &recording.presses[0];
    let frame = press
        .time_s
        .iter()
        .position(|time_s| (time_s - 2.0).abs() < 1e-6)
        .unwrap();
    assert!(press.taxels_raw[frame][0].is_nan() && press.taxels_raw[frame + 1][1].is_nan());
    assert_eq!(press.valid[frame..frame + 2], [[false, true], [true, false]]);
    // A column that is no reading of a taxel must have a number in every row.
    let no_force = |after_ns: u64| match after_ns {
        2_004_000_000 => Cdr::default().header(START_NS + after_ns).f64s(&[f64::NAN; 6]),
        _ => wrench(after_ns),
    };
    let file = bench_with(None, tactile, no_force).file();
    let problem = file.problem(BENCH);
    has(
        &problem,
        &[
            "bag.mcap:201: column `/ft:force.z` is missing",
            "drop_incomplete_rows",
        ],
    );
    let dropped = BENCH.replace("gel_top", "drop_incomplete_rows = true\ngel_top");
    let (_, summary) = file.import(&dropped).unwrap();
    assert_eq!(summary.files[0].rows_incomplete, 1);
}

#[test]
fn messages_that_are_not_of_their_type_are_left_out_and_said() {
    let broken = |after_ns: u64| match after_ns {
        2_005_000_000 => Cdr::default().u32(1_000_000),
        _ => tactile(after_ns),
    };
    let (recording, summary) = bench_with(None, broken, wrench).file().import(BENCH).unwrap();
    assert_eq!(recording.presses.len(), 2);
    has(
        &summary.files[0].to_string(),
        &["1 of 800 messages of /tactile do not match their type"],
    );
}

/// Each barometer has its own topic and its own times: readings are interpolated to the times of
/// the first one.
#[test]
fn each_taxel_may_have_a_topic_of_its_own() {
    let mut made = Made::new(Some(Compression::Zstd));
    let fluid = stamped("float64 fluid_pressure\nfloat64 variance\n");
    made.topic("/baro0", "sensor_msgs/msg/FluidPressure", &fluid);
    made.topic("/baro1", "sensor_msgs/msg/FluidPressure", &fluid);
    made.topic(
        "/baro1/t",
        "sensor_msgs/msg/Temperature",
        &stamped("float64 temperature\nfloat64 variance\n"),
    );
    made.topic(
        "/arm/pose",
        "geometry_msgs/msg/PoseStamped",
        &stamped("geometry_msgs/Pose pose\n"),
    );
    let scalar = |at: u64, number: f64| Cdr::default().header(START_NS + at).f64s(&[number, 0.0]);
    for at in times(100, 0) {
        made.add("/arm/pose", at, pose(at));
        made.add(
            "/baro0",
            at,
            scalar(at, 101_325.0 + 5000.0 * depth_mm(at).max(0.0)),
        );
        let later = at + 3 * MS;
        // One second is lost, within a press.
        if !(1_500 * MS..2_500 * MS).contains(&at) {
            made.add(
                "/baro1",
                later,
                scalar(later, 100_000.0 + 500.0 * depth_mm(later).max(0.0)),
            );
            made.add("/baro1/t", later, scalar(later, 25.0 + 0.5));
        }
    }
    let description = BENCH
        .replace("force =", "# force =")
        .replace("/tactile:data.0", "/baro0:fluid_pressure")
        .replace(
            "\"/tactile:data.1\"",
            "\"/baro1:fluid_pressure\", temperature = \"/baro1/t:temperature\"",
        );
    let (recording, summary) = made.file().import(&description).unwrap();
    let found = &summary.files[0];
    assert_eq!(found.rows_read, 800);
    // Missing before the first message of the topic, and during the loss.
    assert_eq!(found.missing_readings, 1 + 100 + 1, "{found}");
    has(
        &found.to_string(),
        &["of /baro1 that are at most 20 ms apart, and have no reading of it"],
    );
    for press in &recording.presses {
        for (frame, pose) in press.gel_from_indenter.iter().enumerate() {
            let depth_mm = 8.5 - pose.position_mm.z;
            let kpa = &press.taxels_kpa[frame];
            near(kpa[0], 5.0 * depth_mm.max(0.0), 1e-6);
            if press.valid[frame][1] {
                near(kpa[1], 0.5 * depth_mm.max(0.0), 0.011); // the motion turns
                near(press.temperature_c.as_ref().unwrap()[frame][1], 25.5, 1e-12);
            }
        }
    }
    assert!(recording.presses[0].valid.iter().any(|valid| !valid[1]));
    assert!(recording.presses[1].valid.iter().all(|valid| valid[1]));
}

// long: a message of each type, and what is read of it.
// long: a row for each type
#[test]
fn every_usual_type_is_read() {
    let array = |element: &str| ARRAY.replace("float32", element);
    let (vector, point) = ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]);
    let turn = [0.0, 0.0, 0.6, 0.8];
    let header = || Cdr::default().header(START_NS);
    let plain = |fields: &str| stamped(fields).replace("std_msgs/Header header\n", "");
    let cases = [
        (
            "std_msgs/msg/Float32MultiArray",
            array("float32"),
            Cdr::default().floats(&[0.5, 1.5]),
            "data.1",
            1.5,
        ),
        (
            "std_msgs/msg/Float64MultiArray",
            array("float64"),
            Cdr::default().layout(1).u32(1).f64s(&[2.5]),
            "data.0",
            2.5,
        ),
        (
            "std_msgs/msg/Int32MultiArray",
            array("int32"),
            Cdr::default().layout(2).u32(2).i32(7).i32(-8),
            "data.1",
            -8.0,
        ),
        (
            "std_msgs/msg/Float64",
            "float64 data\n".to_owned(),
            Cdr::default().f64s(&[9.0]),
            "data",
            9.0,
        ),
        (
            "sensor_msgs/msg/FluidPressure",
            stamped("float64 fluid_pressure\nfloat64 variance\n"),
            header().f64s(&[101.0, 0.0]),
            "fluid_pressure",
            101.0,
        ),
        (
            "sensor_msgs/msg/Temperature",
            stamped("float64 temperature\nfloat64 variance\n"),
            header().f64s(&[25.0, 0.0]),
            "temperature",
            25.0,
        ),
        (
            "geometry_msgs/msg/WrenchStamped",
            stamped("geometry_msgs/Wrench wrench\n"),
            header().f64s(&vector).f64s(&point),
            "torque.y",
            5.0,
        ),
        (
            "geometry_msgs/msg/Wrench",
            plain("Vector3 force\nVector3 torque\n"),
            Cdr::default().f64s(&vector).f64s(&point),
            "force.z",
            3.0,
        ),
        (
            "geometry_msgs/msg/PoseStamped",
            stamped("geometry_msgs/Pose pose\n"),
            header().f64s(&point).f64s(&turn),
            "orientation.w",
            0.8,
        ),
        (
            "geometry_msgs/msg/Pose",
            plain("Point position\nQuaternion orientation\n"),
            Cdr::default().f64s(&point).f64s(&turn),
            "position.x",
            4.0,
        ),
        (
            "geometry_msgs/msg/PointStamped",
            stamped("geometry_msgs/Point point\n"),
            header().f64s(&point),
            "point.z",
            6.0,
        ),
        (
            "geometry_msgs/msg/TransformStamped",
            stamped("string child_frame_id\ngeometry_msgs/Transform transform\n"),
            header().text("tip").f64s(&vector).f64s(&turn),
            "translation.y",
            2.0,
        ),
        (
            "lab_msgs/msg/Taxels",
            stamped("Taxel[] taxels\n===\nMSG: lab_msgs/Taxel\nuint8 id\nfloat32 kpa\n"),
            header().u32(2).u32(1).f32(11.0).u32(2).f32(12.0),
            "taxels.1.kpa",
            12.0,
        ),
    ];
    for (kind, definition, message, field, number) in cases {
        let mut made = Made::new(None);
        made.topic("/one", kind, &definition);
        made.add("/one", 7, message);
        let file = made.file();
        let bag = read_bag(&file.path(), &[&format!("/one:{field}")])
            .unwrap()
            .unwrap();
        let topic = &bag.topics[0];
        assert_eq!((&*topic.kind, topic.messages), (kind, 1));
        assert_eq!(
            topic.columns.get(field),
            Some(&vec![number]),
            "{kind}: {:?}",
            topic.fields
        );
        let has_header = definition.contains("Header header");
        let stamps = [START_NS as i64];
        assert_eq!(topic.stamp_ns, &stamps[..usize::from(has_header)], "{kind}");
        assert_eq!(topic.log_ns, [START_NS as i64 + 7]);
    }
}

#[test]
fn a_turning_quaternion_may_change_its_sign() {
    let mut made = Made::new(None);
    made.topic("/tactile", "std_msgs/msg/Float32MultiArray", ARRAY);
    made.topic(
        "/arm/pose",
        "geometry_msgs/msg/PoseStamped",
        &stamped("geometry_msgs/Pose pose\n"),
    );
    for (step, at) in times(100, 0).enumerate() {
        let (half_rad, sign) = (0.005 * step as f64, if step % 2 == 0 { 1.0 } else { -1.0 });
        let numbers = [
            0.3,
            0.0,
            (10.0 - depth_mm(at)) / 1000.0,
            0.0,
            0.0,
            sign * half_rad.sin(),
            sign * half_rad.cos(),
        ];
        made.add(
            "/arm/pose",
            at,
            Cdr::default().header(START_NS + at).f64s(&numbers),
        );
        made.add("/tactile", at + 5 * MS, tactile(at + 5 * MS));
    }
    let names = ["x", "y", "z", "w"]
        .map(|axis| format!("\"/arm/pose:orientation.{axis}\""))
        .join(", ");
    let description = BENCH.replace("force =", "# force =").replace(
        "gel_top",
        &format!("rotation = {{ columns = [{names}] }}\ngel_top"),
    );
    let (recording, _) = made.file().import(&description).unwrap();
    for press in &recording.presses {
        for (time_s, pose) in press.time_s.iter().zip(&press.gel_from_indenter) {
            // Rows lie half-way between two poses.
            let expected_rad = 0.01 * (100.0 * time_s + 0.5);
            let expected = DQuat::from_rotation_z(expected_rad) * DVec3::X;
            assert!(
                expected.distance(pose.rotation * DVec3::X) < 1e-6,
                "at {time_s} s"
            );
        }
    }
}

#[test]
fn a_label_holds_until_the_next_one() {
    let mut made = bench(None);
    made.topic("/trial", "std_msgs/msg/Int32", "int32 data\n");
    for (at, trial) in [(0, 4), (4_000 * MS, 5)] {
        made.add("/trial", at, Cdr::default().i32(trial));
    }
    let split = BENCH.replace(
        "split = \"return-to-rest\", rest_mm = 14.0, tolerance_mm = 0.05",
        "split = \"column\", column = \"/trial:data\"",
    );
    let (recording, _) = made.file().import(&split).unwrap();
    let frames = recording.presses.iter().map(|press| press.time_s.len());
    assert_eq!(frames.collect::<Vec<_>>(), [400, 399]);
}

#[test]
fn a_description_is_guessed_and_can_be_read() {
    let file = bench(Some(Compression::Lz4)).file();
    let guess = guess_bag_import(&file.path(), read_bag).unwrap().unwrap();
    has(
        &guess,
        &[
            "# How to read bag.mcap: guessed from the types of its topics",
            "time = { column = \"/tactile:log_time\", unit = \"s\" }    # 100.0 rows a second",
            "z = { column = \"/arm/pose:position.z\", unit = \"m\" }",
            "force = { column = \"/ft:force.z\", unit = \"N\" }",
            "readings = { unit = \"Pa\" }",
            "{ name = \"t0\", column = \"/tactile:data.0\" },",
            "{ name = \"t1\", column = \"/tactile:data.1\" },",
        ],
    );
    let (recording, _) = file.import(&guess).unwrap();
    assert_eq!(recording.presses.len(), 2);
    let force_n = recording.presses[0].force_n.as_ref().unwrap();
    near(force_n.iter().copied().fold(0.0, f64::min), -6.0, 0.07);

    let mut made = Made::new(None);
    made.topic(
        "/ft",
        "geometry_msgs/msg/WrenchStamped",
        &stamped("geometry_msgs/Wrench wrench\n"),
    );
    made.add("/ft", 0, wrench(0));
    let problem = guess_bag_import(&made.file().path(), read_bag)
        .unwrap()
        .unwrap_err();
    has(
        &problem.to_string(),
        &["no topic looks like readings of taxels", "/ft ("],
    );
    let text = InFolder::new("run.csv", b"t,p\n1,2\n");
    assert!(guess_bag_import(&text.path(), read_bag).is_none());
}

#[test]
fn a_bag_may_stand_beside_a_csv_file() {
    let file = bench(None).file();
    let rows = times(100, 5 * MS).map(|at| {
        let time_s = (START_NS + at) as f64 * 1e-9;
        format!(
            "{time_s:.6},{},100000\n",
            101_325.0 + 5000.0 * depth_mm(at).max(0.0)
        )
    });
    let csv = file.path().with_extension("csv");
    std::fs::write(&csv, format!("t,p0,p1\n{}", rows.collect::<String>())).unwrap();
    let beside = BENCH
        .replace("/tactile:data.0", "p0")
        .replace("/tactile:data.1", "p1")
        .replace("force =", "# force =")
        .replace("x = ", "# x = ")
        .replace("gel_top", "time = { column = \"t\" }\ngel_top")
        + r#"
[[join]]
file = "{stem}.mcap"
columns = ["/arm/pose:pose.position.z"]
time = { column = "/arm/pose:stamp" }
"#;
    let (recording, _) = bag::import(&csv, &beside).unwrap();
    assert_eq!(recording.presses.len(), 2);
    for press in &recording.presses {
        for (pose, kpa) in press.gel_from_indenter.iter().zip(&press.taxels_kpa) {
            // The nearest pose is at most 4 ms away, which is 0.016 mm.
            near(kpa[0], 5.0 * (8.5 - pose.position_mm.z).max(0.0), 0.081);
        }
    }
}

/// A small bag whose checksums are switched off, so that damage reaches as far as possible.
fn unchecked(compression: Option<Compression>) -> Vec<u8> {
    let options = WriteOptions::new()
        .compression(compression)
        .calculate_chunk_crcs(false)
        .calculate_data_section_crc(false)
        .calculate_summary_section_crc(false);
    let mut made = Made::with(options);
    made.topic("/tactile", "std_msgs/msg/Float32MultiArray", ARRAY);
    made.topic(
        "/arm/pose",
        "geometry_msgs/msg/PoseStamped",
        &stamped("geometry_msgs/Pose pose\n"),
    );
    for at in times(10, 0) {
        made.add("/tactile", at, tactile(at));
        made.add("/arm/pose", at, pose(at));
    }
    made.bytes()
}

proptest! {
    #[test]
    fn whatever_has_changed_a_bag_is_read_or_refused(
        how in prop::sample::select(vec![None, Some(Compression::Zstd), Some(Compression::Lz4)]),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        end in any::<prop::sample::Index>(),
        is_cut in any::<bool>(),
    ) {
        let mut bytes = unchecked(how);
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        if is_cut {
            bytes.truncate(end.index(bytes.len()));
        }
        let file = InFolder::new("changed.mcap", &bytes);
        let columns = ["/tactile:data.1", "/arm/pose:position.z", "/arm/pose:stamp"];
        if let Some(Ok(bag)) = read_bag(&file.path(), &columns) {
            for topic in &bag.topics {
                let n_rows = topic.numbers.len();
                prop_assert!(n_rows as u64 <= topic.messages);
                prop_assert_eq!(topic.log_ns.len(), n_rows);
                prop_assert!(topic.stamp_ns.is_empty() || topic.stamp_ns.len() == n_rows);
                prop_assert!(topic.columns.values().all(|column| column.len() == n_rows));
            }
        }
        // Any result is accepted, but the call must end.
        let _ = file.import(&BENCH.replace("force =", "# force ="));
    }
}
