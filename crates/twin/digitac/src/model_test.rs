//! Models in folders: read as they were written, and refused where they are damaged.

use std::collections::{BTreeMap, BTreeSet};

use crate::pipeline_test::{make, settings, train_quietly};
use crate::synthetic::Truth;
use crate::*;

#[test]
fn a_model_survives_its_folder_and_notices_damage() {
    let mut truth = Truth::new();
    truth.offsets_mm.truncate(1);
    let made = make(&truth, 12);
    let settings = settings(&[Variant::PressureMemoryMlp], 3);
    let trained = train_quietly(&made, &settings).remove(0);
    let origin = Origin {
        surfaces: BTreeMap::new(),
        sensor: "name = \"formula\"".into(),
        simulation: serde_json::json!({"edge_mm": 1.0}),
        bench: made.bench.clone(),
        settings: TrainedWith { settings, seed: 1 },
        provenance: made.recording.provenance,
        files: vec!["<img src=x>|.csv".into()],
        temperature: None,
        trained_on: BTreeSet::new(),
        split: made.split.clone(),
        certainty: None,
    };
    let model = Model::new(trained.twin, origin, trained.validation, None);
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("twin");
    model.save(&folder).unwrap();
    model.save(&folder).unwrap();
    let again = Model::load(&folder).unwrap();
    assert_eq!(again.record, model.record);
    for press in &made.presses {
        assert_eq!(
            again.twin.predict(&[&press.features]),
            model.twin.predict(&[&press.features])
        );
    }
    let card = std::fs::read_to_string(folder.join("CARD.md")).unwrap();
    assert!(card.contains("&lt;img") && !card.contains("<img"), "{card}");
    let percent = model
        .record
        .validation
        .overall
        .nearest_in_contact
        .percent
        .unwrap();
    for part in [&model.record.variant.to_string(), &format!("| {percent:.2} |")] {
        assert!(card.contains(part), "{card}");
    }
    let message = |folder: &std::path::Path| Model::load(folder).unwrap_err().to_string();
    for name in ["weights.safetensors", "twin.json", "checksums.json"] {
        let path = folder.join(name);
        let whole = std::fs::read(&path).unwrap();
        let mut flipped = whole.clone();
        let middle = flipped.len() / 2;
        flipped[middle] ^= 4;
        std::fs::write(&path, flipped).unwrap();
        assert!(Model::load(&folder).is_err(), "{name}");
        std::fs::remove_file(&path).unwrap();
        assert!(
            message(&folder).contains(name) && message(&folder).contains("missing"),
            "{}",
            message(&folder)
        );
        std::fs::write(&path, whole).unwrap();
    }
    let path = folder.join("checksums.json");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace("\"version\": 1", "\"version\": 7")).unwrap();
    assert!(message(&folder).contains("version 7"), "{}", message(&folder));
}

/// Replaces one number or list of a model's record, and updates its checksum.
fn change_record(folder: &std::path::Path, pointer: &str, value: serde_json::Value) {
    let read = |name: &str| -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(folder.join(name)).unwrap()).unwrap()
    };
    let mut record = read("twin.json");
    *record.pointer_mut(pointer).expect(pointer) = value;
    std::fs::write(folder.join("twin.json"), record.to_string()).unwrap();
    say_checksums(folder);
}

/// Writes checksums of the present files of a model.
fn say_checksums(folder: &std::path::Path) {
    use sha2::{Digest, Sha256};
    let path = folder.join("checksums.json");
    let mut checksums: serde_json::Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    for (name, sum) in checksums["sha256"].as_object_mut().unwrap() {
        let digest = Sha256::digest(std::fs::read(folder.join(name)).unwrap());
        *sum = digest
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect::<String>()
            .into();
    }
    std::fs::write(path, checksums.to_string()).unwrap();
}

/// A trained model in a folder.
fn saved(folder: &std::path::Path) -> Model {
    let mut truth = Truth::new();
    truth.offsets_mm.truncate(1);
    let mut made = make(&truth, 12);
    made.bench.ports = vec![PortEstimate::default(); 4];
    let settings = settings(&[Variant::PressureMemoryMlp], 1);
    let trained = train_quietly(&made, &settings).remove(0);
    let origin = Origin {
        surfaces: BTreeMap::new(),
        sensor: "name = \"formula\"".into(),
        simulation: serde_json::json!({}),
        bench: made.bench.clone(),
        settings: TrainedWith { settings, seed: 1 },
        provenance: made.recording.provenance,
        files: vec!["file0".into()],
        temperature: None,
        trained_on: BTreeSet::new(),
        split: made.split.clone(),
        certainty: None,
    };
    let model = Model::new(trained.twin, origin, trained.validation, None);
    model.save(folder).unwrap();
    model
}

