//! A connected sensor: read over a line, byte by byte, and by frames that the program hands over.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use serde_json::{Value, json};
use twintac_engine::{Array, Engine, Offer};

const PHYSTAC: &str = include_str!("../../../../sensors/phystac.toml");
const LINE: &str = "form = \"text\"\nfields = [\"sequence\", \"time\", \"pressure * 8\", \"temperature * 8\"]\ntime.unit = \"us\"\n\
                    pressure.unit = \"Pa\"\nserial.baud = 115200\n";

fn ask(engine: &mut Engine, request: &Value, bytes: &[u8]) -> Value {
    serde_json::from_str(&engine.answer(&request.to_string(), bytes)).unwrap()
}

fn opened() -> Engine {
    let mut engine = Engine::default();
    ask(
        &mut engine,
        &json!({"do": "open", "file": "phystac.toml", "text": PHYSTAC}),
        &[],
    );
    engine
}

/// Lets the surrounding program provide a sensor.
fn offer(engine: &mut Engine, source: &str, provenance: &str) {
    let source = Some(source.to_owned());
    let sensor = None;
    engine.set_offer(Offer { sensor, source }, provenance);
}

fn hear(engine: &mut Engine, bytes: &[u8]) -> Value {
    ask(engine, &json!({"do": "hear"}), bytes)
}

/// A frame whose pressures increase from taxel to taxel, shifted by `more_kpa`.
fn frame(more_kpa: f64) -> Vec<Option<f64>> {
    (0..8)
        .map(|taxel| Some(100.0 + f64::from(taxel) + more_kpa))
        .collect()
}

#[test]
fn readings_are_above_the_zero() {
    let mut engine = opened();
    offer(&mut engine, "the bench", "emulated");
    let offered = ask(&mut engine, &json!({"do": "offer"}), &[]);
    assert_eq!(offered, json!({"sensor": null, "source": "the bench"}));
    assert_eq!(
        hear(&mut engine, &[])["pressure_kpa"],
        json!([]),
        "nothing came yet"
    );
    for index in 0..32 {
        assert_eq!(hear(&mut engine, &[])["is_zeroing"], true, "{index}");
        engine.take_frame(frame(if index % 2 == 0 { 0.1 } else { -0.1 }));
    }
    let mut touched = frame(2.5);
    touched[3] = None;
    engine.take_frame(touched);
    engine.set_remarks(vec!["missing frames: 2".to_owned()]);
    let heard = hear(&mut engine, &[]);
    assert_eq!(
        (&heard["is_zeroing"], &heard["n_frames"], &heard["provenance"]),
        (&json!(false), &json!(33), &json!("emulated"))
    );
    assert_eq!(heard["remarks"], json!(["missing frames: 2"]));
    for (taxel, kpa) in heard["pressure_kpa"].as_array().unwrap().iter().enumerate() {
        match kpa.as_f64() {
            Some(kpa) => assert!((kpa - 2.5).abs() < 1e-9, "{kpa}"),
            None => assert_eq!(taxel, 3),
        }
    }
    assert!(
        engine.arrays().numbers(Array::DeskMapKpa).is_empty(),
        "a taxel reads nothing"
    );
    engine.take_frame(frame(2.5));
    hear(&mut engine, &[]);
    let map = engine.arrays().numbers(Array::DeskMapKpa);
    let highest_kpa = map.iter().copied().fold(0.0, f32::max);
    assert!(
        map.len() == 64 * 64 && (highest_kpa - 2.5).abs() < 0.5,
        "{highest_kpa}"
    );

    ask(&mut engine, &json!({"do": "zero"}), &[]);
    for _ in 0..33 {
        engine.take_frame(frame(2.5));
    }
    let heard = hear(&mut engine, &[]);
    assert!(heard["pressure_kpa"][0].as_f64().unwrap().abs() < 1e-9, "{heard}");
}

#[test]
fn a_line_is_read_in_pieces_of_any_size() {
    let mut engine = opened();
    offer(&mut engine, "the bench", "emulated");
    let line = ask(
        &mut engine,
        &json!({"do": "listen", "file": "line.toml", "text": LINE}),
        &[],
    );
    assert_eq!(line["baud"], 115_200, "{line}");
    let mut text = String::from("# boots\n");
    for index in 0..40 {
        let more_pa = if index < 32 { 0.0 } else { 1500.0 };
        let pressures: Vec<String> = (0..8)
            .map(|taxel| format!("{:.1}", 100_000.0 + 10.0 * f64::from(taxel) + more_pa))
            .collect();
        text += &format!(
            "{index},{},{}{}\n",
            index * 10_000,
            pressures.join(","),
            ",25.0".repeat(8)
        );
    }
    let mut heard = Value::Null;
    for piece in text.as_bytes().chunks(17) {
        engine.take_frame(frame(7.0)); // from the sensor that the line has replaced
        heard = hear(&mut engine, piece);
    }
    assert_eq!(
        (&heard["n_frames"], &heard["provenance"]),
        (&json!(40), &json!("real")),
        "{heard}"
    );
    for kpa in heard["pressure_kpa"].as_array().unwrap() {
        assert!((kpa.as_f64().unwrap() - 1.5).abs() < 1e-9, "{heard}");
    }
    let torn = hear(&mut engine, b"41,xx,1\n");
    assert_eq!(torn["remarks"], json!(["torn lines: 1"]), "{torn}");
}

#[test]
fn what_is_of_another_sensor_or_no_sensor_is_refused() {
    let mut engine = Engine::default();
    let refused = |answer: Value, words: &str| {
        let error = answer["error"].as_str().unwrap_or_default().to_owned();
        assert!(error.contains(words), "{answer}");
    };
    refused(hear(&mut engine, &[]), "open a description first");
    let mut engine = opened();
    refused(hear(&mut engine, b"1,2,3\n"), "connect one first");
    refused(ask(&mut engine, &json!({"do": "zero"}), &[]), "connect one first");
    let listen = |text: &str| json!({"do": "listen", "file": "mine.toml", "text": text});
    refused(
        ask(
            &mut engine,
            &listen("form = \"text\"\nfields = [\"pressure * 7\"]\n"),
            &[],
        ),
        "frames have 7 pressures, and the description of the sensor has 8",
    );
    refused(ask(&mut engine, &listen("form = \"tex\"\n"), &[]), "mine.toml:1");
    offer(&mut engine, "a bus", "real");
    engine.take_frame(vec![Some(101.3); 16]);
    refused(hear(&mut engine, &[]), "frames have 16 pressures");
}