#[test]
fn presses_of_the_training_set_are_read_by_their_former_name() {
    let folder = tempfile::tempdir().unwrap();
    let mut model = saved(folder.path());
    model.record.trained_on = BTreeSet::from(["1f".to_owned()]);
    model.save(folder.path()).unwrap();
    let path = folder.path().join("twin.json");
    let text = std::fs::read_to_string(&path).unwrap();
    let former = text.replace("\"trained_on\"", "\"taught_by\"");
    assert_ne!(former, text);
    std::fs::write(&path, former).unwrap();
    say_checksums(folder.path());
    assert_eq!(Model::load(folder.path()).unwrap().record, model.record);
}

#[test]
fn a_model_that_cannot_be_is_refused_with_its_file_and_field() {
    use serde_json::json;
    let parent = tempfile::tempdir().unwrap();
    let good = parent.path().join("good");
    saved(&good);
    for (pointer, value, field) in [
        (
            "/start/gains/time_constants_s/0",
            json!(0.0),
            "start.gains.time_constants_s[0]` is 0",
        ),
        (
            "/start/gains/time_constants_s/1",
            json!(-4.0),
            "start.gains.time_constants_s[1]` is -4",
        ),
        (
            "/start/gains/gain/2",
            json!(1e300),
            "start.gains.gain[2]` is 1e300",
        ),
        (
            "/start/gains/memory/3",
            json!([0.1]),
            "start.gains.memory[3]` has 1 entries",
        ),
        (
            "/start/normalization/reading_kpa",
            json!(0.0),
            "start.normalization.reading_kpa` is 0",
        ),
        (
            "/start/normalization/pressure_rms_kpa/1",
            json!(0.0),
            "pressure_rms_kpa[1]` is 0",
        ),
        (
            "/start/hidden",
            json!([1_000_000_000, 1_000_000_000]),
            "start.hidden[0]` is 1e9",
        ),
        (
            "/start/correction_limit",
            json!(1e9),
            "start.correction_limit` is 1e9",
        ),
        (
            "/taxels",
            json!(["S0", "S1", "S2"]),
            "start.gains.gain` has 4 entries; one for each of 3 taxels",
        ),
        ("/taxels", json!([]), "taxels` names 0 taxels"),
        (
            "/bench/ports",
            json!([{"shift_mm": [0.0, 0.0], "wider_mm": 0.0}]),
            "bench.ports` has 1 entries",
        ),
        (
            "/bench/contact_offset_elsewhere_mm",
            json!(1e300),
            "bench.contact_offset_elsewhere_mm` is 1e300",
        ),
        (
            "/bench/gains/gain",
            json!([1.0]),
            "bench.gains.gain` has 1 entries",
        ),
    ] {
        let folder = parent.path().join("bad");
        Model::load(&good).unwrap().save(&folder).unwrap();
        change_record(&folder, pointer, value);
        let error = Model::load(&folder).unwrap_err().to_string();
        assert!(
            error.contains("twin.json") && error.contains(field),
            "{pointer}: {error}"
        );
    }
}

#[test]
fn weights_that_cannot_be_are_refused_with_their_place() {
    use safetensors::{Dtype, tensor::TensorView};
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("twin");
    let model = saved(&folder);
    for (name, wrong) in [
        ("layer0.weight", f32::NAN),
        ("layer1.bias", f32::INFINITY),
        ("memory_change", 1e30),
        ("gain_change", 1e3),
    ] {
        let mut weights = model.twin.parameters().weights();
        weights.get_mut(name).unwrap().1[1] = wrong;
        let bytes: Vec<_> = weights
            .iter()
            .map(|(name, (shape, data))| {
                let bytes: Vec<u8> = data.iter().flat_map(|number| number.to_le_bytes()).collect();
                (name, shape, bytes)
            })
            .collect();
        let views = bytes.iter().map(|(name, shape, data)| {
            (
                *name,
                TensorView::new(Dtype::F32, (*shape).clone(), data).unwrap(),
            )
        });
        let packed = safetensors::serialize(views, None).unwrap();
        std::fs::write(folder.join("weights.safetensors"), packed).unwrap();
        say_checksums(&folder);
        let error = Model::load(&folder).unwrap_err().to_string();
        let place = format!("`{name}[1]`");
        assert!(
            error.contains("weights.safetensors") && error.contains(&place),
            "{error}"
        );
    }
}

#[test]
fn a_model_of_before_the_seed_stood_beside_the_settings_is_read() {
    let text = r#"{"variants": ["pressure"], "seed": 7, "epochs": 3}"#;
    let read: TrainedWith = serde_json::from_str(text).unwrap();
    assert_eq!((read.seed, read.settings.epochs), (7, 3));
    assert_eq!(read.settings.variants, Some(vec![Variant::Pressure]));
    let again: TrainedWith = serde_json::from_str(&serde_json::to_string(&read).unwrap()).unwrap();
    assert_eq!(again, read);
}
